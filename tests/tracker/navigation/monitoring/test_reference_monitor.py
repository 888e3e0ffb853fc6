"""The patient marker, and the time since each marker was seen."""

import math

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
HZ = 30.0


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
    for n in range(30):
        watch.check(_reference(), SceneState.STILL, at_s=n / HZ)
    checks = [watch.check(_reference(x_mm, rotation_deg), scene, at_s=n / HZ) for n in range(30, 36)]
    assert checks[0].state is ReferenceState.IN_PLACE
    assert checks[5].state is state
    assert checks[2].moved_mm == pytest.approx(x_mm)
    assert checks[2].rotated_deg == pytest.approx(rotation_deg)


def test_a_single_wrong_pose_moves_nothing() -> None:
    watch = ReferenceMonitor(_reference(), settings=SETTINGS)
    poses = [9.0, 0.0, 9.0, 9.0, 0.0, 9.0]
    states = {watch.check(_reference(x), SceneState.STILL, at_s=n / HZ).state for n, x in enumerate(poses)}
    assert states == {ReferenceState.IN_PLACE}


def _breathing_mm(at_s: float, depth_mm: float, period_s: float = 4.0) -> float:
    """Return the displacement by breathing, from 0 to its depth."""
    return depth_mm * (1.0 - math.cos(2.0 * math.pi * at_s / period_s)) / 2.0


class Patient:
    """A breathing patient before a still scene; `bump_mm` displaces the reference on it."""

    def __init__(self, depth_mm: float, *, rotation_deg: float = 0.0) -> None:
        self.watch = ReferenceMonitor(_reference())
        self.depth_mm, self.rotation_deg = depth_mm, rotation_deg
        self.bump_mm = 0.0
        self.slip_mm_s = 0.0
        self.number = 0

    def breathe(self, seconds: float) -> list[ReferenceState]:
        states = []
        for _ in range(round(seconds * HZ)):
            self.number += 1
            self.bump_mm += self.slip_mm_s / HZ
            at_s = self.number / HZ
            breath = _breathing_mm(at_s, 1.0)
            pose = _reference(self.depth_mm * breath + self.bump_mm, self.rotation_deg * breath)
            states.append(self.watch.check(pose, SceneState.STILL, at_s=at_s).state)
        return states


@pytest.mark.parametrize("depth_mm", [5.0, 8.0, 10.0])
def test_two_breaths_are_doubted_and_later_ones_are_not(depth_mm: float) -> None:
    patient = Patient(depth_mm, rotation_deg=2.0)
    first = patient.breathe(8.0)
    assert set(first) == {ReferenceState.IN_PLACE, ReferenceState.SWAYING}
    assert set(patient.breathe(60.0)) == {ReferenceState.IN_PLACE, ReferenceState.BREATHING}


@pytest.mark.parametrize("at_phase_s", [0.0, 1.0, 2.0, 3.0])
def test_a_bump_of_a_breathing_patient_is_reported_at_once(at_phase_s: float) -> None:
    patient = Patient(6.0)
    patient.breathe(20.0 + at_phase_s)
    patient.bump_mm = 7.0
    states = patient.breathe(0.5)
    assert ReferenceState.MOVED in states
    assert ReferenceState.BREATHING not in states[SETTINGS.confirm_images + 2 :]


def test_a_reference_that_slips_slowly_and_stays_away_is_reported_after_a_breath() -> None:
    patient = Patient(0.0)
    patient.breathe(5.0)
    patient.slip_mm_s = 2.0
    patient.breathe(2.5)
    patient.slip_mm_s = 0.0
    states = patient.breathe(7.0)
    assert ReferenceState.BREATHING not in states
    assert states[-1] is ReferenceState.MOVED


def test_a_breath_that_does_not_return_is_reported() -> None:
    patient = Patient(8.0)
    patient.breathe(18.0)
    # At its deepest, and held there.
    pose, began_s = _reference(8.0), patient.number / HZ
    states = [patient.watch.check(pose, SceneState.STILL, at_s=began_s + n / HZ).state for n in range(1, 240)]
    assert states[0] is ReferenceState.BREATHING
    assert states[-1] is ReferenceState.MOVED


def test_a_breath_much_deeper_than_those_before_is_doubted_until_it_ends() -> None:
    patient = Patient(4.5)
    patient.breathe(20.0)
    patient.depth_mm = 9.0
    states = patient.breathe(4.0)
    assert ReferenceState.SWAYING in states
    assert ReferenceState.MOVED not in states


@pytest.mark.parametrize("rate_hz", [5.0, 10.0, 60.0])
def test_a_fast_motion_is_no_breath_at_any_rate_of_images(rate_hz: float) -> None:
    watch = ReferenceMonitor(_reference())
    states = []
    for n in range(round(4.0 * rate_hz)):
        at_s = n / rate_hz
        pose = _reference(5.0 if at_s > 2.0 else 0.0)
        states.append(watch.check(pose, SceneState.STILL, at_s=at_s).state)
    assert states.index(ReferenceState.MOVED) <= 2.0 * rate_hz + max(6.0, 0.2 * rate_hz)


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
