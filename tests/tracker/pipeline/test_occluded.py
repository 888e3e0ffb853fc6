"""Tracking of a marker that is nearly half occluded by a finger."""

import cv2
import numpy as np
import pytest

from tests.tracker.pipeline.stepped import OUTER_FIELDS, away_from_deg, image_of, off_px, pose_of, tracker_of
from tests.tracker.scenes import CODE, NEIGHBOURS, Fields, Image8
from tracker import Seen, Unseen
from tracker.geometry import Camera, Marker, Rigid

CENTRE_PX = (240.0, 180.0)
SIDES_PX = (28.0, 60.0)


def _pose(side_px: float) -> Rigid[Camera, Marker]:
    return pose_of(CENTRE_PX, side_px, tilt_deg=15.0)


def _under_a_finger(image: Image8, side_px: float, from_deg: float) -> Image8:
    """A finger wider than the marker, from this direction nearly to its centre."""
    toward = np.array([np.cos(np.radians(from_deg)), np.sin(np.radians(from_deg))])
    # The tip is round; its ends are in sixteenths of a pixel.
    width = round(1.6 * side_px)
    tip = np.array(CENTRE_PX) + (0.5 * width + 0.10 * side_px) * toward
    ends = [tuple(np.rint(16 * at).astype(int).tolist()) for at in (tip, tip + 300.0 * toward)]
    covered = cv2.line(image.copy(), ends[0], ends[1], 150, width, cv2.LINE_AA, 4)
    return np.asarray(cv2.GaussianBlur(covered, (0, 0), 0.6), dtype=np.uint8)


def _covered(fields: Fields, side_px: float, from_deg: float) -> Seen | Unseen:
    """Results for these fields under the finger, with the marker tracked from the previous image."""
    tracker, pose = tracker_of(), _pose(side_px)
    tracker.step(image_of(pose), captured_at_s=0.0)
    image = _under_a_finger(image_of(pose, fields=fields), side_px, from_deg)
    return tracker.step(image, captured_at_s=0.03)["code"]


@pytest.mark.parametrize(("side_px", "minimum"), [(28.0, 7), (60.0, 8)])
def test_a_marker_is_kept_when_a_finger_hides_nearly_a_half_of_it(side_px: float, minimum: int) -> None:
    retained = []
    for from_deg in range(0, 360, 45):
        found = _covered(CODE, side_px, from_deg)
        if isinstance(found, Seen):
            assert off_px(found, _pose(side_px)) < 1.0
            retained.append(from_deg)
    assert len(retained) >= minimum


@pytest.mark.parametrize("side_px", SIDES_PX)
@pytest.mark.parametrize("field", OUTER_FIELDS)
def test_a_look_alike_is_not_kept_for_a_finger_on_its_other_side(field: int, side_px: float) -> None:
    found = _covered(NEIGHBOURS[field], side_px, away_from_deg(field))
    # A quarter turn of the remaining part still matches the marker.
    assert isinstance(found, Unseen) or found.found_by == "search"
