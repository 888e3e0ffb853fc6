"""Newest image, status and log of a source that the test controls."""

import queue
import threading
import time
from collections.abc import Callable
from typing import Any

import cv2
import numpy as np
import numpy.typing as npt
import pytest
from structlog.testing import capture_logs

from server.capture.capture import Capture
from server.capture.shot import Shot
from server.errors import CaptureError
from server.live import CameraStatus, ImageClock, SourceState
from tests.tracker.camera.lamps import lit


def shot(number: int, *, grey: int | None = None, at_s: float | None = None) -> Shot:
    image = np.full((4, 6, 3), number % 256 if grey is None else grey, dtype=np.uint8)
    now_s = time.monotonic() if at_s is None else at_s
    return Shot(image=image, number=number, captured_at_s=now_s, source_time_s=now_s)


class ScriptedSource:
    """Returns what the test provides: a shot, an error to raise, or None for the end."""

    def __init__(self, *, waits_for_consumer: bool = False, stalls: bool = False) -> None:
        self.name = "scripted"
        self.waits_for_consumer = waits_for_consumer
        self.stalls = stalls
        self.defect: CaptureError | None = None
        self.camera: CameraStatus | None = None
        self.reported: queue.Queue[Shot | BaseException | None] = queue.Queue()
        self.opened = 0

    def open(self) -> None:
        self.opened += 1

    def read(self) -> Shot | None:
        given = self.reported.get()
        if isinstance(given, BaseException):
            raise given
        return given

    def close(self) -> None:
        pass


def gone(reason: str = "cable out") -> CaptureError:
    return CaptureError("CAMERA_STOPPED", reason, "Plug it in.")


def until(true: Callable[[], bool]) -> None:
    deadline_s = time.monotonic() + 30.0
    while not true():
        assert time.monotonic() < deadline_s
        threading.Event().wait(0.002)


def test_the_newest_image_wins_and_the_skipped_are_counted() -> None:
    source, stop = ScriptedSource(), threading.Event()
    capture = Capture(source, stop=stop)
    for number in range(5):
        source.reported.put(shot(number))
    capture.start()
    until(lambda: capture.status().images == 5)
    taken = capture.take(1.0)
    assert taken is not None
    assert taken.number == 4
    status = capture.status()
    assert (status.images, status.skipped_images) == (5, 4)
    stop.set()
    source.reported.put(None)
    capture.close()


def test_a_source_that_waits_for_its_taker_skips_nothing() -> None:
    source, stop = ScriptedSource(waits_for_consumer=True), threading.Event()
    capture = Capture(source, stop=stop)
    for number in range(5):
        source.reported.put(shot(number))
    source.reported.put(None)
    capture.start()
    numbers: list[int] = []
    while capture.status().state is not SourceState.ENDED or len(numbers) < 5:
        taken = capture.take(1.0)
        if taken is not None:
            numbers.append(taken.number)
    assert numbers == [0, 1, 2, 3, 4]
    assert capture.status().skipped_images == 0


def test_a_fault_is_reported_once_however_often_it_is_tried_and_it_comes_back() -> None:
    source, stop = ScriptedSource(), threading.Event()
    capture = Capture(source, stop=stop)
    with capture_logs() as logs:
        source.reported.put(shot(0))
        for _ in range(3):
            source.reported.put(gone())
        capture.start()
        until(lambda: source.opened == 4)
        assert capture.status().state is SourceState.RECONNECTING
        problem = capture.status().problem
        assert problem is not None
        assert (problem.code, problem.message, problem.remedy) == (
            "CAMERA_STOPPED",
            "cable out",
            "Plug it in.",
        )
        source.reported.put(shot(1))
        until(lambda: capture.status().state is SourceState.RUNNING)
        assert capture.status().problem is None
        until(lambda: any(line["event"] == "source reconnected" for line in logs))
    stop.set()
    source.reported.put(None)
    capture.close()
    assert [line["event"] for line in logs][:2] == ["source started", "cable out"]
    assert [line["event"] for line in logs].count("cable out") == 1


def undecodable() -> cv2.error:
    """The error of a decoder that has run out of data."""
    with pytest.raises(cv2.error) as raised:
        cv2.cvtColor(np.zeros((2, 2, 1), np.uint8), cv2.COLOR_BGR2GRAY)
    return raised.value


@pytest.mark.parametrize(
    ("fault", "code"),
    [
        pytest.param(np.zeros((4, 6), np.uint8), "IMAGE_FORMAT_INVALID", id="grey"),
        pytest.param(np.zeros((4, 6, 2), np.uint8), "IMAGE_FORMAT_INVALID", id="yuyv-not-converted"),
        pytest.param(np.zeros((4, 6, 3), np.uint16), "IMAGE_FORMAT_INVALID", id="16-bit"),
        pytest.param(np.zeros((0, 0, 3), np.uint8), "IMAGE_FORMAT_INVALID", id="empty"),
        pytest.param(undecodable(), "IMAGE_NOT_DECODED", id="decoder-fails"),
    ],
)
def test_an_image_of_another_format_is_reported_and_the_next_good_one_is_live(
    fault: npt.NDArray[Any] | cv2.error, code: str
) -> None:
    source, stop = ScriptedSource(stalls=True), threading.Event()
    capture = Capture(source, stop=stop)
    capture.start()
    source.reported.put(shot(0))
    until(lambda: capture.status().state is SourceState.RUNNING)
    if isinstance(fault, cv2.error):
        source.reported.put(fault)
    else:
        source.reported.put(Shot.live(fault, number=1, captured_at_s=time.monotonic()))
    until(lambda: capture.status().state is SourceState.RECONNECTING)
    problem = capture.status().problem
    assert problem is not None
    assert (problem.code, capture.status().rate_hz) == (code, 0.0)
    assert "scripted" in problem.message
    # What came before the fault is not live.
    assert capture.take(0.0) is None
    source.reported.put(shot(2))
    until(lambda: capture.status().state is SourceState.RUNNING)
    found = capture.take(1.0)
    assert found is not None
    assert (found.number, source.opened) == (2, 2)
    stop.set()
    source.reported.put(None)
    capture.close()


def test_an_image_not_taken_before_the_camera_was_lost_is_not_live() -> None:
    source, stop = ScriptedSource(), threading.Event()
    capture = Capture(source, stop=stop)
    source.reported.put(shot(0))
    source.reported.put(gone())
    capture.start()
    until(lambda: capture.status().state is SourceState.RECONNECTING)
    assert capture.take(1000.0) is None
    stop.set()
    source.reported.put(None)
    capture.close()


def test_a_change_of_the_status_wakes_who_waits_for_an_image() -> None:
    source, stop = ScriptedSource(), threading.Event()
    capture = Capture(source, stop=stop)
    source.reported.put(gone())
    capture.start()
    # Woken by the change: the timeout is longer than the test may take.
    assert capture.take(1000.0) is None
    assert capture.status().state is SourceState.RECONNECTING
    stop.set()


def test_an_unexpected_fault_is_raised_where_the_images_are_taken() -> None:
    source, stop = ScriptedSource(), threading.Event()
    capture = Capture(source, stop=stop)
    source.reported.put(ZeroDivisionError("a bug"))
    capture.start()
    with pytest.raises(ZeroDivisionError):
        capture.take(1000.0)


def test_a_camera_that_is_open_and_silent_counts_as_stalled(monkeypatch: pytest.MonkeyPatch) -> None:
    source, stop = ScriptedSource(stalls=True), threading.Event()
    capture = Capture(source, stop=stop)
    source.reported.put(shot(0))
    capture.start()
    until(lambda: capture.status().state is SourceState.RUNNING)
    later_s = time.monotonic() + 2.5
    monkeypatch.setattr("server.capture.capture.time.monotonic", lambda: later_s)
    status = capture.status()
    monkeypatch.undo()
    assert status.state is SourceState.RECONNECTING
    assert status.problem is not None
    assert status.problem.code == "SOURCE_STALLED"
    stop.set()
    source.reported.put(None)


def test_a_camera_that_waits_for_its_trigger_is_not_taken_for_a_broken_one(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    source, stop = ScriptedSource(stalls=True), threading.Event()
    source.camera = CameraStatus(clock=ImageClock.DEVICE, trigger="Line1")
    capture = Capture(source, stop=stop)
    source.reported.put(shot(0))
    capture.start()
    until(lambda: capture.status().state is SourceState.RUNNING)
    later_s = time.monotonic() + 2.5
    with monkeypatch.context() as patch:
        patch.setattr("server.capture.capture.time.monotonic", lambda: later_s)
        status = capture.status()
    assert status.problem is not None
    assert status.problem.code == "CAMERA_NOT_TRIGGERED"
    assert status.problem.message == "scripted waits for a pulse on Line1, but received none for 2 s"
    stop.set()
    source.reported.put(None)


def test_an_image_that_a_frozen_camera_repeats_is_not_live() -> None:
    source, stop = ScriptedSource(stalls=True), threading.Event()
    capture = Capture(source, stop=stop)
    began_s = time.monotonic()
    # Each image twice, as from a slower camera; then one repeatedly.
    greys = [1, 1, 2, 2, *[3] * 40]
    for number, grey in enumerate(greys):
        source.reported.put(shot(number, grey=grey, at_s=began_s + 0.1 * number))
    with capture_logs() as logs:
        capture.start()
        until(lambda: source.opened == 2)
        status = capture.status()
        # It first arrived as the fifth; after a quarter of a second it is old.
        assert status.images == 7
        assert status.state is SourceState.RECONNECTING
        assert status.problem is not None
        assert status.problem.code == "SOURCE_FROZEN"
        # It does not return after the source was reopened; the next new image is live.
        until(source.reported.empty)
        assert capture.status().images == 7
        source.reported.put(shot(99))
        until(lambda: capture.status().state is SourceState.RUNNING)
        assert capture.status().images == 100
    stop.set()
    source.reported.put(None)
    capture.close()
    assert [line["event"] for line in logs if line["log_level"] == "warning"] == [
        "the source scripted repeated the same image for 2 s"
    ]


def test_a_folder_or_a_film_may_show_the_same_image_for_long() -> None:
    source, stop = ScriptedSource(), threading.Event()
    capture = Capture(source, stop=stop)
    began_s = time.monotonic()
    for number in range(40):
        source.reported.put(shot(number, grey=7, at_s=began_s + 0.1 * number))
    capture.start()
    until(lambda: capture.status().images == 40)
    assert capture.status().state is SourceState.RUNNING
    stop.set()
    source.reported.put(None)
    capture.close()


@pytest.mark.parametrize(
    "clock", [ImageClock.DRIVER, ImageClock.DEVICE, ImageClock.SENDER, ImageClock.BROWSER]
)
def test_lamps_that_flicker_are_noted_for_every_kind_of_camera_and_judged_anew_when_it_is_reopened(
    clock: ImageClock,
) -> None:
    source, stop = ScriptedSource(stalls=True), threading.Event()
    source.camera = CameraStatus(clock=clock)
    capture = Capture(source, stop=stop)
    began_s = time.monotonic()
    grey = np.full((64, 256, 3), 120, dtype=np.uint8)
    for number in range(140):
        at_s = began_s + number / 30
        image = lit(grey, at_s, light_hz=100.0, depth_ratio=0.1)
        source.reported.put(Shot(image=image, number=number, captured_at_s=at_s, source_time_s=at_s))
    with capture_logs() as logs:
        capture.start()
        until(lambda: capture.status().images == 140)
    status = capture.status()
    assert status.problem is None
    assert status.camera is not None
    assert status.camera.clock is clock
    assert status.camera.flicker is not None
    assert status.camera.flicker.mains_hz == (50,)
    assert [line["code"] for line in logs if line["log_level"] == "warning"] == ["LAMP_FLICKER"]
    source.reported.put(gone())
    until(lambda: source.opened == 2)
    source.reported.put(shot(140))
    until(lambda: capture.status().images == 141)
    status = capture.status()
    assert status.camera is not None
    assert status.camera.flicker is None
    stop.set()
    source.reported.put(None)
    capture.close()
