"""Read named columns of points from CSV files."""

import csv
import math
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from tracker.errors import InvalidInput
from tracker.geometry import Array

MAX_ROWS = 100_000


def read_columns(path: Path, columns: Sequence[str]) -> Array:
    """Return the named columns (rows, columns) of a CSV file; other columns are ignored.

    Raises:
        InvalidInput: POINTS_UNREADABLE, POINTS_INCOMPLETE, POINTS_INVALID; the line is named.
    """
    remedy = f"Give a CSV file whose first line is {','.join(columns)}, with numbers below."
    try:
        text = path.read_text(encoding="utf-8-sig")
    except OSError as error:
        reason = (error.strerror or str(error)).lower()
        message = f"the points file {path} cannot be read: {reason}"
        raise InvalidInput("POINTS_UNREADABLE", message, remedy, {"file": str(path)}) from error
    except UnicodeDecodeError as error:
        message = f"the points file {path} is not a text file"
        raise InvalidInput("POINTS_UNREADABLE", message, remedy, {"file": str(path)}) from error
    lines = text.splitlines()
    first = lines[0] if lines else ""
    split = max(",;\t", key=first.count)
    names = [name.strip().strip('"') for name in first.split(split)]
    missing = [name for name in columns if name not in names]
    if missing:
        raise InvalidInput(
            "POINTS_INCOMPLETE",
            f"the points file {path} lacks the column {', '.join(missing)}",
            remedy,
            {"file": str(path), "missing": missing},
        )
    places = [names.index(name) for name in columns]
    rows = [
        _numbers(words, places, path, number, remedy)
        for number, words in enumerate(csv.reader(lines[1 : MAX_ROWS + 2], delimiter=split), start=2)
        if any(word.strip() for word in words)
    ]
    if not 0 < len(rows) <= MAX_ROWS:
        raise InvalidInput(
            "POINTS_INCOMPLETE",
            f"the points file {path} has {len(rows)} rows, expected 1 to {MAX_ROWS}",
            remedy,
            {"file": str(path), "rows": len(rows)},
        )
    return np.array(rows, dtype=np.float64)


def _numbers(words: list[str], places: list[int], path: Path, line: int, remedy: str) -> list[float]:
    values = []
    for place in places:
        word = words[place].strip() if place < len(words) else ""
        try:
            value = float(word)
        except ValueError:
            value = math.nan
        if not math.isfinite(value):
            raise InvalidInput(
                "POINTS_INVALID",
                f"line {line} of {path} has '{word}' where a number is expected",
                remedy,
                {"file": str(path), "line": line},
            )
        values.append(value)
    return values
