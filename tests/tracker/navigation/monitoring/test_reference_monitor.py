"""The patient marker, and the time since each marker was seen."""

import numpy as np
import pytest

from tracker.geometry import Camera, Marker, Rigid
from tracker.navigation.monitoring import (
    LastSeen,
    NeverSeen,
    ReferenceMonitor,
    ReferenceSettings,
    ReferenceState,
    SceneState,
)
from tracker.pose import Seen, Unseen, UnseenReason

SETTINGS = ReferenceSettings(confirm_images=3)


def _reference(x_mm: float = 0.0, rotation_deg: float = 0.0) -> Rigid[Camera, Marker]:
    return Rigid.from_vector([0.0, 0.0, np.radians(rotation_deg)], [x_mm, 0.0, 500.0])


@pytest.mark.parametrize(
    ("x_mm", "rotation_deg", "scene", "state"),
    [
        pytest.param(2.0, 1.0, SceneState.STILL, ReferenceState.IN_PLACE, id="breath"),
        pytest.param(6.0, 0.0, SceneState.STILL, ReferenceState.MOVED, id="bumped"),
        pytest.param(0.0, 5.0, SceneState.STILL, ReferenceState.MOVED, id="twisted"),
        pytest.param(6.0, 0.0, SceneState.MOVED, ReferenceState.WITH_CAMERA, id="camera-moved"),
        pytest.param(6.0, 0.0, SceneState.UNSURE, ReferenceState.UNDETERMINED, id="scene-covered"),
        pytest.param(6.0, 0.0, SceneState.NO_TEXTURE, ReferenceState.UNDETERMINED, id="nothing-to-hold-on"),
    ],
)
def test_a_reference_that_moved_is_distinguished_from_a_camera_that_did(
    x_mm: float, rotation_deg: float, scene: SceneState, state: ReferenceState
) -> None:
    watch = ReferenceMonitor(_reference(), settings=SETTINGS)
    checks = [watch.check(_reference(x_mm, rotation_deg), scene) for _ in range(3)]
    assert checks[0].state is ReferenceState.IN_PLACE
    assert checks[2].state is state
    assert checks[2].moved_mm == pytest.approx(x_mm)
    assert checks[2].rotated_deg == pytest.approx(rotation_deg)


def test_a_single_wrong_pose_moves_nothing() -> None:
    watch = ReferenceMonitor(_reference(), settings=SETTINGS)
    poses = [9.0, 0.0, 9.0, 9.0, 0.0, 9.0]
    states = {watch.check(_reference(x), SceneState.STILL).state for x in poses}
    assert states == {ReferenceState.IN_PLACE}


SEEN = Seen(
    camera_from_marker=_reference(),
    pose_covariance=np.eye(6),
    corners_px=np.zeros((4, 2)),
    score_ratio=1.0,
    target_score_ratio=1.0,
    model_coverage_ratio=1.0,
    target_coverage_ratio=1.0,
    fit_error_px2=0.1,
    found_by="track",
)
UNSEEN = Unseen(reason=UnseenReason.NO_CANDIDATE)


def test_the_time_since_the_last_sight_is_reported_for_each_marker() -> None:
    sight = LastSeen()
    sight = sight.after({"drill": SEEN, "reference": UNSEEN}, at_s=10.0)
    sight = sight.after({"drill": UNSEEN, "reference": UNSEEN}, at_s=10.5)
    assert sight.ages_s(["drill", "reference"], at_s=10.5) == {"drill": 0.5, "reference": NeverSeen()}
    assert sight.after({"reference": SEEN}, at_s=11.0).age_s("reference", at_s=11.0) == 0.0
    # The earlier record is unchanged.
    assert sight.age_s("reference", at_s=11.0) == NeverSeen()
