"""A local camera as a source: requested mode, and clock of its images."""

import itertools

import numpy as np
import pytest
from structlog.testing import capture_logs

from server.capture.address import source_from_text
from server.capture.local_camera import CalibratedCamera, LocalCameraSource
from server.capture.modes import WantedMode
from server.capture.shot import Shot
from server.capture.v4l2 import NoDevices, VideoDevices
from server.errors import CaptureError
from server.live import CameraMode, ImageClock
from tests.server.capture.damaged_jpegs import JPEG, WITH_GAP
from tests.server.capture.fake_camera import FULL_HD, HD, VGA, FakeCamera, FakeDevices, FakeVideo
from tracker.camera import CameraControl

MJPG_FULL_HD = CameraMode(fourcc="MJPG", size_wh_px=FULL_HD, rate_hz=30.0)


def source_of(
    video: FakeVideo,
    *,
    wanted: WantedMode | None = None,
    calibration: CalibratedCamera | None = None,
    devices: VideoDevices | None = None,
    text: str = "0",
) -> LocalCameraSource:
    return LocalCameraSource(
        source_from_text(text),
        wanted=wanted,
        calibration=calibration,
        devices=devices or FakeDevices(video.camera),
        open_video=video,
        clock=video.clock,
    )


def read(source: LocalCameraSource, video: FakeVideo, *, after_s: float = 1 / 30) -> Shot:
    video.now_s += after_s
    shot = source.read()
    assert shot is not None
    return shot


@pytest.fixture
def video() -> FakeVideo:
    return FakeVideo(FakeCamera())


@pytest.mark.parametrize("text", ["0", "/dev/video0"])
def test_full_hd_over_usb_2_is_requested_as_mjpg(video: FakeVideo, text: str) -> None:
    source = source_of(video, text=text)
    source.open()
    assert video.requested == MJPG_FULL_HD
    assert read(source, video).image.shape == (1080, 1920, 3)
    assert source.camera.requested == source.camera.granted == MJPG_FULL_HD
    assert source.defect is None


def test_the_size_of_the_calibration_comes_before_the_largest(video: FakeVideo) -> None:
    source_of(video, calibration=CalibratedCamera(size_wh_px=HD)).open()
    assert video.requested.size_wh_px == HD


def test_what_the_settings_ask_is_asked_and_what_is_not_offered_is_reported(video: FakeVideo) -> None:
    source_of(video, wanted=WantedMode(size_wh_px=HD, rate_hz=60)).open()
    assert (video.requested.size_wh_px, video.requested.rate_hz) == (HD, 60)
    source = source_of(video, wanted=WantedMode(size_wh_px=(1600, 1200)))
    source.open()
    assert video.requested.size_wh_px == FULL_HD
    assert source.defect is not None
    assert source.defect.code == "CAMERA_MODE_NOT_OFFERED"


def test_what_the_driver_grants_is_read_back(video: FakeVideo) -> None:
    video.grants = CameraMode(fourcc="YUYV", size_wh_px=FULL_HD, rate_hz=5.0)
    source = source_of(video)
    source.open()
    assert source.camera.granted == video.grants
    assert source.defect is not None
    assert source.defect.code == "CAMERA_MODE_NOT_GRANTED"


def test_a_camera_that_is_slower_than_granted_is_reported(video: FakeVideo) -> None:
    source = source_of(video)
    source.open()
    for _ in range(150):
        read(source, video, after_s=1 / 15)
    assert source.defect is not None
    assert source.defect.code == "CAMERA_RATE_DIFFERS"
    assert "15.0 Hz" in source.defect.message


def test_without_v4l2_what_the_settings_say_is_asked_and_opencv_tells_what_was_granted(
    video: FakeVideo,
) -> None:
    video.camera.granted = CameraMode(fourcc="YUYV", size_wh_px=VGA, rate_hz=30.0)
    source = source_of(video, devices=NoDevices())
    source.open()
    assert video.camera.granted.size_wh_px == VGA
    assert source.camera.requested is None
    assert source.camera.granted == video.camera.granted
    wanted = source_of(video, devices=NoDevices(), wanted=WantedMode(size_wh_px=HD, rate_hz=15))
    wanted.open()
    assert (video.requested.size_wh_px, video.requested.rate_hz) == (HD, 15)
    assert wanted.defect is None


def test_an_image_has_the_age_stated_by_its_driver(video: FakeVideo) -> None:
    source = source_of(video)
    source.open()
    shot = read(source, video)
    assert shot.captured_at_s == pytest.approx(video.now_s - video.latency_s)
    assert shot.source_time_s == shot.captured_at_s
    assert source.camera.clock is ImageClock.DRIVER


def test_without_v4l2_an_image_counts_from_its_arrival(video: FakeVideo) -> None:
    source = source_of(video, devices=NoDevices())
    source.open()
    assert read(source, video).captured_at_s == video.now_s
    assert source.camera.clock is ImageClock.ARRIVAL


def test_a_driver_whose_clock_is_wrong_is_reported_once_and_not_believed_any_more(video: FakeVideo) -> None:
    video.stamp = lambda taken_s: 1.7e9 + taken_s
    source = source_of(video)
    source.open()
    with capture_logs() as logs:
        for _ in range(40):
            assert read(source, video).captured_at_s == video.now_s
        # Not even when it becomes plausible, nor after the device was reopened.
        video.stamp = lambda taken_s: taken_s
        source.open()
        for _ in range(40):
            assert read(source, video).captured_at_s == video.now_s
    assert source.camera.clock is ImageClock.ARRIVAL
    warned = [line for line in logs if line["log_level"] == "warning"]
    assert [line["code"] for line in warned] == ["CAMERA_CLOCK_IMPLAUSIBLE"]


def test_numbers_go_on_when_the_camera_is_opened_again(video: FakeVideo) -> None:
    source = source_of(video)
    source.open()
    assert [read(source, video).number for _ in range(2)] == [0, 1]
    source.open()
    assert video.calls.count("release") == 1
    assert read(source, video).number == 2


def test_a_device_that_cannot_be_opened_is_reported(video: FakeVideo) -> None:
    video.is_open = False
    with pytest.raises(CaptureError) as caught:
        source_of(video).open()
    assert caught.value.code == "CAMERA_NOT_OPENED"


def test_the_controls_are_in_the_status_and_are_read_again(video: FakeVideo) -> None:
    source = source_of(video)
    source.open()
    assert source.camera.device == "Webcam"
    assert source.camera.controls[CameraControl.AUTOFOCUS] == 1
    read(source, video, after_s=4.0)
    assert source.camera.controls[CameraControl.AUTOFOCUS] == 0
    video.camera.controls[CameraControl.FOCUS] = 99
    read(source, video, after_s=1.1)
    assert source.camera.controls[CameraControl.FOCUS] == 99


def test_a_calibration_that_is_adopted_sets_the_focus_and_the_size(video: FakeVideo) -> None:
    source = source_of(video)
    source.open()
    read(source, video)
    source.adopt(CalibratedCamera(size_wh_px=FULL_HD, controls={CameraControl.FOCUS: 45}))
    assert read(source, video).image.shape == (1080, 1920, 3)
    assert video.camera.controls[CameraControl.FOCUS] == 45
    assert video.calls == ["open 0"], "it is of the same size"
    source.adopt(CalibratedCamera(size_wh_px=HD, controls={CameraControl.FOCUS: 50}))
    assert read(source, video).image.shape == (720, 1280, 3)
    assert source.camera.controls[CameraControl.FOCUS] == 50
    # When adopted again, nothing is set: a user's change remains.
    video.camera.controls[CameraControl.FOCUS] = 60
    source.adopt(CalibratedCamera(size_wh_px=HD, controls={CameraControl.FOCUS: 50}))
    read(source, video, after_s=1.1)
    assert source.camera.controls[CameraControl.FOCUS] == 60


def test_a_size_that_the_settings_name_stays_whatever_is_adopted(video: FakeVideo) -> None:
    source = source_of(video, wanted=WantedMode(size_wh_px=VGA))
    source.open()
    source.adopt(CalibratedCamera(size_wh_px=HD))
    assert read(source, video).image.shape == (480, 640, 3)
    assert video.calls == ["open 0"]


def test_damaged_images_are_skipped_and_counted_and_the_camera_stays_open(video: FakeVideo) -> None:
    video.packets = iter([JPEG, WITH_GAP, JPEG[:-900], b"", JPEG])
    video.period_s = 1 / 30
    source = source_of(video, devices=NoDevices(), wanted=WantedMode(size_wh_px=VGA))
    video.camera.granted = video.grants = CameraMode(fourcc="MJPG", size_wh_px=VGA, rate_hz=30.0)
    source.open()
    shots = [read(source, video, after_s=0.0) for _ in range(2)]
    assert [shot.number for shot in shots] == [0, 4]
    assert shots[1].captured_at_s == video.now_s
    np.testing.assert_array_equal(shots[0].image, shots[1].image)
    assert source.defect is not None
    assert source.defect.code == "IMAGES_DAMAGED"
    assert "1 of 2 images of camera 0 within 0.0 s (Corrupt JPEG data" in source.defect.message
    assert video.calls == ["open 0"]


def test_a_camera_of_damaged_images_only_is_reported_and_can_be_reopened(video: FakeVideo) -> None:
    video.packets = itertools.chain([JPEG], itertools.repeat(JPEG[:700], 46), itertools.repeat(JPEG))
    video.period_s = 1 / 30
    video.camera.granted = video.grants = CameraMode(fourcc="MJPG", size_wh_px=VGA, rate_hz=30.0)
    source = source_of(video, devices=NoDevices())
    source.open()
    read(source, video)
    with pytest.raises(CaptureError) as caught:
        source.read()
    assert caught.value.code == "IMAGES_DAMAGED"
    assert "46 of 46 images of camera 0 within 1.5 s" in caught.value.message
    source.open()
    assert source.defect is None
    assert read(source, video).number == 47


def test_a_camera_whose_jpegs_are_all_invalid_is_reopened_without_compression_in_the_same_size(
    video: FakeVideo,
) -> None:
    video.packets = itertools.repeat(WITH_GAP)
    video.period_s = 1 / 30
    source = source_of(video, wanted=WantedMode(size_wh_px=HD))
    source.open()
    assert (video.requested.fourcc, video.requested.size_wh_px) == ("MJPG", HD)
    with pytest.raises(CaptureError, match="damaged"):
        source.read()
    source.close()
    video.packets = None
    source.open()
    assert (video.requested.fourcc, video.requested.size_wh_px, video.requested.rate_hz) == ("YUYV", HD, 10)
    assert read(source, video).image.shape[:2] == HD[::-1]
    # Damage after intact images comes from the connection, which more data would not make better.
    video.packets = itertools.chain([JPEG], itertools.repeat(WITH_GAP))
    other = source_of(video, wanted=WantedMode(size_wh_px=HD))
    other.open()
    read(other, video)
    with pytest.raises(CaptureError, match="damaged"):
        other.read()
    other.open()
    assert video.requested.fourcc == "MJPG"
