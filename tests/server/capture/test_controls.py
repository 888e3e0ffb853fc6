"""Camera controls: locked at the start, read once a second, and never reverted after a user's change."""

import errno
from collections.abc import Mapping

import pytest
from structlog.testing import capture_logs

from server.capture.controls import SETTLES_S, ControlLock
from tests.server.capture.fake_camera import WEBCAM_CONTROLS, FakeCamera
from tracker.camera import CameraControl

BEGIN_S = 100.0
FOCUS, AUTOFOCUS = CameraControl.FOCUS, CameraControl.AUTOFOCUS
AUTO_EXPOSURE, EXPOSURE = CameraControl.AUTO_EXPOSURE, CameraControl.EXPOSURE
AUTO_WHITE, WHITE = CameraControl.AUTO_WHITE_BALANCE, CameraControl.WHITE_BALANCE


def keeper_of(
    camera: FakeCamera,
    *,
    lock_focus: bool = True,
    lock_light: bool = False,
    calibrated: Mapping[CameraControl, int] | None = None,
) -> ControlLock:
    return ControlLock(
        camera,
        name="camera 0",
        lock_focus=lock_focus,
        lock_light=lock_light,
        calibrated=calibrated or {},
        at_s=BEGIN_S,
    )


def test_automatic_focus_is_switched_off_once_it_has_found_the_scene() -> None:
    camera = FakeCamera()
    keeper = keeper_of(camera)
    keeper.poll(BEGIN_S + SETTLES_S - 0.1)
    assert camera.was_set == []
    camera.controls[FOCUS] = 38
    keeper.poll(BEGIN_S + SETTLES_S)
    # Also set to its present value: in automatic mode the value may not have followed the lens.
    assert camera.was_set == [(AUTOFOCUS, 0), (FOCUS, 38)]
    assert keeper.values == {**WEBCAM_CONTROLS, AUTOFOCUS: 0, FOCUS: 38}
    keeper.poll(BEGIN_S + 60.0)
    assert len(camera.was_set) == 2, "once"


def test_the_focus_of_the_calibration_is_set_at_once() -> None:
    camera = FakeCamera()
    keeper = keeper_of(camera, calibrated={FOCUS: 45, CameraControl.GAIN: 99, CameraControl.ZOOM: 7})
    # Not the gain, which invalidates nothing, nor the zoom, which it does not have.
    assert camera.was_set == [(AUTOFOCUS, 0), (FOCUS, 45)]
    assert keeper.values[FOCUS] == 45
    keeper.poll(BEGIN_S + SETTLES_S)
    assert len(camera.was_set) == 2


def test_zoom_pan_and_tilt_of_the_calibration_are_set_and_without_one_left_alone() -> None:
    placed = {CameraControl.ZOOM: 100, CameraControl.PAN: 5, CameraControl.TILT: 6}
    camera = FakeCamera(controls={**WEBCAM_CONTROLS, **placed})
    keeper_of(camera, calibrated={CameraControl.ZOOM: 120, CameraControl.TILT: 0})
    assert camera.was_set == [(CameraControl.ZOOM, 120), (CameraControl.TILT, 0)]
    other = FakeCamera(controls={**WEBCAM_CONTROLS, **placed})
    keeper_of(other).poll(BEGIN_S + SETTLES_S)
    assert other.was_set == [(AUTOFOCUS, 0), (FOCUS, 30)]


def test_nothing_is_set_where_the_settings_say_so() -> None:
    camera = FakeCamera()
    keeper = keeper_of(camera, lock_focus=False, calibrated={FOCUS: 45})
    keeper.poll(200.0)
    assert camera.was_set == []
    assert keeper.values == WEBCAM_CONTROLS


def test_values_are_read_once_a_second_and_what_a_person_changes_stays() -> None:
    camera = FakeCamera()
    keeper = keeper_of(camera, calibrated={FOCUS: 30})
    camera.was_set.clear()
    camera.controls[FOCUS] = 60
    keeper.poll(100.9)
    assert keeper.values[FOCUS] == 30
    keeper.poll(101.0)
    assert keeper.values[FOCUS] == 60
    assert camera.was_set == []


def test_exposure_and_white_balance_are_locked_as_they_have_settled() -> None:
    camera = FakeCamera()
    keeper = keeper_of(camera, lock_light=True, calibrated={FOCUS: 30})
    camera.was_set.clear()
    camera.controls |= {EXPOSURE: 180, WHITE: 3600}
    keeper.poll(100.0 + SETTLES_S - 0.1)
    assert camera.was_set == []
    keeper.poll(100.0 + SETTLES_S)
    assert camera.was_set == [(AUTO_EXPOSURE, 1), (EXPOSURE, 180), (AUTO_WHITE, 0), (WHITE, 3600)]
    assert keeper.values[AUTO_EXPOSURE] == 1
    camera.was_set.clear()
    camera.controls[AUTO_EXPOSURE] = 3
    keeper.poll(200.0)
    assert camera.was_set == [], "once"


def test_exposure_stays_automatic_unless_asked_otherwise() -> None:
    camera = FakeCamera()
    keeper = keeper_of(camera)
    keeper.poll(200.0)
    assert camera.controls[AUTO_EXPOSURE] == 3


def test_a_camera_without_controls_has_none() -> None:
    keeper = keeper_of(FakeCamera(controls={}), calibrated={FOCUS: 45})
    keeper.poll(200.0)
    assert keeper.values == {}


def test_a_control_that_cannot_be_set_is_reported_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    camera = FakeCamera()

    def rejected(*_requested: object) -> None:
        raise OSError(errno.EACCES, "Permission denied")

    monkeypatch.setattr(camera, "set_control", rejected)
    with capture_logs() as logs:
        keeper = keeper_of(camera)
        keeper.poll(BEGIN_S + SETTLES_S)
    assert [(line["code"], line["control"], line["reason"]) for line in logs] == [
        ("CAMERA_CONTROL_REJECTED", "autofocus", "permission denied"),
        ("CAMERA_CONTROL_REJECTED", "focus", "permission denied"),
    ]
    assert keeper.values == WEBCAM_CONTROLS


def test_of_a_camera_that_is_gone_the_last_values_stay(monkeypatch: pytest.MonkeyPatch) -> None:
    camera = FakeCamera()
    keeper = keeper_of(camera)
    before = keeper.values

    def gone(_control: CameraControl) -> None:
        raise OSError(errno.ENODEV, "No such device")

    monkeypatch.setattr(camera, "control", gone)
    keeper.poll(200.0)
    assert keeper.values == before
