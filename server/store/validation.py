"""Validation of names, contents and file suffixes."""

import json
import math
import re
import unicodedata
from collections.abc import Mapping

from tracker.errors import InvalidInput

MAX_NAME_LENGTH = 200
MAX_CONTENT_BYTES = 16 * 2**20
MAX_CONTENT_DEPTH = 64
# Unicode controls of the writing direction; right-to-left scripts do not need them.
BIDI_CONTROLS = frozenset("\u202a\u202b\u202c\u202d\u202e\u2066\u2067\u2068\u2069")
SUFFIX = re.compile(r"(\.[a-z0-9]{1,10}){1,2}")


def validate_name(name: str, *, of: str) -> str:
    """Return a display name, NFC-normalised and stripped; any script, on one line.

    Raises:
        InvalidInput: NAME_INVALID.
    """
    stored = unicodedata.normalize("NFC", name).strip()
    odd = sorted({f"U+{ord(letter):04X}" for letter in stored if _is_unsafe(letter)})
    visible = sum(unicodedata.category(letter)[0] not in "CZ" for letter in stored)
    if visible and len(stored) <= MAX_NAME_LENGTH and not odd:
        return stored
    problem = f"has {len(stored)} characters" if visible else "has 0 visible characters"
    problem = f"has control characters ({', '.join(odd[:3])})" if odd else problem
    raise InvalidInput(
        "NAME_INVALID",
        f"the {of} {problem}, allowed are 1 to {MAX_NAME_LENGTH} characters on one line",
        "Give another one.",
        {"letters": len(stored), "allowed": MAX_NAME_LENGTH, "name_of": of, "name_problem": problem},
    )


def _is_unsafe(letter: str) -> bool:
    """Return whether it breaks the line or reverses the writing direction, which could disguise a name."""
    return unicodedata.category(letter) in ("Cc", "Cs", "Zl", "Zp") or letter in BIDI_CONTROLS


def validate_suffix(suffix: str) -> str:
    """Return the suffix of a file name, if it is valid.

    Raises:
        InvalidInput: SUFFIX_INVALID.
    """
    if SUFFIX.fullmatch(suffix):
        return suffix
    raise InvalidInput(
        "SUFFIX_INVALID",
        f"'{suffix[:40]}' is not a valid file name suffix",
        "Give a suffix such as .npy or .nii.gz, of lower-case letters and digits.",
        {"suffix": suffix[:40]},
    )


def content_to_json(content: Mapping[str, object]) -> str:
    """Serialise the content of a document as JSON that reads back unchanged.

    Raises:
        InvalidInput: CONTENT_NOT_JSON, CONTENT_TOO_LARGE.
    """
    _reject_other_than_json(content)
    try:
        text = json.dumps(content, ensure_ascii=False, allow_nan=False, separators=(",", ":"))
        size = len(text.encode("utf-8"))
    except (ValueError, TypeError) as error:
        # A lone surrogate is a valid Python string, but cannot be encoded.
        raise _not_json("", f"it cannot be encoded ({str(error)[:200]})") from error
    if size > MAX_CONTENT_BYTES:
        raise InvalidInput(
            "CONTENT_TOO_LARGE",
            f"the document has {size / 2**20:.1f} MB, the maximum is {MAX_CONTENT_BYTES / 2**20:g} MB",
            "Put what is large into a file of the case, and its name into the document.",
            {
                "size_bytes": size,
                "allowed_bytes": MAX_CONTENT_BYTES,
                "size_mb": size / 2**20,
                "max_mb": MAX_CONTENT_BYTES / 2**20,
            },
        )
    return text


def _reject_other_than_json(content: object) -> None:
    """Validate every value. Iterative, because hostile content could exceed Python's recursion limit."""
    if not isinstance(content, Mapping):
        raise _not_json("", f"it is a {type(content).__name__}, not a mapping")
    waiting: list[tuple[str, object, int]] = [("", content, 0)]
    while waiting:
        where, value, depth = waiting.pop()
        if depth > MAX_CONTENT_DEPTH:
            raise _not_json(where, f"it is more than {MAX_CONTENT_DEPTH} levels deep")
        if isinstance(value, dict):
            for key, inner in value.items():
                if type(key) is not str:
                    raise _not_json(where, f"its key {key!r:.40} is a {type(key).__name__}, not a text")
                waiting.append((f"{where}.{key}", inner, depth + 1))
        elif isinstance(value, (list, tuple)):
            waiting += [(f"{where}[{n}]", inner, depth + 1) for n, inner in enumerate(value)]
        elif type(value) is float and not math.isfinite(value):
            raise _not_json(where, f"it is {value}, which is no number")
        elif not isinstance(value, str | bool | int | float | None):
            raise _not_json(where, f"it is a {type(value).__name__}")


def _not_json(where: str, why: str) -> InvalidInput:
    place = where.lstrip(".")[:120]
    at = f"at {place} " if place else ""
    return InvalidInput(
        "CONTENT_NOT_JSON",
        f"the document cannot be stored as JSON: {at}{why}",
        "Give texts, finite numbers, true, false, null, and lists and mappings of them.",
        {"where": place, "json_place": at, "json_problem": why},
    )
