"""Regression tests of wrongly chosen planar solutions."""

import numpy as np
import pytest

from tests.tracker.rehearsal.stills import STILLS
from tracker import Seen, Tracker
from tracker.rehearsal import Theatre, TheatreSettings


@pytest.mark.parametrize(
    ("seed", "rate_hz"),
    [
        pytest.param(1, 10, id="the first fit stops halfway and its mirror image mirrors nothing"),
        pytest.param(5, 8, id="so does the second"),
        pytest.param(10, 5, id="farther still"),
    ],
)
def test_a_jump_farther_than_the_reach_does_not_end_in_the_mirrored_pose(seed: int, rate_hz: float) -> None:
    # Few images a second while the hand speeds up: the marker is six to ten pixels from where it is expected.
    theatre = Theatre(TheatreSettings(seed=seed))
    renderer = theatre.renderer(store=STILLS)
    tracker = Tracker(camera=theatre.camera, models=[theatre.marker])
    tip_in_marker_mm = theatre.tool.marker_from_tool.translation_mm
    for number in range(round(28.5 * rate_hz), round(31.5 * rate_hz) + 1):
        at_s = number / rate_hz
        truth = theatre.truth_at(at_s)
        seen = tracker.step(renderer.image_at(at_s), captured_at_s=at_s)["drill"]
        if not truth.marker_in_view:
            continue
        assert isinstance(seen, Seen)
        tip_mm = seen.camera_from_marker.move_points(tip_in_marker_mm)
        off_mm = tip_mm - truth.camera_from_marker.move_points(tip_in_marker_mm)
        assert float(np.linalg.norm(off_mm)) < 1.0, f"image {number}"
