"""Basler's library with its emulated cameras, which have no timestamps."""

import threading
import time
from collections.abc import Callable, Iterator

import pytest

from server.capture.address import source_from_text
from server.capture.capture import STALLED_AFTER_S, Capture
from server.capture.industrial import BaslerCameras, IndustrialCameraSource
from server.capture.industrial.basler import BaslerCamera
from server.capture.modes import WantedMode
from server.live import CameraMode, ImageClock, Problem, SourceState

pylon = pytest.importorskip(
    "pypylon.pylon", reason="needs pypylon, which the development lock has for Linux", exc_type=ImportError
)
# While waiting for an image, pylon uses a timer that sends SIGALRM, which must not end the test.
pytestmark = pytest.mark.timeout(300, method="thread")
DEADLINE_S = 30.0
SERIAL = "0815-0000"
WANTED = WantedMode(size_wh_px=(320, 240), rate_hz=100.0)


class SpyCameras(BaslerCameras):
    """Gives the test the camera that the source has opened."""

    def open(self, serial: str) -> BaslerCamera:
        self.newest = super().open(serial)
        return self.newest


class Emulated:
    """A source of the emulated camera, captured."""

    def __init__(self, trigger: str | None) -> None:
        self.cameras = SpyCameras()
        self.stop = threading.Event()
        self.is_captured = False
        self.source = IndustrialCameraSource(
            source_from_text(f"basler:{SERIAL}"),
            cameras=self.cameras,
            stop=self.stop,
            wanted=WANTED,
            trigger=trigger,
        )
        self.capture = Capture(self.source, stop=self.stop)

    def start(self) -> None:
        self.capture.start()
        self.is_captured = True

    def end(self) -> None:
        self.stop.set()
        if self.is_captured:
            self.capture.close(5.0)
        else:
            self.source.close()

    def until(self, is_so: Callable[[], bool]) -> None:
        deadline_s = time.monotonic() + DEADLINE_S
        while not is_so():
            assert time.monotonic() < deadline_s
            self.capture.take(0.05)


@pytest.fixture
def emulated(monkeypatch: pytest.MonkeyPatch) -> Iterator[Callable[..., Emulated]]:
    monkeypatch.setenv("PYLON_CAMEMU", "1")
    made: list[Emulated] = []

    def make(trigger: str | None = None) -> Emulated:
        made.append(Emulated(trigger))
        return made[-1]

    yield make
    for one in made:
        one.end()


def test_images_come_as_they_were_requested(emulated: Callable[..., Emulated]) -> None:
    one = emulated()
    one.start()
    shot = one.capture.take(30.0)
    assert shot is not None
    assert shot.image.shape == (240, 320, 3)
    status = one.capture.status()
    assert status.camera is not None
    mode = CameraMode(fourcc="BayerRG8", size_wh_px=(320, 240), rate_hz=100.0)
    assert status.camera.requested == status.camera.granted == mode
    assert status.camera.clock is ImageClock.ARRIVAL
    assert status.problem is None


def test_the_newest_image_comes_and_never_a_backlog(emulated: Callable[..., Emulated]) -> None:
    one = emulated()
    one.source.open()
    first = one.source.read()
    sent = one.cameras.newest._camera.StreamGrabber.Statistic_Total_Buffer_Count
    enough = sent.GetValue() + 20
    deadline_s = time.monotonic() + DEADLINE_S
    while sent.GetValue() < enough:
        assert time.monotonic() < deadline_s
    second, third = one.source.read(), one.source.read()
    assert first is not None
    assert second is not None
    assert third is not None
    assert second.number >= first.number + 15
    assert third.number <= second.number + 3
    assert third.captured_at_s > second.captured_at_s


def test_a_camera_that_waits_for_its_trigger_reports_it_until_the_pulse(
    emulated: Callable[..., Emulated], monkeypatch: pytest.MonkeyPatch
) -> None:
    one = emulated("software")
    one.start()
    one.until(lambda: one.source.camera.trigger == "Software")
    one.until(one.cameras.newest._camera.IsGrabbing)

    def problem_later() -> Problem | None:
        later_s = time.monotonic() + STALLED_AFTER_S + 60.0
        with monkeypatch.context() as patch:
            patch.setattr("server.capture.capture.time.monotonic", lambda: later_s)
            return one.capture.status().problem

    one.until(lambda: problem_later() is not None)
    problem = problem_later()
    assert problem is not None
    assert problem.code == "CAMERA_NOT_TRIGGERED"
    assert "waits for a pulse on Software" in problem.message

    def is_running_after_a_pulse() -> bool:
        # The camera drops a pulse that arrives before it is ready.
        one.cameras.newest.execute("TriggerSoftware")
        return one.capture.status().state is SourceState.RUNNING

    one.until(is_running_after_a_pulse)
    assert one.capture.status().problem is None


def test_a_camera_that_is_pulled_out_is_reported_and_taken_again_when_it_is_back(
    emulated: Callable[..., Emulated], monkeypatch: pytest.MonkeyPatch
) -> None:
    one = emulated()
    one.start()
    one.until(lambda: one.capture.status().state is SourceState.RUNNING)
    monkeypatch.setenv("PYLON_CAMEMU", "0")
    one.cameras.newest._camera.DestroyDevice()
    one.until(lambda: one.capture.status().state is SourceState.RECONNECTING)
    problem = one.capture.status().problem
    assert problem is not None
    assert problem.code in {"CAMERA_STOPPED", "CAMERA_NOT_OPENED"}
    before = one.capture.status().images
    monkeypatch.setenv("PYLON_CAMEMU", "1")
    one.until(lambda: one.capture.status().state is SourceState.RUNNING)
    assert one.capture.status().images > before
    assert one.capture.status().problem is None


def test_a_camera_that_is_not_there_is_reported(emulated: Callable[..., Emulated]) -> None:
    assert emulated().source.name == "basler:0815-0000"
    with pytest.raises(OSError, match="No device"):
        BaslerCameras().open("4711")
