"""Random changes of a file or message, as an attacker, an incomplete copy or a flipped bit makes them."""

import copy
import json
import random
import re
from collections.abc import Callable, Iterator, Sequence
from typing import Any, Literal

MAX_BYTES = 200_000
MAX_CHANGES = 6
NUMBER = re.compile(rb"-?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?")
# Lengths and counts at which a type overflows, and those beside them.
COUNTS = (
    0,
    1,
    2,
    0x7F,
    0x80,
    0xFF,
    0x7FFF,
    0x8000,
    0xFFFF,
    2**24,
    2**31 - 1,
    2**31,
    2**32 - 1,
    2**63,
    2**64 - 1,
)
NUMBERS = (
    *(b"0", b"-0", b"-1", b"1e999", b"-1e308", b"1e-320", b"NaN", b"Infinity", b"-Infinity", b"1_0", b"0x10"),
    *(b"1" + b"0" * 30, b"9" * 400, b"1" * 5000, b"2147483648", b"9223372036854775808", b"", b"\xd9\xa1"),
    *(b"[" * 5000, b'{"a":' * 5000),
)
VALUES: tuple[object, ...] = (
    *(None, True, False, 0, -1, 1, 2**31, 2**63, 10**400, 0.5, -1e308, float("nan"), float("inf")),
    *("", " ", "\0", "\ud800", "\u202e", "x" * 3000, "../../x", "NaN", "1", [], {}, [[]], [None], {"": 0}),
    *({"a": {"b": {}}}, [[0.0] * 3] * 3, [1e308] * 3),
)


def mutated(content: bytes, others: Sequence[bytes], rng: random.Random) -> bytes:
    """Return the content after some random changes; `others` are files from which pieces are taken."""
    if rng.random() < 0.5 and (values := _as_json(content)) is not None:
        for _ in range(rng.randint(1, 3)):
            values = _changed_value(values, rng)
        return json.dumps(values, ensure_ascii=rng.random() < 0.5).encode("utf-8", "surrogatepass")[
            :MAX_BYTES
        ]
    # Most inputs have few changes, because after many of them the first check of a reader rejects all.
    for _ in range(min(MAX_CHANGES, 1 + int(rng.expovariate(0.8)))):
        content = rng.choice(CHANGES)(content, others, rng)
    return content[:MAX_BYTES]


def _flip(content: bytes, _others: Sequence[bytes], rng: random.Random) -> bytes:
    changed = bytearray(content)
    for _ in range(rng.choice((1, 1, 2, 8))):
        if changed:
            changed[_place(content, rng)] ^= 1 << rng.randrange(8)
    return bytes(changed)


def _overwrite(content: bytes, _others: Sequence[bytes], rng: random.Random) -> bytes:
    at, count = _place(content, rng), rng.choice((1, 1, 2, 4, 16))
    value = rng.choice((b"\0", b"\xff", b" ", b"-", b"\n", b'"', b"{", bytes([rng.randrange(256)])))
    return content[:at] + value * count + content[at + count :]


def _count(content: bytes, _others: Sequence[bytes], rng: random.Random) -> bytes:
    """Write another length, count or offset."""
    order: Literal["little", "big"] = "little" if rng.random() < 0.5 else "big"
    at, width = _place(content, rng), rng.choice((1, 2, 4, 8))
    before = int.from_bytes(content[at : at + width], order)
    value = rng.choice((*COUNTS, before + 1, before - 1, before * 2, len(content), len(content) - at))
    return content[:at] + (value % 256**width).to_bytes(width, order) + content[at + width :]


def _truncate(content: bytes, _others: Sequence[bytes], rng: random.Random) -> bytes:
    return content[: _place(content, rng)]


def _remove(content: bytes, _others: Sequence[bytes], rng: random.Random) -> bytes:
    begin, end = _piece(content, rng)
    return content[:begin] + content[end:]


def _duplicate(content: bytes, _others: Sequence[bytes], rng: random.Random) -> bytes:
    begin, end = _piece(content, rng)
    return content[:end] + content[begin:end] * rng.choice((1, 1, 2, 50)) + content[end:]


def _splice(content: bytes, others: Sequence[bytes], rng: random.Random) -> bytes:
    other = rng.choice(others) if others else content
    begin, end = _piece(other, rng)
    at = _place(content, rng)
    return content[:at] + other[begin:end] + content[at + rng.choice((0, end - begin)) :]


def _number(content: bytes, _others: Sequence[bytes], rng: random.Random) -> bytes:
    """Replace a number of a text."""
    found = list(NUMBER.finditer(content[:MAX_BYTES]))
    if not found:
        return _overwrite(content, (), rng)
    one = rng.choice(found)
    return content[: one.start()] + rng.choice(NUMBERS) + content[one.end() :]


def _line(content: bytes, _others: Sequence[bytes], rng: random.Random) -> bytes:
    """Remove, repeat or exchange lines of a text."""
    lines = content.split(b"\n")
    one, two = rng.randrange(len(lines)), rng.randrange(len(lines))
    match rng.randrange(3):
        case 0:
            del lines[one]
        case 1:
            lines.insert(two, lines[one])
        case _:
            lines[one], lines[two] = lines[two], lines[one]
    return b"\n".join(lines)


Change = Callable[[bytes, Sequence[bytes], random.Random], bytes]
CHANGES: tuple[Change, ...] = (
    *(_flip, _flip, _overwrite, _count, _count, _truncate, _remove, _duplicate, _splice, _number, _number),
    _line,
)


def _place(content: bytes, rng: random.Random) -> int:
    """Return a random position; headers, which have most of the structure, are at the begin and the end."""
    if not content:
        return 0
    near = min(len(content), rng.choice((16, 64, 400, len(content))))
    at = rng.randrange(near)
    return len(content) - 1 - at if rng.random() < 0.25 else at


def _piece(content: bytes, rng: random.Random) -> tuple[int, int]:
    begin = _place(content, rng)
    return begin, min(len(content), begin + rng.choice((1, 4, 16, 100, len(content))))


def _as_json(content: bytes) -> Any:  # noqa: ANN401  JSON
    if content[:1] not in {b"{", b"["}:
        return None
    try:
        return json.loads(content)
    except (ValueError, RecursionError):
        return None


def _changed_value(values: Any, rng: random.Random) -> Any:  # noqa: ANN401  JSON
    """Return JSON with one of its values or keys changed."""
    places = list(_places(values))
    if not places:
        return copy.deepcopy(rng.choice(VALUES))
    inside, key = rng.choice(places)
    match rng.randrange(8):
        case 0:
            del inside[key]
        case 1 if isinstance(inside, dict):
            inside[rng.choice(("", "\ud800", "x" * 300, "__class__", str(key).upper()))] = inside.pop(key)
        case 2:
            other, there = rng.choice(places)
            inside[key] = json.loads(json.dumps(other[there]))
        case 3 if isinstance(inside, list):
            inside += copy.deepcopy([inside[key]] * rng.choice((1, 2, 200)))
        case _:
            inside[key] = copy.deepcopy(rng.choice(VALUES))
    return values


def _places(values: Any) -> Iterator[tuple[Any, Any]]:  # noqa: ANN401  JSON
    """Yield each container with each of its keys."""
    pairs = (
        values.items() if isinstance(values, dict) else enumerate(values) if isinstance(values, list) else ()
    )
    for key, one in list(pairs):
        yield values, key
        yield from _places(one)
