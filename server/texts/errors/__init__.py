"""Translations of errors.

An error is raised with its code, its message and remedy in English, and its values by name (`context`). The
catalogue has the template of that message in all languages. It is used only where the English template with
the values of the error gives exactly the message that was raised: a translation therefore has the same
numbers, and an error that was reworded without its translation stays English. A value may be a phrase
(`phrases`), a part of a message that depends on the case; it is found in the same way, or else its values are
read from its English text.
"""

import re
from collections.abc import Iterator, Mapping
from functools import cache
from string import Formatter

from server.texts.errors.catalogue import MESSAGES, REMEDIES
from server.texts.errors.phrases import PHRASES
from server.texts.errors.phrases.system import SYSTEM_ERRORS
from server.texts.language import Language, Text
from server.texts.reason import Reason, as_is, filled
from server.texts.steps import KINDS, METHODS, STEPS
from tracker.errors import NavigationError

# Values that are codes, and the words for them.
_NONE: Mapping[str, Text] = {"none": {"en": "none", "de": "keine"}}
WORDS: Mapping[str, Mapping[str, Text]] = {
    "kind": KINDS,
    "landmarks": _NONE,
    "method": METHODS,
    "step": STEPS,
    "tools": _NONE,
    "role": {
        "operator": {
            "en": "operator",
            "de": "Bedienung",
        },
        "supervisor": {
            "en": "supervisor",
            "de": "Aufsicht",
        },
        "viewer": {
            "en": "viewer",
            "de": "Betrachter",
        },
        "screen": {
            "en": "screen",
            "de": "OP-Bildschirm",
        },
    },
    "installed": _NONE,
    "markers": _NONE,
    "reason": {
        "it is not open": {
            "en": "it is not open",
            "de": "sie ist nicht geöffnet",
        },
        "no complete image arrived": {
            "en": "no complete image arrived",
            "de": "es kam kein vollständiges Bild an",
        },
    },
    "system_error": {text["en"]: text for text in SYSTEM_ERRORS},
    "plane": {
        "axial": {
            "en": "axial",
            "de": "axiale",
        },
        "sagittal": {
            "en": "sagittal",
            "de": "sagittale",
        },
        "coronal": {
            "en": "coronal",
            "de": "koronale",
        },
    },
    "stored": {
        "colours": {
            "en": "colours",
            "de": "Farben",
        },
    },
    "voxels": {
        "no": {
            "en": "no",
            "de": "keine",
        },
    },
    "unit": {
        "deg": {
            "en": "deg",
            "de": "Grad",
        },
    },
    "triggers": {
        "none": {
            "en": "none",
            "de": "keiner",
        },
    },
    "divergence": {
        "numbers that are not finite": {
            "en": "numbers that are not finite",
            "de": "nicht endliche Zahlen",
        },
    },
    "waits_for": STEPS,
}
# A file may state any name in a phrase, and the time of a comparison grows faster than the length.
MAX_PHRASE_LENGTH = 1000
_REMARK = {"code", "message", "remedy", "context"}
_NO_TEXT = re.compile(r"(?!)")


def reason_of_error(error: NavigationError) -> Reason:
    """Return an error as a reason in all languages."""
    return error_reason(error.code, error.message, error.remedy, error.context)


def error_reason(code: str, message: str, remedy: str, context: Mapping[str, object]) -> Reason:
    """Return the parts of an error as a reason in all languages, in English where it has no translation."""
    values = _values(context)
    translated_message = _translation(message, MESSAGES.get(code, ()), values)
    translated_remedy = _translation(remedy, REMEDIES, values)
    if translated_message is None or translated_remedy is None:
        return Reason(code=code, message=as_is(message), remedy=as_is(remedy), is_translated=False)
    return Reason(code=code, message=translated_message, remedy=translated_remedy)


def worded(stored: object, language: Language) -> object:
    """Return what a document stores with its warnings in a language.

    A warning (`Remark`) is stored with its code, its values and its English sentences. An older one, of which
    only sentences are stored, stays as it is.
    """
    if isinstance(stored, Mapping):
        if stored.keys() == _REMARK:
            context = stored["context"]
            why = error_reason(
                str(stored["code"]),
                str(stored["message"]),
                str(stored["remedy"]),
                context if isinstance(context, Mapping) else {},
            )
            return {**stored, "message": why.message[language], "remedy": why.remedy[language]}
        return {key: worded(value, language) for key, value in stored.items()}
    # Most lists are of numbers, and long.
    if isinstance(stored, list) and any(isinstance(one, Mapping) for one in stored):
        return [worded(one, language) for one in stored]
    return stored


def phrase_text(name: str, english: str) -> Text:
    """Return a phrase in all languages, in English where it has no translation."""
    return _read_phrase(english, PHRASES[name]) or as_is(english)


def _values(context: Mapping[str, object]) -> Mapping[str, object]:
    """Return the values of an error with those that are phrases in all languages."""
    values = {name: _word(name, value) for name, value in context.items()}
    for name, templates in PHRASES.items():
        if isinstance(english := context.get(name), str):
            phrase = _translation(english, templates, values) or _read_phrase(english, templates)
            if phrase is None:
                # Without it no template fits: a German sentence must not have an English part.
                del values[name]
            else:
                values[name] = phrase
    return values


def _word(name: str, value: object) -> object:
    return WORDS[name].get(str(value), value) if name in WORDS else value


def _translation(english: str, templates: tuple[Text, ...], values: Mapping[str, object]) -> Text | None:
    """Return the first template that gives this English sentence, with its values."""
    if not english:
        return as_is("")
    return next((text for text in _filled(templates, values) if text["en"] == english), None)


def _read_phrase(english: str, templates: tuple[Text, ...]) -> Text | None:
    """Return the first template that this English phrase has the form of, with the values that are in it."""
    if len(english) > MAX_PHRASE_LENGTH:
        return None
    for template in templates:
        found = _pattern(template["en"]).fullmatch(english)
        if found is not None:
            text = next(_filled((template,), _values(found.groupdict())), None)
            if text is not None:
                return text
    return None


@cache
def _pattern(template: str) -> re.Pattern[str]:
    """Return the pattern of a template; of one that formats its values or has no words, one without match."""
    parts = list(Formatter().parse(template))
    if not any(literal for literal, *_ in parts):
        return _NO_TEXT
    pattern, names = "", set()
    for literal, name, spec, conversion in parts:
        pattern += re.escape(literal)
        if name is None:
            continue
        if spec or conversion or not name.isidentifier():
            return _NO_TEXT
        pattern += f"(?P={name})" if name in names else f"(?P<{name}>.+?)"
        names.add(name)
    return re.compile(pattern, re.DOTALL)


def _filled(templates: tuple[Text, ...], values: Mapping[str, object]) -> Iterator[Text]:
    for template in templates:
        try:
            yield filled(template, values)
        except (KeyError, IndexError, AttributeError, TypeError, ValueError):
            # Raised elsewhere with this code, and with other values.
            continue
