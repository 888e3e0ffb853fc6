"""A phone as a source: its images, and its errors without images."""

import threading
from dataclasses import replace

import pytest

from server.capture.address import SourceKind, source_from_text
from server.capture.phone import Focus, PhoneSource, PhoneUpdate, broken_image
from server.capture.source_factory import source_from_config
from server.config import CameraConfig, Config
from server.errors import CaptureError
from server.live import ImageClock
from tests.server.capture.fake_phone import CAMERA, Script, image
from tracker.camera import CameraControl

HERE = PhoneUpdate(sender="phone")
GONE = PhoneUpdate(sender="")


def sent(number: int, captured_at_s: float = 1.0, **changes: object) -> PhoneUpdate:
    return PhoneUpdate(sender="phone", image=image(number, captured_at_s, **changes))


def opened(script: Script, stop: threading.Event | None = None, first_number: int = 0) -> PhoneSource:
    source = PhoneSource(
        script, stop=stop or threading.Event(), first_number=first_number, clock=script.clock
    )
    source.open()
    return source


def test_the_settings_name_it_phone() -> None:
    assert source_from_text("Phone").kind is SourceKind.PHONE
    config = Config(camera=CameraConfig(source="phone"))
    source = source_from_config(config, stop=threading.Event(), inbox=Script(HERE, []))
    assert (source.name, source.stalls, source.waits_for_consumer) == ("phone", True, False)


def test_without_a_server_no_phone_can_send() -> None:
    with pytest.raises(CaptureError) as reported:
        source_from_config(Config(camera=CameraConfig(source="phone")), stop=threading.Event())
    assert reported.value.code == "PHONE_WITHOUT_SERVER"


def test_an_image_comes_with_the_time_of_its_capture_and_the_browsers_word_on_its_camera() -> None:
    source = opened(Script(HERE, [sent(7, 12.5)]))
    shot = source.read()
    assert shot is not None
    assert shot.image.shape == (90, 160, 3)
    assert (shot.number, shot.captured_at_s, int(shot.image[0, 0, 0])) == (0, 12.5, 7)
    status = source.camera
    assert status.clock is ImageClock.BROWSER
    assert str(status.granted) == "160x90 MJPG at 30 Hz"
    assert status.device == "back"
    assert status.controls == {CameraControl.FOCUS: 400, CameraControl.ZOOM: 100, CameraControl.AUTOFOCUS: 0}


def test_images_that_were_replaced_before_they_were_read_are_counted() -> None:
    source = opened(Script(HERE, [sent(3), sent(7)]), first_number=100)
    assert [shot.number for shot in (source.read(), source.read()) if shot] == [100, 104]


def test_an_image_from_before_the_source_was_opened_is_not_read() -> None:
    source = opened(Script(sent(3, 1.0), [sent(5, 2.0)]))
    shot = source.read()
    # One in between was skipped; an image from before is not delivered by this source.
    assert shot is not None
    assert (shot.captured_at_s, shot.number) == (2.0, 1)


def test_a_source_without_a_sender_states_how_to_begin() -> None:
    for script in (Script(None, []), Script(GONE, []), Script(None, [GONE])):
        with pytest.raises(CaptureError) as reported:
            opened(script)
        assert reported.value.code == "PHONE_ABSENT"
        assert "/camera" in reported.value.remedy


@pytest.mark.parametrize(
    ("entries", "code"),
    [
        pytest.param([GONE], "PHONE_GONE", id="its-page-is-closed"),
        pytest.param([], "PHONE_SILENT", id="nothing-comes"),
        pytest.param([HERE, None, HERE], "PHONE_SILENT", id="it-is-there-and-sends-nothing"),
        pytest.param(
            [PhoneUpdate(sender="phone", problem=broken_image()), None],
            "PHONE_IMAGE_BROKEN",
            id="what-it-sends-cannot-be-used",
        ),
        pytest.param(
            [sent(0, jpeg=b"\xff\xd8no image\xff\xd9")], "PHONE_IMAGE_BROKEN", id="it-is-not-decoded"
        ),
    ],
)
def test_a_phone_that_gives_no_image_is_reported(entries: list[PhoneUpdate | None], code: str) -> None:
    source = opened(Script(HERE, entries))
    with pytest.raises(CaptureError) as reported:
        source.read()
    assert reported.value.code == code
    assert reported.value.remedy


def test_a_phone_counts_as_silent_earlier_than_a_wired_camera() -> None:
    script = Script(HERE, [])
    source = opened(script)
    with pytest.raises(CaptureError):
        source.read()
    assert script.now_s < 2.0


def test_a_source_that_shall_stop_waits_no_longer() -> None:
    stop = threading.Event()
    stop.set()
    assert opened(Script(HERE, []), stop).read() is None


@pytest.mark.parametrize(
    ("focus", "code"),
    [
        (Focus.LOCKED, None),
        (Focus.AUTOMATIC, "PHONE_FOCUS_NOT_LOCKED"),
        (Focus.UNKNOWN, "PHONE_FOCUS_NOT_LOCKED"),
    ],
)
def test_a_focus_that_may_move_is_reported(focus: Focus, code: str | None) -> None:
    camera = replace(CAMERA, focus=focus)
    source = opened(Script(HERE, [sent(1, camera=camera)]))
    assert source.defect is None
    source.read()
    assert (None if source.defect is None else source.defect.code) == code
    # Unknown values cannot be compared with a calibration, and are not invented.
    known = {Focus.LOCKED: 0, Focus.AUTOMATIC: 1, Focus.UNKNOWN: None}[focus]
    assert source.camera.controls.get(CameraControl.AUTOFOCUS) == known
    # It disconnected, and its values with it.
    source.close()
    assert (source.defect, source.camera.controls) == (None, {})


@pytest.mark.parametrize(
    ("size_wh_px", "rate_hz", "code"),
    [
        pytest.param(None, None, None, id="nothing is asked"),
        pytest.param((160, 90), 30.0, None, id="as asked"),
        pytest.param((90, 160), 30.0, None, id="held upright"),
        pytest.param((1280, 720), None, "CAMERA_MODE_NOT_GRANTED", id="another size"),
        pytest.param(None, 60.0, "CAMERA_MODE_NOT_GRANTED", id="another rate"),
    ],
)
def test_a_mode_that_the_browser_does_not_grant_is_reported_with_both(
    size_wh_px: tuple[int, int] | None, rate_hz: float | None, code: str | None
) -> None:
    width, height = size_wh_px or (None, None)
    config = Config(camera=CameraConfig(source="phone", width=width, height=height, rate_hz=rate_hz))
    source = source_from_config(config, stop=threading.Event(), inbox=Script(HERE, [sent(1)]))
    source.open()
    source.read()
    assert (None if source.defect is None else source.defect.code) == code
    if source.defect is not None:
        assert ("60 Hz" if size_wh_px is None else "1280x720") in source.defect.message
        assert "160x90 at 30 Hz was granted" in source.defect.message
