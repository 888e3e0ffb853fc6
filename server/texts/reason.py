"""Reasons: a code with its values, and the sentences that the catalogue makes of them in all languages."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TypeAlias, TypeGuard, TypeVar

from server.texts.language import LANGUAGES, NO_TEXT, Language, Text, fill, text_of
from server.texts.steps import KINDS, REASONS, WITHDRAWALS
from tracker.errors import NavigationError

Error = TypeVar("Error", bound=NavigationError)
# A value may be a text itself: the name of a step, or the reason of another step.
Value: TypeAlias = float | int | bool | str | Text | None


@dataclass(frozen=True, slots=True, kw_only=True)
class Reason:
    """Why something is as it is, and what to do.

    Attributes:
        code: Identifier of the reason in UPPER_SNAKE_CASE.
        message: What was found, as a sentence without its full stop.
        remedy: What to do next, in full sentences; empty if there is nothing to do.
        values: The values in the message by name, each with its unit in the name.
        is_translated: Whether each language has its own text; otherwise all have the English one.
    """

    code: str
    message: Text
    remedy: Text = field(default_factory=lambda: NO_TEXT)
    values: Mapping[str, Value] = field(default_factory=dict)
    is_translated: bool = True

    def language(self, wanted: Language) -> Language:
        """Return the language of the sentences that are given for a wanted language."""
        return wanted if self.is_translated else "en"


def reason(code: str, values: Mapping[str, Value] | None = None, *, remedy: Text | None = None) -> Reason:
    """Return the reason of the catalogue with these values.

    Args:
        code: its code.
        values: the values that the template of the message names.
        remedy: the remedy, where it depends on more than the code.
    """
    sentence = REASONS[code]
    values = values or {}
    return Reason(
        code=code,
        message=filled(sentence.message, values),
        remedy=sentence.remedy if remedy is None else remedy,
        values=values,
    )


def reason_error(
    kind: type[Error], why: Reason, *, code: str = "", context: Mapping[str, object] | None = None
) -> Error:
    """Return the error of a reason, with the code of the reason unless another one is given.

    Its context has the values of the reason only if they are translated, so that an error is in one language.
    """
    values = why.values if why.is_translated else {}
    return kind(code or why.code, why.message["en"], why.remedy["en"], {**values, **(context or {})})


def filled(template: Text, values: Mapping[str, object]) -> Text:
    """Return a template with its values in each language.

    Raises:
        KeyError, TypeError, ValueError: a value is missing, or is of another type than the template formats.
    """

    def write(language: Language) -> str:
        own = {name: value[language] if _is_text(value) else value for name, value in values.items()}
        return fill(template[language], own, language)

    return text_of(write)


def _is_text(value: object) -> TypeGuard[Text]:
    return isinstance(value, Mapping) and value.keys() == set(LANGUAGES)


def document_title(kind: str, name: str, version: int) -> Text:
    """Return kind, name and version of a document, for display."""
    return {
        "en": f"{KINDS[kind]['en']} '{name}' version {version}",
        "de": f"{KINDS[kind]['de']} „{name}“ Version {version}",
    }


def withdrawal_text(stored: str) -> Text:
    """Return why a document was withdrawn: as stored, or translated if the server itself stated it."""
    return next((text for text in WITHDRAWALS.values() if text["en"] == stored), as_is(stored))


def as_is(words: str) -> Text:
    """Return the same words in all languages."""
    return dict.fromkeys(LANGUAGES, words)
