"""What the wire says of the source of images."""

from server.live import CameraMode, CameraStatus, ImageClock, SourceState, SourceStatus
from server.stream.messages import source_message
from tracker.camera import CameraControl

GRANTED = CameraMode(fourcc="YUYV", size_wh_px=(640, 480), rate_hz=15.0)


def test_a_camera_says_whose_clock_it_is_what_it_granted_and_how_it_is_set() -> None:
    camera = CameraStatus(
        clock=ImageClock.DRIVER, granted=GRANTED, controls={CameraControl.FOCUS: 30, CameraControl.GAIN: 7}
    )
    message = source_message(SourceStatus(name="camera 0", state=SourceState.RUNNING, camera=camera))
    assert message.model_dump(mode="json")["camera"] == {
        "clock": "driver",
        "asked": None,
        "granted": {"fourcc": "YUYV", "width_px": 640, "height_px": 480, "rate_hz": 15.0},
        "controls": {"focus": 30, "gain": 7},
    }


def test_a_file_has_no_camera() -> None:
    message = source_message(SourceStatus(name="film.mp4", state=SourceState.RUNNING))
    assert message.camera is None
