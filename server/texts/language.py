"""Languages, and texts in all of them."""

from collections.abc import Callable, Mapping
from datetime import datetime
from typing import Literal, TypeAlias

from server.number_format import format_number

Language: TypeAlias = Literal["en", "de"]
LANGUAGES: tuple[Language, ...] = ("en", "de")
Text: TypeAlias = Mapping[Language, str]

NO_TEXT: Text = dict.fromkeys(LANGUAGES, "")
# The caller asks for two decimals for the 95 % error, because it is compared with the room in a pedicle.
DECIMALS = {"MB": 0, "min": 0, "%": 0}


def text_of(write: Callable[[Language], str]) -> Text:
    """Return the text that `write` returns for each language."""
    return {language: write(language) for language in LANGUAGES}


def amount(value: float, unit: str, *, decimals: int | None = None) -> str:
    """Return a number with its unit: "0.8 mm", "12 %", "2.4°"."""
    digits = format_number(value, decimals=DECIMALS.get(unit, 1) if decimals is None else decimals)
    return f"{digits}{unit}" if unit in ("°", "") else f"{digits} {unit}"


def clock_text(unix_s: float) -> str:
    """Return the time of day in the server's time zone, such as "10:41:13"."""
    return datetime.fromtimestamp(unix_s).astimezone().strftime("%H:%M:%S")
