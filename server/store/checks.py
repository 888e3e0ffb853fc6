"""What may be stored: names, contents, suffixes, each refused with what is allowed."""

import json
import math
import re
import unicodedata
from collections.abc import Mapping

from tracker.errors import InvalidInput

LONGEST_NAME = 200
LARGEST_CONTENT_BYTES = 16 * 2**20
DEEPEST_CONTENT = 64
# Letters that turn the direction of what follows; languages that need them do so by their own letters.
TURNING = frozenset("\u202a\u202b\u202c\u202d\u202e\u2066\u2067\u2068\u2069")
SUFFIX = re.compile(r"(\.[a-z0-9]{1,10}){1,2}")


def checked_name(name: str, *, of: str) -> str:
    """A name for people: any letters of any script, without spaces around it, on one line.

    Raises:
        InvalidInput: NAME_INVALID.
    """
    kept = unicodedata.normalize("NFC", name).strip()
    odd = sorted({f"U+{ord(letter):04X}" for letter in kept if _is_odd(letter)})
    visible = sum(unicodedata.category(letter)[0] not in "CZ" for letter in kept)
    if visible and len(kept) <= LONGEST_NAME and not odd:
        return kept
    problem = f"has {len(kept)} letters" if visible else "has 0 letters that can be seen"
    problem = f"has control characters ({', '.join(odd[:3])})" if odd else problem
    raise InvalidInput(
        "NAME_INVALID",
        f"the {of} {problem}, allowed are 1 to {LONGEST_NAME} letters on one line",
        "Give another one.",
        {"letters": len(kept), "allowed": LONGEST_NAME},
    )


def _is_odd(letter: str) -> bool:
    """Whether it breaks the line, or turns what stands around it: another name would be seen than is kept."""
    return unicodedata.category(letter) in ("Cc", "Cs", "Zl", "Zp") or letter in TURNING


def checked_suffix(suffix: str) -> str:
    """The ending of a file's name.

    Raises:
        InvalidInput: SUFFIX_INVALID.
    """
    if SUFFIX.fullmatch(suffix):
        return suffix
    raise InvalidInput(
        "SUFFIX_INVALID",
        f"'{suffix[:40]}' cannot be the ending of a file's name",
        "Give one such as .npy or .nii.gz, in small letters and digits.",
        {"suffix": suffix[:40]},
    )


def text_of(content: Mapping[str, object]) -> str:
    """A document's content as JSON that reads back the same.

    Raises:
        InvalidInput: CONTENT_NOT_JSON, CONTENT_TOO_LARGE.
    """
    _reject_other_than_json(content)
    try:
        text = json.dumps(content, ensure_ascii=False, allow_nan=False, separators=(",", ":"))
        size = len(text.encode("utf-8"))
    except (ValueError, TypeError) as error:
        # Half of a surrogate pair is a text for Python, and for nobody else.
        raise _not_json("", str(error)[:200]) from error
    if size > LARGEST_CONTENT_BYTES:
        raise InvalidInput(
            "CONTENT_TOO_LARGE",
            f"the document has {size / 2**20:.1f} MB, allowed are {LARGEST_CONTENT_BYTES / 2**20:g} MB",
            "Put what is large into a file of the case, and its name into the document.",
            {"size_bytes": size, "allowed_bytes": LARGEST_CONTENT_BYTES},
        )
    return text


def _reject_other_than_json(content: object) -> None:
    """Look at every value; an own stack, because a hostile content is deeper than Python's."""
    if not isinstance(content, dict | Mapping):
        raise _not_json("", f"it is a {type(content).__name__}, not a mapping")
    waiting: list[tuple[str, object, int]] = [("", content, 0)]
    while waiting:
        where, value, depth = waiting.pop()
        if depth > DEEPEST_CONTENT:
            raise _not_json(where, f"it is more than {DEEPEST_CONTENT} levels deep")
        if isinstance(value, dict):
            for key, inner in value.items():
                if type(key) is not str:
                    raise _not_json(where, f"its key {key!r:.40} is a {type(key).__name__}, not a text")
                waiting.append((f"{where}.{key}", inner, depth + 1))
        elif isinstance(value, list | tuple):
            waiting += [(f"{where}[{n}]", inner, depth + 1) for n, inner in enumerate(value)]
        elif type(value) is float and not math.isfinite(value):
            raise _not_json(where, f"it is {value}, which is no number")
        elif not isinstance(value, str | bool | int | float | None):
            raise _not_json(where, f"it is a {type(value).__name__}")


def _not_json(where: str, why: str) -> InvalidInput:
    place = where.lstrip(".")[:120]
    return InvalidInput(
        "CONTENT_NOT_JSON",
        f"the document cannot be stored as JSON: {f'at {place} ' if place else ''}{why}",
        "Give texts, finite numbers, true, false, null, and lists and mappings of them.",
        {"where": place},
    )
