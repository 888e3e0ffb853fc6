"""Ambiguous markers are reported before the first image."""

import cv2
import numpy as np
import pytest
import structlog

from server.config import Config
from server.marker_remarks import reject_ambiguous_markers
from server.setup import build_setup
from tests.benchmarks.scenes.faces import FACES
from tracker.errors import InvalidInput
from tracker.marker import MarkerModel


def marker_of(*strokes: tuple[tuple[int, int], tuple[int, int]]) -> MarkerModel:
    """Black, with a white square inside and black strokes (left top, right bottom) on it; 100 px wide."""
    picture = np.zeros((100, 100), np.uint8)
    cv2.rectangle(picture, (15, 15), (84, 84), 255, cv2.FILLED)
    for start, end in strokes:
        cv2.rectangle(picture, start, end, 0, cv2.FILLED)
    return MarkerModel.from_image(picture, side_mm=25.0, name="m")


@pytest.mark.parametrize(
    ("marker", "codes"),
    [
        # An arrow with its head slightly off-centre: nearly mirror-symmetric, without rotational symmetry.
        (marker_of(((45, 25), (54, 75)), ((28, 25), (77, 40))), ["MARKER_NEARLY_MIRRORED"]),
        # Two opposite corners of nearly equal size: also its own mirror image about a diagonal.
        (
            marker_of(((25, 25), (50, 45)), ((52, 55), (74, 74))),
            ["MARKER_NEARLY_SYMMETRIC", "MARKER_NEARLY_MIRRORED"],
        ),
        *((face.model, []) for face in FACES),
    ],
    ids=["arrow", "opposite", *(face.name for face in FACES)],
)
def test_what_may_be_taken_for_itself_is_reported_with_its_likeness(
    marker: MarkerModel, codes: list[str]
) -> None:
    with structlog.testing.capture_logs() as said:
        reject_ambiguous_markers([marker])
    assert [line["code"] for line in said] == codes
    for line, correlation in zip(said, [one for one in marker.own_correlation if one > 0.9], strict=True):
        assert f"correlation {correlation:.2f}" in line["event"]
        assert "coaxial marker design" in line["remedy"]


def test_a_marker_that_is_its_own_mirror_image_is_rejected() -> None:
    arrow = marker_of(((45, 25), (54, 75)), ((25, 25), (74, 40)))
    with pytest.raises(InvalidInput, match=r"own mirror image: correlation 1\.000, allowed 0\.985") as caught:
        reject_ambiguous_markers([FACES[0].model, arrow])
    assert caught.value.code == "MARKER_MIRROR_SYMMETRIC"
    assert "coaxial marker design" in caught.value.remedy


def test_the_rehearsal_s_own_markers_need_no_word() -> None:
    with structlog.testing.capture_logs() as said:
        reject_ambiguous_markers(
            build_setup(Config.model_validate({"rehearsal": {"reference": True}})).models
        )
    assert said == []
