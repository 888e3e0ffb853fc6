"""A camera whose lens was adjusted: no measurements, a reason, and a specific alarm."""

from collections.abc import Mapping
from dataclasses import replace
from functools import lru_cache

import numpy as np
import pytest
from structlog.testing import capture_logs

from server.alarms import AlarmService
from server.capture.shot import Shot
from server.config import Config, RehearsalConfig
from server.live import ProcessState, ProcessStatus, SourceState, SourceStatus
from server.loop.tracking import Tracking
from server.loop.tracking_state import capture_state, restore_state
from server.setup import CaseSetup, Preparation, build_setup
from server.texts import alarm_text, headline_of
from tracker.camera import CameraControl
from tracker.navigation import Absent, AbsentReason, Deviation, NavigationSnapshot
from tracker.navigation.alarms import AlarmSnapshot, Condition, Priority

RUNS = SourceStatus(name="camera 0", state=SourceState.RUNNING)
WORKS = ProcessStatus(state=ProcessState.RUNNING)
FOCUS, AUTOFOCUS, GAIN = CameraControl.FOCUS, CameraControl.AUTOFOCUS, CameraControl.GAIN
CALIBRATED = {FOCUS: 120, AUTOFOCUS: 0, GAIN: 20}
PERIOD_S = 1 / 30


@lru_cache(maxsize=1)
def prepared() -> tuple[Preparation, np.ndarray]:
    preparation = build_setup(Config(rehearsal=RehearsalConfig(width=640, height=360)))
    assert preparation.theatre is not None
    return preparation, preparation.theatre.renderer().image_at(0.0)


class Theatre:
    """Images of the rehearsal's drill, from a camera whose controls the test sets."""

    def __init__(self, calibrated: Mapping[CameraControl, int]) -> None:
        preparation, self._image = prepared()
        self.tracking = Tracking(replace(preparation, camera_controls=calibrated))
        self.now_s = 100.0
        self._number = 0
        self._service = AlarmService(Config(), clock=lambda: self.now_s)

    def show(self, controls: Mapping[CameraControl, int]) -> tuple[NavigationSnapshot, AlarmSnapshot]:
        self._number += 1
        self.now_s += PERIOD_S
        self._service.report_screen("theatre", armed=True)
        shot = Shot(
            image=self._image, number=self._number, captured_at_s=self.now_s, source_time_s=self.now_s
        )
        snapshot = self.tracking.process(shot, skipped_images=0, controls=controls)
        return snapshot, self._service.observe(snapshot, RUNS, WORKS)


def test_a_lens_that_moved_takes_the_numbers_and_alarms_by_its_name_until_it_is_set_back() -> None:
    theatre = Theatre(CALIBRATED)
    snapshot, alarms = theatre.show(CALIBRATED)
    assert isinstance(snapshot.deviations["drill"], Deviation)
    assert alarms.alarms == ()
    with capture_logs() as logs:
        for _ in range(3):
            snapshot, alarms = theatre.show({**CALIBRATED, FOCUS: 135})
    assert snapshot.deviations["drill"] == Absent(reason=AbsentReason.CAMERA_CHANGED)
    assert headline_of(snapshot, alarms).title["en"] == "CAMERA CHANGED"
    top = alarms.alarms[0]
    assert (top.condition, top.priority) == (Condition.CAMERA_CHANGED, Priority.HIGH)
    words = alarm_text(top, unix_offset_s=0.0)
    assert words.sentence["en"] == "Focus changed from 120 to 135 since the calibration."
    assert words.sentence["de"] == "Fokus seit der Kalibrierung von 120 auf 135 verstellt."
    assert words.remedy["en"]
    problem = theatre.tracking.problem
    assert problem is not None
    assert problem.code == "CAMERA_CHANGED"
    assert "from 120 to 135" in problem.message
    assert "back to 120" in problem.remedy
    assert [line["code"] for line in logs if line["log_level"] == "warning"] == ["CAMERA_CHANGED"]
    for _ in range(60):
        snapshot, alarms = theatre.show(CALIBRATED)
    assert isinstance(snapshot.deviations["drill"], Deviation)
    assert alarms.alarms == ()
    assert theatre.tracking.problem is None


@pytest.mark.parametrize(
    ("calibrated", "now"),
    [
        pytest.param({}, {**CALIBRATED, FOCUS: 135}, id="the calibration has none"),
        pytest.param(CALIBRATED, {}, id="the camera tells none"),
        pytest.param(CALIBRATED, {**CALIBRATED, GAIN: 90}, id="brightness alone"),
    ],
)
def test_unknown_or_harmless_changes_raise_no_alarm(
    calibrated: Mapping[CameraControl, int], now: Mapping[CameraControl, int]
) -> None:
    theatre = Theatre(calibrated)
    for _ in range(3):
        snapshot, alarms = theatre.show(now)
    assert isinstance(snapshot.deviations["drill"], Deviation)
    assert alarms.alarms == ()
    assert theatre.tracking.problem is None


def test_without_a_calibration_no_control_counts() -> None:
    preparation, image = prepared()
    tracking = Tracking(replace(preparation, camera=None, camera_controls=CALIBRATED))
    shot = Shot(image=image, number=0, captured_at_s=1.0, source_time_s=1.0)
    snapshot = tracking.process(shot, skipped_images=0, controls={**CALIBRATED, FOCUS: 135})
    assert snapshot.motion.camera_changes == ()
    assert tracking.problem is None


def test_the_calibration_of_a_case_brings_its_own_controls() -> None:
    preparation, _ = prepared()
    from_settings = replace(preparation, camera_controls=CALIBRATED)
    assert from_settings.with_case(CaseSetup()).camera_controls == CALIBRATED
    of_case = CaseSetup(camera=preparation.camera, camera_controls={FOCUS: 45})
    assert from_settings.with_case(of_case).camera_controls == {FOCUS: 45}
    # A calibration of the case without controls is not compared with the controls of the settings' one.
    assert from_settings.with_case(CaseSetup(camera=preparation.camera)).camera_controls == {}
    calibrated = from_settings.with_case(of_case).calibrated_camera
    assert calibrated is not None
    assert calibrated.controls == {FOCUS: 45}


def test_images_that_change_their_size_lose_their_millimetres_with_the_first_one() -> None:
    preparation, image = prepared()
    tracking = Tracking(preparation)
    smaller = np.ascontiguousarray(image[::2, ::2])
    reported = []
    for number, shown in enumerate((image, smaller, image)):
        at_s = 1.0 + number * PERIOD_S
        shot = Shot(image=shown, number=number, captured_at_s=at_s, source_time_s=at_s)
        snapshot = tracking.process(shot, skipped_images=0)
        problem = tracking.problem
        reported.append((snapshot.setup.camera_calibrated, "" if problem is None else problem.code))
    assert reported == [(True, ""), (False, "CAMERA_SIZE_MISMATCH"), (True, "")]


def test_another_camera_than_the_calibrated_one_gives_no_millimetres_until_it_is_back() -> None:
    preparation, image = prepared()
    tracking = Tracking(replace(preparation, camera_device="Webcam A"))
    reported = []
    # The status of a camera that is being opened has no controls.
    for number, device in enumerate(("Webcam A", "", "Webcam B", "", "Webcam A")):
        at_s = 1.0 + number * PERIOD_S
        shot = Shot(image=image, number=number, captured_at_s=at_s, source_time_s=at_s)
        snapshot = tracking.process(shot, skipped_images=0, device=device)
        problem = tracking.problem
        reported.append((snapshot.setup.camera_calibrated, "" if problem is None else problem.code))
        if problem is not None:
            assert "'Webcam A'" in problem.message
            assert "'Webcam B'" in problem.message
        restored = restore_state(capture_state(tracking), at_s=at_s)
        assert restored.setup is not None
        assert restored.setup.camera_calibrated is snapshot.setup.camera_calibrated
    differs = (False, "CAMERA_DIFFERS")
    assert reported == [(True, ""), (True, ""), differs, differs, (True, "")]


def test_a_calibration_that_names_no_camera_is_used_with_any() -> None:
    preparation, image = prepared()
    tracking = Tracking(preparation)
    shot = Shot(image=image, number=0, captured_at_s=1.0, source_time_s=1.0)
    assert tracking.process(shot, skipped_images=0, device="Webcam B").setup.camera_calibrated
