"""One marker, its images, and a tracker of it, for the tests of the tracker."""

from collections.abc import Callable

import numpy as np

from tests.tracker.scenes import (
    CODE,
    Fields,
    Image8,
    Print,
    camera_of,
    code_image,
    code_model,
    corners_px_of,
    facing_at_px,
    rendered,
)
from tracker import Seen, Tracker
from tracker.geometry import Camera, Marker, Rigid

CAMERA = camera_of((480, 360), focal_px=550.0)
MODEL = code_model()
# All but the middle one, which has no other side.
OUTER_FIELDS = [field for field in range(9) if field != 4]


def pose_of(
    centre_px: tuple[float, float] = (240.0, 180.0),
    side_px: float = 50.0,
    *,
    tilt_deg: float = 25.0,
    roll_deg: float = 10.0,
) -> Rigid[Camera, Marker]:
    return facing_at_px(CAMERA, centre_px, side_px, tilt_deg=tilt_deg, about_deg=50, roll_deg=roll_deg)


def image_of(*poses: Rigid[Camera, Marker], fields: Fields = CODE, seed: int = 0) -> Image8:
    return rendered(CAMERA, [Print(picture=code_image(fields), pose=p) for p in poses], seed=seed)


def tracker_of(*, clock: Callable[[], float] | None = None) -> Tracker:
    return Tracker(camera=CAMERA, models=[MODEL], clock=clock)


def off_px(sighting: Seen, pose: Rigid[Camera, Marker]) -> float:
    return float(np.abs(sighting.corners_px - corners_px_of(CAMERA, pose)).max())


def away_from_deg(field: int) -> float:
    """Position of the opposite side of the face from a field of the code; the face is upright."""
    row, column = divmod(field, 3)
    return float(np.degrees(np.arctan2(1 - row, 1 - column)))


def assert_same(a: Seen, b: Seen) -> None:
    for name in a.__slots__:
        if name == "camera_from_marker":
            np.testing.assert_array_equal(a.camera_from_marker.matrix, b.camera_from_marker.matrix)
        else:
            np.testing.assert_array_equal(getattr(a, name), getattr(b, name))
