"""An industrial camera as a source: mode, clock, trigger, and errors."""

import threading
from dataclasses import replace

import pytest
from structlog.testing import capture_logs

from server.capture.address import source_from_text
from server.capture.controls import SETTLES_S
from server.capture.driver_clock import GIVEN_UP_AFTER
from server.capture.industrial import IndustrialCameraSource
from server.capture.industrial.source import MAX_TORN
from server.capture.local_camera import CalibratedCamera
from server.capture.modes import WantedMode
from server.capture.shot import Shot
from server.errors import CaptureError
from server.live import CameraMode, ImageClock
from tests.server.capture.fake_industrial import (
    SENSOR_WH_PX,
    SERIAL,
    FakeIndustrialCamera,
    FakeIndustrialCameras,
)
from tracker.camera import CameraControl

PERIOD_S = 1 / 30
SMALL = WantedMode(size_wh_px=(64, 48))


@pytest.fixture
def camera() -> FakeIndustrialCamera:
    return FakeIndustrialCamera()


def source_of(
    camera: FakeIndustrialCamera,
    *,
    wanted: WantedMode | None = None,
    calibration: CalibratedCamera | None = None,
    trigger: str | None = None,
    lock_controls: bool = True,
    stop: threading.Event | None = None,
) -> IndustrialCameraSource:
    return IndustrialCameraSource(
        source_from_text(f"basler:{SERIAL}"),
        cameras=FakeIndustrialCameras(sn4711=camera),
        stop=stop or threading.Event(),
        wanted=wanted,
        calibration=calibration,
        trigger=trigger,
        lock_controls=lock_controls,
        clock=camera.clock,
    )


def opened(source: IndustrialCameraSource) -> IndustrialCameraSource:
    source.open()
    return source


def read(source: IndustrialCameraSource, camera: FakeIndustrialCamera) -> Shot:
    camera.now_s += PERIOD_S
    shot = source.read()
    assert shot is not None
    return shot


def code_of(source: IndustrialCameraSource) -> str:
    """Code of the error with which opening or reading ends."""
    with pytest.raises(CaptureError) as caught:
        opened(source).read()
    assert caught.value.remedy
    return caught.value.code


def test_the_whole_sensor_is_requested_in_raw_colour_at_thirty_hertz(camera: FakeIndustrialCamera) -> None:
    source = opened(source_of(camera))
    mode = CameraMode(fourcc="BayerRG8", size_wh_px=SENSOR_WH_PX, rate_hz=30.0)
    assert source.camera.requested == source.camera.granted == mode
    assert read(source, camera).image.shape == (1216, 1936, 3)
    assert source.defect is None


def test_a_smaller_image_is_cut_from_the_middle_of_the_sensor(camera: FakeIndustrialCamera) -> None:
    source = opened(source_of(camera, calibration=CalibratedCamera(size_wh_px=(1280, 720))))
    assert source.camera.granted is not None
    assert source.camera.granted.size_wh_px == (1280, 720)
    # (1936 - 1280) / 2 and (1216 - 720) / 2, both multiples of 8.
    assert (camera.features["OffsetX"], camera.features["OffsetY"]) == (328, 248)


def test_what_is_not_offered_is_reported_and_the_nearest_taken(camera: FakeIndustrialCamera) -> None:
    source = opened(source_of(camera, wanted=WantedMode(size_wh_px=(4000, 1003), rate_hz=500.0)))
    assert source.camera.requested == CameraMode(fourcc="BayerRG8", size_wh_px=(1936, 1000), rate_hz=160.0)
    assert source.defect is not None
    assert source.defect.code == "CAMERA_MODE_NOT_OFFERED"


def test_a_rate_that_the_connection_does_not_carry_is_read_back_and_reported(
    camera: FakeIndustrialCamera,
) -> None:
    camera.max_rate_hz = 12.0
    source = opened(source_of(camera))
    assert source.camera.granted is not None
    assert source.camera.granted.rate_hz == 12.0
    assert source.defect is not None
    assert source.defect.code == "CAMERA_MODE_NOT_GRANTED"


def test_a_rejected_pixel_format_is_reported(camera: FakeIndustrialCamera) -> None:
    camera.rejected = {"PixelFormat"}
    source = opened(source_of(camera))
    assert source.defect is not None
    assert source.defect.code == "CAMERA_MODE_NOT_GRANTED"
    assert "Mono8" in source.defect.message


def test_a_camera_whose_formats_cannot_be_read_is_not_opened(camera: FakeIndustrialCamera) -> None:
    camera.pixel_formats = ("BayerRG12", "Coord3D_C16")
    assert code_of(source_of(camera)) == "CAMERA_NOT_OPENED"


def test_by_its_own_clock_images_are_stamped_without_the_jitter_of_the_way(
    camera: FakeIndustrialCamera,
) -> None:
    source = opened(source_of(camera))
    for latency_s in (0.02, 0.03, 0.05, 0.02, 0.04):
        camera.latency_s = latency_s
        shot = read(source, camera)
        # The smallest delay remains, since nothing reveals it.
        assert shot.captured_at_s == pytest.approx(camera.now_s - latency_s + 0.02)
    assert source.camera.clock is ImageClock.DEVICE


def test_where_its_clock_can_be_read_no_delay_stays(camera: FakeIndustrialCamera) -> None:
    camera.latch_takes_s = 0.0008
    source = opened(source_of(camera, wanted=SMALL))
    for _ in range(700):
        shot = read(source, camera)
    assert shot.captured_at_s == pytest.approx(camera.now_s - 0.02, abs=1e-6)
    assert source.camera.clock is ImageClock.DEVICE
    # Reset to zero, as by GenICam's TimestampReset.
    camera.device_zero_s = -camera.now_s
    read(source, camera)
    shot = read(source, camera)
    assert shot.captured_at_s == pytest.approx(camera.now_s - 0.02, abs=1e-6)


def test_a_camera_without_a_clock_is_stamped_at_the_arrival(camera: FakeIndustrialCamera) -> None:
    camera.device_zero_s = None
    source = opened(source_of(camera))
    assert read(source, camera).captured_at_s == camera.now_s
    assert source.camera.clock is ImageClock.ARRIVAL


def test_a_stopped_clock_is_abandoned_with_a_message(camera: FakeIndustrialCamera) -> None:
    source = opened(source_of(camera))
    with capture_logs() as logs:
        for _ in range(GIVEN_UP_AFTER + 2):
            camera.arriving.append(camera.image(device_s=lambda _: 7.0))
            camera.now_s += PERIOD_S
            shot = source.read()
    assert shot is not None
    assert shot.captured_at_s == camera.now_s
    assert source.camera.clock is ImageClock.ARRIVAL
    assert [line["code"] for line in logs if line["log_level"] == "warning"] == ["CAMERA_CLOCK_IMPLAUSIBLE"]


def test_a_trigger_is_set_at_the_start_of_an_image_and_its_rate_is_nobodys(
    camera: FakeIndustrialCamera,
) -> None:
    source = opened(source_of(camera, trigger="line3", wanted=replace(SMALL, rate_hz=100.0)))
    assert camera.calls.index("TriggerMode=On") > camera.calls.index("TriggerSource=Line3")
    assert camera.features["TriggerSelector"] == "FrameStart"
    assert source.camera.trigger == "Line3"
    for _ in range(400):
        read(source, camera)
    assert source.defect is None


def test_a_trigger_that_somebody_left_on_is_switched_off(camera: FakeIndustrialCamera) -> None:
    camera.features["TriggerMode"] = "On"
    source = opened(source_of(camera))
    assert camera.features["TriggerMode"] == "Off"
    assert source.camera.trigger == ""


def test_a_trigger_that_the_camera_does_not_have_is_reported_with_those_it_has(
    camera: FakeIndustrialCamera,
) -> None:
    with pytest.raises(CaptureError) as caught:
        source_of(camera, trigger="line7").open()
    assert caught.value.code == "CAMERA_TRIGGER_NOT_OFFERED"
    assert "Line1, Line3, Software" in caught.value.remedy


def test_without_a_pulse_a_triggered_camera_is_waited_for_and_a_free_one_opened_again(
    camera: FakeIndustrialCamera,
) -> None:
    camera.arriving.extend([None] * 100)
    assert code_of(source_of(camera)) == "CAMERA_STOPPED"
    camera.arriving.clear()
    camera.arriving.extend([None] * 100)
    shot = opened(source_of(camera, trigger="line1")).read()
    assert shot is not None
    assert not camera.arriving


def test_one_that_waits_for_a_pulse_ends_on_request(camera: FakeIndustrialCamera) -> None:
    stop = threading.Event()
    source = opened(source_of(camera, trigger="line1", stop=stop))
    stop.set()
    assert source.read() is None


def test_exposure_gain_and_white_balance_are_locked_once_they_have_settled(
    camera: FakeIndustrialCamera,
) -> None:
    source = opened(source_of(camera))
    read(source, camera)
    assert camera.features["ExposureAuto"] == "Continuous"
    camera.now_s += SETTLES_S
    camera.features["ExposureTime"] = 12_000.0
    read(source, camera)
    locked = [camera.features[name] for name in ("ExposureAuto", "GainAuto", "BalanceWhiteAuto")]
    assert locked == ["Off"] * 3
    assert camera.features["ExposureTime"] == 12_000.0
    controls = source.camera.controls
    assert controls[CameraControl.EXPOSURE] == 12_000
    assert source.camera.exposure_ms == pytest.approx(12.0)
    assert controls[CameraControl.GAIN] == 325
    # Later changes by a user are detected.
    camera.features["Gain"] = 6.0
    camera.now_s += 2.0
    read(source, camera)
    assert source.camera.controls[CameraControl.GAIN] == 600


def test_an_automatic_gain_is_locked_where_the_exposure_is_fixed_already(
    camera: FakeIndustrialCamera,
) -> None:
    camera.features["ExposureAuto"] = "Off"
    source = opened(source_of(camera))
    camera.now_s += SETTLES_S
    read(source, camera)
    assert camera.features["GainAuto"] == "Off"


def test_locked_controls_can_be_left_alone(camera: FakeIndustrialCamera) -> None:
    source = opened(source_of(camera, lock_controls=False))
    camera.now_s += 2 * SETTLES_S
    read(source, camera)
    assert camera.features["ExposureAuto"] == "Continuous"


def test_binning_and_the_place_of_the_cut_out_are_what_they_were_at_the_calibration(
    camera: FakeIndustrialCamera,
) -> None:
    controls = {CameraControl.ZOOM: 2, CameraControl.PAN: 96, CameraControl.TILT: 64}
    calibration = CalibratedCamera(size_wh_px=(800, 600), controls=controls)
    source = opened(source_of(camera, calibration=calibration))
    assert {name: source.camera.controls[name] for name in controls} == controls
    assert camera.calls.index("BinningHorizontal=2") < camera.calls.index("Width=800")
    # A calibration that is adopted later reopens the camera with its own mode.
    source.adopt(replace(calibration, controls={CameraControl.PAN: 160}))
    read(source, camera)
    assert source.camera.controls[CameraControl.PAN] == 160


def test_images_that_the_library_threw_away_are_counted(camera: FakeIndustrialCamera) -> None:
    source = opened(source_of(camera))
    first = read(source, camera)
    camera.arriving.append(replace(camera.image(), skipped=7))
    assert read(source, camera).number == first.number + 8


def test_images_of_which_parts_are_missing_are_left_out_and_when_all_are_it_is_reported(
    camera: FakeIndustrialCamera,
) -> None:
    source = opened(source_of(camera))
    camera.arriving.append(replace(camera.image(), pixels=None))
    assert read(source, camera).number == 1
    camera.arriving.extend([replace(camera.image(), pixels=None)] * (MAX_TORN + 1))
    assert code_of(source) == "CAMERA_TORN"


def test_a_camera_that_is_pulled_out_is_reported_and_opened_again(camera: FakeIndustrialCamera) -> None:
    source = opened(source_of(camera))
    camera.arriving.append(OSError("the camera was removed"))
    with pytest.raises(CaptureError) as caught:
        source.read()
    assert caught.value.code == "CAMERA_STOPPED"
    assert "removed" in caught.value.message
    assert read(opened(source), camera).number == 0


@pytest.mark.parametrize(
    ("cameras", "reason"),
    [
        pytest.param({}, "no camera is connected", id="none"),
        pytest.param(
            {"sn1": FakeIndustrialCamera(), "sn2": FakeIndustrialCamera()}, "basler:1, basler:2", id="two"
        ),
    ],
)
def test_without_a_serial_number_there_must_be_one_camera(
    cameras: dict[str, FakeIndustrialCamera], reason: str
) -> None:
    source = IndustrialCameraSource(
        source_from_text("basler:"), cameras=FakeIndustrialCameras(**cameras), stop=threading.Event()
    )
    with pytest.raises(CaptureError) as caught:
        source.open()
    assert caught.value.code == "CAMERA_NOT_OPENED"
    assert reason in caught.value.message


def test_a_library_that_is_missing_is_reported_with_how_to_get_it() -> None:
    cameras = FakeIndustrialCameras()
    cameras.is_installed = False
    source = IndustrialCameraSource(source_from_text("basler:4711"), cameras=cameras, stop=threading.Event())
    with pytest.raises(CaptureError) as caught:
        source.open()
    assert caught.value.code == "CAMERA_LIBRARY_MISSING"
    assert "coaxial[basler]" in caught.value.remedy


@pytest.mark.parametrize("text", ["basler:4711", "basler:"])
def test_the_status_names_the_camera_by_its_serial_number(camera: FakeIndustrialCamera, text: str) -> None:
    source = IndustrialCameraSource(
        source_from_text(text),
        cameras=FakeIndustrialCameras(sn4711=camera),
        stop=threading.Event(),
        clock=camera.clock,
    )
    assert opened(source).camera.device == SERIAL
