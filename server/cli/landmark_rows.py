"""Read points from a text file with one point per line, or from a file of markups of 3D Slicer.

A text file may have a header, names and comments. The first three numbers of a line are x, y and z in mm,
unless a header names the columns. A further word or a column of consecutive numbers is the name. Separators
are commas, semicolons, tabs or blanks; if the separator is not a comma, a comma inside a number is the
decimal point.
"""

import math
import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from server.slicer_file import MarkupKind, is_markups_name, markups_from_bytes
from tracker.errors import InvalidInput
from tracker.geometry import Array

MAX_BYTES = 20 * 2**20
COMMENT = ("#", "%", "//")
REMEDY = (
    "Give a text file with one point per line, as x,y,z in mm, or with a header that names x, y and z; or "
    "markups of 3D Slicer (.mrk.json)."
)
AXES = ("x", "y", "z")
NAMED = ("label", "name", "id", "landmark", "point", "no", "nr", "index")
# "x_mm", "X (mm)", "x [mm]", "pos_x" and the "l" of LPS all name x.
HEADING = re.compile(r"^(?:pos_?|p_?|coord_?)?([xyz])(?:[_ ]?[(\[]?mm[)\]]?)?$")


@dataclass(frozen=True, slots=True, kw_only=True)
class LandmarkRows:
    """Points (n, 3) of a file in mm, and their names; no names if not every point has one.

    Points of markups are LPS, whatever their file states.
    """

    path: Path
    points_mm: Array
    labels: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class _Line:
    number: int
    words: list[str]


def read_landmarks(path: Path) -> LandmarkRows:
    """Read the points of a file.

    Raises:
        InvalidInput: POINTS_UNREADABLE, POINTS_INCOMPLETE or POINTS_INVALID; the line is named.
            MARKUPS_UNREADABLE or MARKUPS_INVALID.
    """
    if is_markups_name(path.name):
        return _rows_of_markups(path)
    lines = _lines(_text(path))
    columns = _columns_of_header(lines[0].words) if lines else None
    # A header without x, y and z is skipped.
    if lines and (columns is not None or not _numbers_in(lines[0].words)):
        lines = lines[1:]
    if columns is None:
        columns = _columns_of_numbers(lines, path)
    places, name_place = columns
    points, labels = [], []
    for line in lines:
        points.append([_number(line, place, path) for place in places])
        has_name = name_place is not None and name_place < len(line.words)
        labels.append(line.words[name_place] if has_name and name_place is not None else "")
    if not points:
        raise InvalidInput("POINTS_INCOMPLETE", f"{path} has no points", REMEDY, {"file": str(path)})
    return _rows(path, np.array(points, dtype=np.float64), labels)


def _rows_of_markups(path: Path) -> LandmarkRows:
    """Return the points of the only markup of a file; those of a curve have no names."""
    markups = markups_from_bytes(_content(path), name=str(path))
    if len(markups) != 1:
        raise InvalidInput(
            "POINTS_INCOMPLETE",
            f"{path} has {len(markups)} point lists, lines and curves with points, expected 1",
            "Save only the point list or curve to be used as Markups JSON (.mrk.json).",
            {"file": str(path), "markups": len(markups)},
        )
    markup = markups[0]
    labels = markup.labels if markup.kind is MarkupKind.POINTS else [""]
    return _rows(path, markup.points_lps_mm, [label.strip() for label in labels])


def _rows(path: Path, points_mm: Array, labels: list[str]) -> LandmarkRows:
    named = all(labels)
    if named and len(set(labels)) != len(labels):
        twice = next(label for label in labels if labels.count(label) > 1)
        raise InvalidInput(
            "POINTS_INVALID",
            f"{path} has two points named '{twice}'",
            "Give each landmark a different name, or no names at all.",
            {"file": str(path), "name": twice},
        )
    return LandmarkRows(path=path, points_mm=points_mm, labels=tuple(labels) if named else ())


def _content(path: Path) -> bytes:
    try:
        if path.stat().st_size > MAX_BYTES:
            message = f"the points file {path} has more than {MAX_BYTES / 2**20:.0f} MB, the maximum"
            raise InvalidInput("POINTS_UNREADABLE", message, REMEDY, {"file": str(path)})
        return path.read_bytes()
    except OSError as error:
        message = f"the points file {path} cannot be read: {(error.strerror or str(error)).lower()}"
        raise InvalidInput("POINTS_UNREADABLE", message, REMEDY, {"file": str(path)}) from error


def _text(path: Path) -> str:
    content = _content(path)
    encoding = "utf-16" if content[:2] in {b"\xff\xfe", b"\xfe\xff"} else "utf-8-sig"
    try:
        text = content.decode(encoding)
    except UnicodeDecodeError:
        text = ""
    if (not text and content) or "\0" in text:
        message = f"the points file {path} is not a text file"
        raise InvalidInput("POINTS_UNREADABLE", message, REMEDY, {"file": str(path)})
    return text


def _lines(text: str) -> list[_Line]:
    rows = [(number, line.strip()) for number, line in enumerate(text.splitlines(), start=1)]
    rows = [(number, line) for number, line in rows if line and not line.startswith(COMMENT)]
    split = next((mark for mark in (";", "\t", ",") if any(mark in line for _, line in rows)), None)
    # Blanks separate the numbers if every comma is a decimal point: "1,5 2,5 3,5".
    if split == "," and rows and all(re.fullmatch(r"(\S+\s+){2,}\S+", line) for _, line in rows):
        bare = [word for _, line in rows[-1:] for word in line.split()]
        if all("," in word and not word.endswith(",") for word in bare):
            split = None
    return [_Line(number, _words(line, split)) for number, line in rows]


def _words(line: str, split: str | None) -> list[str]:
    # A comment may follow the numbers.
    words = [word.strip().strip("\"'").strip() for word in line.split(" #", maxsplit=1)[0].split(split)]
    while words and not words[-1]:
        words.pop()
    return [word.replace(",", ".") if split != "," and _is_comma_number(word) else word for word in words]


def _is_comma_number(word: str) -> bool:
    return re.fullmatch(r"[-+]?\d*,\d+(?:[eE][-+]?\d+)?", word) is not None


def _is_number(word: str) -> bool:
    try:
        float(word)
    except ValueError:
        return False
    return True


def _numbers_in(words: list[str]) -> int:
    return sum(_is_number(word) for word in words)


def _columns_of_header(words: list[str]) -> tuple[list[int], int | None] | None:
    found = {}
    for place, word in enumerate(words):
        match = HEADING.match(word.lower())
        if match and match[1] not in found:
            found[match[1]] = place
    if any(axis not in found for axis in AXES):
        return None
    name = next((place for place, word in enumerate(words) if word.lower() in NAMED), None)
    return [found[axis] for axis in AXES], name


def _columns_of_numbers(lines: list[_Line], path: Path) -> tuple[list[int], int | None]:
    """Return the columns of x, y and z, and that of the name, in lines without a header."""
    if not lines:
        return [0, 1, 2], None
    words = lines[0].words
    numeric = [place for place, word in enumerate(words) if _is_number(word)]
    rest = [place for place in range(len(words)) if place not in numeric]
    if len(numeric) == 4 and _counts(lines, numeric[0]):
        return numeric[1:], numeric[0]
    if len(numeric) != 3 and not (len(numeric) < 3 and len(words) <= 3):
        raise InvalidInput(
            "POINTS_INVALID",
            f"line {lines[0].number} of {path} has {len(numeric)} numbers, expected three",
            REMEDY,
            {"file": str(path), "line": lines[0].number},
        )
    if len(numeric) < 3:
        return [0, 1, 2], None
    return numeric, rest[0] if rest else None


def _counts(lines: list[_Line], place: int) -> bool:
    """Return whether a column is 0, 1, 2, ... or 1, 2, 3, ..."""
    words = [line.words[place] if place < len(line.words) else "" for line in lines]
    return any(words == [str(start + step) for step in range(len(words))] for start in (0, 1))


def _number(line: _Line, place: int, path: Path) -> float:
    word = line.words[place] if place < len(line.words) else ""
    value = float(word) if _is_number(word) else math.nan
    if not math.isfinite(value):
        raise InvalidInput(
            "POINTS_INVALID",
            f"line {line.number} of {path} has '{word}' where a number is expected",
            REMEDY,
            {"file": str(path), "line": line.number},
        )
    return value
