"""Tracking of a marker that is half saturated by glare."""

import numpy as np
import pytest

from tests.tracker.pipeline.stepped import OUTER_FIELDS, away_from_deg, image_of, off_px, pose_of, tracker_of
from tests.tracker.scenes import CODE, NEIGHBOURS, Fields, Image8, seen
from tracker import Seen, Unseen
from tracker.geometry import Camera, Marker, Rigid

SIDE_PX = 60.0
CENTRE_PX = (240.0, 180.0)
POSE: Rigid[Camera, Marker] = pose_of(CENTRE_PX, SIDE_PX)


def _under_glare(image: Image8, from_deg: float) -> Image8:
    """A highlight twice as bright as the sensor can take, on one side of the marker."""
    height, width = image.shape
    v, u = np.mgrid[0:height, 0:width].astype(np.float64)
    u = u - CENTRE_PX[0] - 0.4 * SIDE_PX * np.cos(np.radians(from_deg))
    v = v - CENTRE_PX[1] - 0.4 * SIDE_PX * np.sin(np.radians(from_deg))
    light = 500.0 * np.exp(-0.5 * (u * u + v * v) / (0.27 * SIDE_PX) ** 2)
    return np.asarray(np.clip(np.rint(image + light), 0, 255), dtype=np.uint8)


def _in_glare(fields: Fields, from_deg: float) -> Seen | Unseen:
    """Results for these fields under glare, with the marker tracked from the previous image."""
    tracker = tracker_of()
    tracker.step(image_of(POSE), captured_at_s=0.0)
    return tracker.step(_under_glare(image_of(POSE, fields=fields), from_deg), captured_at_s=0.03)["code"]


@pytest.mark.parametrize("from_deg", range(0, 360, 45))
def test_a_marker_is_kept_where_it_was_when_glare_hides_a_half_of_it(from_deg: float) -> None:
    found = seen(_in_glare(CODE, from_deg))
    assert found.found_by == "track"
    assert off_px(found, POSE) < 0.6


@pytest.mark.parametrize("field", OUTER_FIELDS)
def test_a_look_alike_is_not_kept_for_the_glare_on_its_other_side(field: int) -> None:
    assert isinstance(_in_glare(NEIGHBOURS[field], away_from_deg(field)), Unseen)


def test_a_blank_sheet_in_glare_is_not_kept() -> None:
    tracker = tracker_of()
    tracker.step(image_of(POSE), captured_at_s=0.0)
    for k in range(4):
        image = _under_glare(image_of(), 90.0 * k)
        assert isinstance(tracker.step(image, captured_at_s=0.01 * (k + 1))["code"], Unseen)
