"""The wire message of the source of images."""

import pytest

from server.live import CameraMode, CameraStatus, ImageClock, Problem, SourceState, SourceStatus
from server.stream.messages import LiveProblemMessage, source_message
from tracker.camera import CameraControl, LampFlicker

GRANTED = CameraMode(fourcc="YUYV", size_wh_px=(640, 480), rate_hz=15.0)


def test_a_camera_reports_its_clock_granted_mode_and_controls() -> None:
    camera = CameraStatus(
        clock=ImageClock.DRIVER, granted=GRANTED, controls={CameraControl.FOCUS: 30, CameraControl.GAIN: 7}
    )
    message = source_message(SourceStatus(name="camera 0", state=SourceState.RUNNING, camera=camera))
    assert message.model_dump(mode="json")["camera"] == {
        "clock": "driver",
        "requested": None,
        "granted": {"fourcc": "YUYV", "width_px": 640, "height_px": 480, "rate_hz": 15.0},
        "controls": {"focus": 30, "gain": 7},
        "note": None,
    }


@pytest.mark.parametrize(
    ("automatic", "exposure"),
    # The unit of the driver is a tenth of a millisecond. What automatic exposure sets it does not always say.
    [(1, ", exposure 7.0 ms"), (3, "")],
)
def test_lamps_that_flicker_are_reported_as_a_note_with_the_exposure(automatic: int, exposure: str) -> None:
    camera = CameraStatus(
        clock=ImageClock.DRIVER,
        granted=GRANTED,
        controls={CameraControl.AUTO_EXPOSURE: automatic, CameraControl.EXPOSURE: 70},
        flicker=LampFlicker(mains_hz=(50,), depth_ratio=0.03),
    )
    message = source_message(SourceStatus(name="camera 0", state=SourceState.RUNNING, camera=camera))
    assert message.problem is None
    assert message.camera is not None
    assert message.camera.note is not None
    assert message.camera.note.message.en == f"Lamps flicker by 3.0 % in the image (50 Hz mains){exposure}."
    assert "10.0 or 20.0 ms" in message.camera.note.remedy.en


def test_a_stream_that_predicts_its_images_is_noted_with_what_that_costs() -> None:
    camera = CameraStatus(clock=ImageClock.SENDER, is_predicted=True)
    message = source_message(SourceStatus(name="rtsp://x", state=SourceState.RUNNING, camera=camera))
    assert message.problem is None
    assert message.camera is not None
    assert message.camera.note is not None
    assert message.camera.note.code == "VIDEO_PREDICTED"
    assert "1.7 times" in message.camera.note.message.en
    assert "1,7-mal" in message.camera.note.message.de or "1.7-mal" in message.camera.note.message.de


def _sent(code: str, spread_mm: float) -> LiveProblemMessage:
    problem = Problem(
        code=code,
        message=f"the tip moved: it spreads by {spread_mm:.2f} mm (standard deviation, allowed 0.3) "
        "and by 1.20 mm at most (allowed 1)",
        remedy="Rest the hand, hold the tip still on the landmark, and touch it again.",
        context={"spread_mm": spread_mm, "max_off_mm": 1.2, "allowed_mm": 0.3, "allowed_off_mm": 1.0},
    )
    status = SourceStatus(name="camera 0", state=SourceState.RECONNECTING, problem=problem)
    message = source_message(status).problem
    assert message is not None
    return message


def test_a_problem_states_whether_it_is_translated() -> None:
    translated, other = _sent("CAPTURE_MOVED", 0.52), _sent("NOT_IN_THE_CATALOGUE", 0.52)
    assert translated.is_translated
    assert translated.message.de != translated.message.en
    assert not other.is_translated
    assert other.message.de == other.message.en


def test_a_problem_that_persists_is_translated_once_and_another_anew() -> None:
    assert _sent("CAPTURE_MOVED", 0.52) is _sent("CAPTURE_MOVED", 0.52)
    other = _sent("CAPTURE_MOVED", 0.61)
    assert "0,61" in other.message.de
    assert other.context["spread_mm"] == 0.61


def test_a_file_has_no_camera() -> None:
    message = source_message(SourceStatus(name="film.mp4", state=SourceState.RUNNING))
    assert message.camera is None
