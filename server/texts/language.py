"""Languages, texts in all of them, and numbers as each of them writes them."""

import re
from collections.abc import Callable, Mapping
from datetime import datetime
from numbers import Real
from string import Formatter
from typing import Literal, TypeAlias

from server.number_format import format_number

Language: TypeAlias = Literal["en", "de"]
LANGUAGES: tuple[Language, ...] = ("en", "de")
Text: TypeAlias = Mapping[Language, str]

NO_TEXT: Text = dict.fromkeys(LANGUAGES, "")
# The caller asks for two decimals for the 95 % error, because it is compared with the room in a pedicle.
DECIMALS = {"MB": 0, "min": 0, "%": 0}
# Files, exports and the command line write a point in every language.
DECIMAL_SIGNS: Text = {"en": ".", "de": ","}
# A number as text, or several: "0.45 x 0.45 x 0.60".
_NUMBERS = re.compile(r"[+-]?\d+(\.\d+)?(?:(, | x |x| ?[/–] ?)[+-]?\d+(\.\d+)?)*")


def text_of(write: Callable[[Language], str]) -> Text:
    """Return the text that `write` returns for each language."""
    return {language: write(language) for language in LANGUAGES}


def number_text(value: float, language: Language, *, decimals: int = 1) -> str:
    """Return a number with fixed decimals: "0.8", in German "0,8"."""
    return format_number(value, decimals=decimals).replace(".", DECIMAL_SIGNS[language])


def amount(value: float, unit: str, language: Language, *, decimals: int | None = None) -> str:
    """Return a number with its unit: "0.8 mm", "12 %", "2.4°"."""
    digits = number_text(value, language, decimals=DECIMALS.get(unit, 1) if decimals is None else decimals)
    return f"{digits}{unit}" if unit in ("°", "") else f"{digits} {unit}"


def fill(template: str, values: Mapping[str, object], language: Language) -> str:
    """Return a template with its values, and the numbers among them as the language writes them.

    Raises:
        KeyError, TypeError, ValueError and others: as `str.format_map`.
    """
    return _FORMATTERS[language].vformat(template, (), values)


class _NumberFormatter(Formatter):
    """Formats as `str.format`, with the decimal sign of a language in numbers and texts of numbers alone."""

    def __init__(self, decimal_sign: str) -> None:
        self._decimal_sign = decimal_sign

    def format_field(self, value: object, format_spec: str) -> str:
        shown: str = super().format_field(value, format_spec)
        is_number = isinstance(value, Real) or (isinstance(value, str) and _NUMBERS.fullmatch(shown))
        if not is_number or self._decimal_sign == "." or "." not in shown:
            return shown
        # A comma that separates numbers would be one more decimal sign.
        return shown.replace(", ", "; ").replace(".", self._decimal_sign)


_FORMATTERS = {language: _NumberFormatter(sign) for language, sign in DECIMAL_SIGNS.items()}


def clock_text(unix_s: float) -> str:
    """Return the time of day in the server's time zone, such as "10:41:13"."""
    return datetime.fromtimestamp(unix_s).astimezone().strftime("%H:%M:%S")
