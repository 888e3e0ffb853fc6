"""Markups of 3D Slicer: their coordinate frame, and rejections instead of guesses."""

import json
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from server.slicer_file import Markup, MarkupKind, markups_from_bytes, markups_to_bytes
from tracker.errors import InvalidInput

NAME = "points.mrk.json"


def of_slicer(kind: str = "Fiducial", system: str = "LPS", **more: object) -> dict[str, Any]:
    """As written by 3D Slicer 5, shortened."""
    return {
        "@schema": "https://raw.githubusercontent.com/slicer/slicer/master/schema.json#",
        "markups": [
            {
                "type": kind,
                "coordinateSystem": system,
                "coordinateUnits": "mm",
                "controlPoints": [
                    {"id": "1", "label": "tip", "position": [1.5, -2.0, 3.0], "positionStatus": "defined"},
                    {"id": "2", "label": "facet", "position": [4.0, 5.0, -6.0], "positionStatus": "defined"},
                ],
                "measurements": [{"name": "length", "enabled": False}],
                "display": {"visibility": True},
                **more,
            }
        ],
    }


def read(values: object) -> tuple[Markup, ...]:
    return markups_from_bytes(json.dumps(values).encode(), name=NAME)


@pytest.mark.parametrize("kind", ["Fiducial", "Line", "Curve", "ClosedCurve"])
def test_each_kind_is_read_with_its_points_in_order(kind: str) -> None:
    (markup,) = read(of_slicer(kind))
    assert markup.kind is MarkupKind(kind)
    assert markup.labels == ("tip", "facet")
    assert markup.points_lps_mm.tolist() == [[1.5, -2.0, 3.0], [4.0, 5.0, -6.0]]


def test_ras_has_the_first_two_axes_with_the_other_sign() -> None:
    (markup,) = read(of_slicer(system="RAS"))
    assert markup.points_lps_mm.tolist() == [[-1.5, 2.0, 3.0], [-4.0, -5.0, -6.0]]


def test_what_is_written_is_read_again_and_states_lps() -> None:
    markups = tuple(
        Markup(
            kind=kind, name=kind.name, points_lps_mm=np.array([[0.1, 2, 3], [4, 5, 1 / 3]]), labels=("a", "ä")
        )
        for kind in MarkupKind
    )
    content = markups_to_bytes(markups)
    assert {one["coordinateSystem"] for one in json.loads(content)["markups"]} == {"LPS"}
    for before, after in zip(markups, markups_from_bytes(content, name=NAME), strict=True):
        assert (after.kind, after.name, after.labels) == (before.kind, before.name, before.labels)
        assert np.array_equal(after.points_lps_mm, before.points_lps_mm)


def test_other_kinds_and_empty_markups_are_left_out() -> None:
    values = of_slicer()
    values["markups"] += [{"type": "Plane", "controlPoints": [{}]}, {"type": "Line", "controlPoints": []}]
    assert len(read(values)) == 1


def point(**changed: object) -> Callable[[dict[str, Any]], None]:
    return lambda values: values["markups"][0]["controlPoints"][1].update(changed)


def markup(**changed: object) -> Callable[[dict[str, Any]], None]:
    return lambda values: values["markups"][0].update(changed)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        pytest.param(markup(coordinateSystem=None), "coordinate system None", id="no-coordinate-system"),
        pytest.param(markup(coordinateSystem="lps"), "coordinate system 'lps'", id="another-system"),
        pytest.param(markup(coordinateSystem=0), "coordinate system 0", id="a-number-of-old-files"),
        pytest.param(markup(coordinateUnits="um"), "coordinates in 'um'", id="micrometres"),
        pytest.param(markup(name=3), "not a text", id="a-name-that-is-a-number"),
        pytest.param(markup(controlPoints={"a": 1}), "control points", id="points-in-a-mapping"),
        pytest.param(point(positionStatus="undefined"), "point 2 of markup 1 is not placed", id="not-placed"),
        pytest.param(point(position=[1.0, 2.0]), "[1.0, 2.0]", id="two-coordinates"),
        pytest.param(point(position=[1.0, 2.0, True]), "three numbers", id="a-truth-value"),
        pytest.param(point(position=[1.0, 2.0, 1e5]), "three numbers up to 10000 mm", id="too-far"),
        pytest.param(point(position=None), "three numbers", id="no-position"),
        pytest.param(point(label=None), "not a text", id="no-label"),
    ],
)
def test_what_cannot_be_meant_is_rejected_with_its_place(
    change: Callable[[dict[str, Any]], None], said: str
) -> None:
    values = of_slicer()
    change(values)
    with pytest.raises(InvalidInput) as rejected:
        read(values)
    assert rejected.value.code == "MARKUPS_INVALID"
    assert said in rejected.value.message


def test_a_line_has_two_points() -> None:
    values = of_slicer("Line")
    del values["markups"][0]["controlPoints"][1]
    with pytest.raises(InvalidInput, match="1 control points, expected 2"):
        read(values)


@pytest.mark.parametrize(
    "content",
    [
        b"",
        b"\xff",
        b"[]",
        b"{}",
        b'{"markups": {}}',
        b"[" * 100_000,
        b'{"markups": [NaN]}',
        b'{"markups": [{"type": "Fiducial", "controlPoints": [{"position": [Infinity, 0, 0]}]}]}',
        json.dumps({"markups": [{}] * 501}).encode(),
    ],
)
def test_what_is_no_file_of_markups_is_rejected(content: bytes) -> None:
    with pytest.raises(InvalidInput) as rejected:
        markups_from_bytes(content, name=NAME)
    assert rejected.value.code == "MARKUPS_UNREADABLE"


def test_a_file_cut_at_any_byte_is_rejected() -> None:
    content = json.dumps(of_slicer()).encode()
    for length in range(len(content)):
        with pytest.raises(InvalidInput):
            markups_from_bytes(content[:length], name=NAME)
