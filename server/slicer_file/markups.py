"""Markups of 3D Slicer (`.mrk.json`): point lists, lines, and open and closed curves.

A file states for each markup whether its positions are LPS or RAS (x and y negated). They are converted to
LPS, the frame of the plan. A file without this statement is rejected, although the schema has a default,
because a plan with two negated axes still looks like a plan.

Only control points are read, not the interpolated points of a curve. Slicer writes them in the frame of their
node, without the parent transforms of the node in the scene.
"""

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum
from typing import NoReturn

import numpy as np

from tracker.errors import InvalidInput
from tracker.geometry import Array

SUFFIX = ".mrk.json"
SCHEMA = (
    "https://raw.githubusercontent.com/slicer/slicer/master/Modules/Loadable/Markups/Resources/Schema/"
    "markups-schema-v1.0.3.json#"
)
MAX_BYTES = 20 * 2**20
MAX_MARKUPS, MAX_POINTS, MAX_COORDINATE_MM = 500, 100_000, 10_000.0
LPS_FROM: Mapping[str, Array] = {"LPS": np.ones(3), "RAS": np.array([-1.0, -1.0, 1.0])}
MILLIMETRES = ("mm", ["mm", "UCUM", "millimeter"])
REMEDY = "Save the markup in 3D Slicer again, as Markups JSON (.mrk.json)."


class MarkupKind(StrEnum):
    """Kind of a markup, as Slicer names it. Others (angles, planes, regions) are not read."""

    POINTS = "Fiducial"
    LINE = "Line"
    CURVE = "Curve"
    CLOSED_CURVE = "ClosedCurve"


@dataclass(frozen=True, slots=True, kw_only=True)
class Markup:
    """One markup.

    Attributes:
        kind: its kind.
        name: Name of its node in the scene; may be empty in a file of one markup.
        points_lps_mm: (n, 3), its control points in order.
        labels: One per point; may be empty or equal.
        description: Shown with each point.
    """

    kind: MarkupKind
    name: str
    points_lps_mm: Array
    labels: tuple[str, ...]
    description: str = ""


def is_markups_name(name: str) -> bool:
    """Return whether a file of this name contains markups."""
    return name.lower().endswith(SUFFIX)


def markups_from_bytes(content: bytes, *, name: str) -> tuple[Markup, ...]:
    """Parse a file of markups; empty markups and those of other kinds are skipped.

    Args:
        content: Bytes of the file.
        name: Name of the file, for messages.

    Raises:
        InvalidInput: MARKUPS_UNREADABLE, the file is not a file of markups; MARKUPS_INVALID, its content is
            invalid, or a point has no position.
    """
    found = []
    for number, values in enumerate(_listed(content, name), start=1):
        if not isinstance(values, Mapping):
            raise _invalid(name, f"markup {number} is not an object")
        kind = values.get("type")
        if isinstance(kind, str) and kind in set(MarkupKind) and values.get("controlPoints"):
            found.append(_markup(values, MarkupKind(kind), f"markup {number}", name))
    return tuple(found)


def markups_to_bytes(markups: Sequence[Markup]) -> bytes:
    """Return the content of a file with these markups, in LPS; Slicer loads each as a separate node."""
    return json.dumps(
        {"@schema": SCHEMA, "markups": [_mapping(one) for one in markups]}, indent=1, allow_nan=False
    ).encode()


def _mapping(markup: Markup) -> dict[str, object]:
    return {
        "type": markup.kind.value,
        "name": markup.name,
        "coordinateSystem": "LPS",
        "coordinateUnits": "mm",
        "locked": True,
        "controlPoints": [
            {
                "id": str(number),
                "label": label,
                "description": markup.description,
                "position": [float(value) for value in point],
                "positionStatus": "defined",
            }
            for number, (label, point) in enumerate(
                zip(markup.labels, markup.points_lps_mm, strict=True), start=1
            )
        ],
    }


def _listed(content: bytes, name: str) -> Sequence[object]:
    if len(content) > MAX_BYTES:
        raise _unreadable(name, f"it has more than {MAX_BYTES / 2**20:.0f} MB")
    try:
        values = json.loads(content.decode("utf-8-sig"), parse_constant=_no_number)
    except (ValueError, RecursionError):
        raise _unreadable(name, "it is not valid JSON") from None
    markups = values.get("markups") if isinstance(values, Mapping) else None
    if not isinstance(markups, list):
        raise _unreadable(name, "it has no list 'markups'")
    if len(markups) > MAX_MARKUPS:
        raise _unreadable(name, f"it has {len(markups)} markups, the maximum is {MAX_MARKUPS}")
    return markups


def _markup(values: Mapping[str, object], kind: MarkupKind, which: str, name: str) -> Markup:
    title = values.get("name", "")
    if not isinstance(title, str):
        raise _invalid(name, f"the name of {which} is not a text")
    which = f"'{title[:40]}'" if title else which
    system, units = values.get("coordinateSystem"), values.get("coordinateUnits", "mm")
    if not isinstance(system, str) or system not in LPS_FROM:
        raise _invalid(name, f"{which} has the coordinate system {_shown(system)}, expected LPS or RAS")
    if units not in MILLIMETRES:
        raise _invalid(name, f"{which} has its coordinates in {_shown(units)}, expected mm")
    points = values["controlPoints"]
    if not isinstance(points, list) or len(points) > MAX_POINTS:
        count = len(points) if isinstance(points, list) else 0
        raise _invalid(name, f"{which} has {count} control points, expected 1 to {MAX_POINTS}")
    rows = [_point(point, f"point {n} of {which}", name) for n, point in enumerate(points, start=1)]
    if kind is MarkupKind.LINE and len(rows) != 2:
        raise _invalid(name, f"the line {which} has {len(rows)} control points, expected 2")
    return Markup(
        kind=kind,
        name=title,
        points_lps_mm=np.array([row for _, row in rows], dtype=np.float64) * LPS_FROM[system],
        labels=tuple(label for label, _ in rows),
    )


def _point(values: object, which: str, name: str) -> tuple[str, list[float]]:
    if not isinstance(values, Mapping):
        raise _invalid(name, f"{which} is not an object")
    label, status = values.get("label", ""), values.get("positionStatus", "defined")
    if not isinstance(label, str):
        raise _invalid(name, f"the label of {which} is not a text")
    if status != "defined":
        # Skipping it would change the numbers of all later points.
        raise _invalid(name, f"{which} is not placed (its positionStatus is {_shown(status)})")
    position = values.get("position")
    if not isinstance(position, list) or len(position) != 3 or not all(map(_is_coordinate, position)):
        raise _invalid(
            name,
            f"{which} has the position {_shown(position)}, expected three numbers up to "
            f"{MAX_COORDINATE_MM:g} mm",
        )
    return label, [float(number) for number in position]


def _is_coordinate(value: object) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool) and abs(value) <= MAX_COORDINATE_MM


def _no_number(word: str) -> NoReturn:
    raise ValueError(word)


def _shown(value: object) -> str:
    return repr(value)[:60]


def _unreadable(name: str, why: str) -> InvalidInput:
    return InvalidInput(
        "MARKUPS_UNREADABLE",
        f"{name} is not a file of markups: {why}",
        REMEDY,
        {"file": name, "markup_problem": why},
    )


def _invalid(name: str, why: str) -> InvalidInput:
    return InvalidInput(
        "MARKUPS_INVALID", f"{name} cannot be used: {why}", REMEDY, {"file": name, "markup_problem": why}
    )
