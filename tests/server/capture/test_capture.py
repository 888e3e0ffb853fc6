"""The newest image, the status and the log of a source that is told what to do by the test."""

import queue
import threading
import time
from collections.abc import Callable, Sequence

import numpy as np
import pytest
from structlog.testing import capture_logs

from server.capture.capture import Capture
from server.capture.rehearsal import RehearsalSource
from server.capture.shot import Shot
from server.errors import CaptureError
from server.live import CameraStatus, ImageClock, SourceState
from tracker.rehearsal import Event, EventKind


def shot(number: int, *, grey: int | None = None, at_s: float | None = None) -> Shot:
    image = np.full((4, 6, 3), number % 256 if grey is None else grey, dtype=np.uint8)
    now_s = time.monotonic() if at_s is None else at_s
    return Shot(image=image, number=number, captured_at_s=now_s, source_time_s=now_s)


class ToldSource:
    """Gives what the test puts in: a shot, an error to raise, or None for the end."""

    def __init__(self, *, waits_for_taker: bool = False, stalls: bool = False) -> None:
        self.name = "told"
        self.waits_for_taker = waits_for_taker
        self.stalls = stalls
        self.defect: CaptureError | None = None
        self.camera: CameraStatus | None = None
        self.told: queue.Queue[Shot | BaseException | None] = queue.Queue()
        self.opened = 0

    def open(self) -> None:
        self.opened += 1

    def read(self) -> Shot | None:
        given = self.told.get()
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
    source, stop = ToldSource(), threading.Event()
    capture = Capture(source, stop=stop)
    for number in range(5):
        source.told.put(shot(number))
    capture.start()
    until(lambda: capture.status().images == 5)
    taken = capture.take(1.0)
    assert taken is not None
    assert taken.number == 4
    status = capture.status()
    assert (status.images, status.skipped_images) == (5, 4)
    stop.set()
    source.told.put(None)
    capture.close()


def test_a_source_that_waits_for_its_taker_skips_nothing() -> None:
    source, stop = ToldSource(waits_for_taker=True), threading.Event()
    capture = Capture(source, stop=stop)
    for number in range(5):
        source.told.put(shot(number))
    source.told.put(None)
    capture.start()
    numbers: list[int] = []
    while capture.status().state is not SourceState.ENDED or len(numbers) < 5:
        taken = capture.take(1.0)
        if taken is not None:
            numbers.append(taken.number)
    assert numbers == [0, 1, 2, 3, 4]
    assert capture.status().skipped_images == 0


def test_a_fault_is_told_once_however_often_it_is_tried_and_it_comes_back() -> None:
    source, stop = ToldSource(), threading.Event()
    capture = Capture(source, stop=stop)
    with capture_logs() as logs:
        source.told.put(shot(0))
        for _ in range(3):
            source.told.put(gone())
        capture.start()
        until(lambda: source.opened == 4)
        assert capture.status().state is SourceState.RECONNECTING
        trouble = capture.status().trouble
        assert trouble is not None
        assert (trouble.code, trouble.message, trouble.remedy) == (
            "CAMERA_STOPPED",
            "cable out",
            "Plug it in.",
        )
        source.told.put(shot(1))
        until(lambda: capture.status().state is SourceState.RUNNING)
        assert capture.status().trouble is None
        until(lambda: any(line["event"] == "source is back" for line in logs))
    stop.set()
    source.told.put(None)
    capture.close()
    assert [line["event"] for line in logs][:2] == ["source runs", "cable out"]
    assert [line["event"] for line in logs].count("cable out") == 1


def test_a_change_of_the_status_wakes_who_waits_for_an_image() -> None:
    source, stop = ToldSource(), threading.Event()
    capture = Capture(source, stop=stop)
    source.told.put(gone())
    capture.start()
    # Woken by the change: the time given is longer than the test may take.
    assert capture.take(1000.0) is None
    assert capture.status().state is SourceState.RECONNECTING
    stop.set()


def test_an_unexpected_fault_is_raised_where_the_images_are_taken() -> None:
    source, stop = ToldSource(), threading.Event()
    capture = Capture(source, stop=stop)
    source.told.put(ZeroDivisionError("a bug"))
    capture.start()
    with pytest.raises(ZeroDivisionError):
        capture.take(1000.0)


def test_a_camera_that_is_open_and_silent_counts_as_stalled(monkeypatch: pytest.MonkeyPatch) -> None:
    source, stop = ToldSource(stalls=True), threading.Event()
    capture = Capture(source, stop=stop)
    source.told.put(shot(0))
    capture.start()
    until(lambda: capture.status().state is SourceState.RUNNING)
    later_s = time.monotonic() + 2.5
    monkeypatch.setattr("server.capture.capture.time.monotonic", lambda: later_s)
    status = capture.status()
    monkeypatch.undo()
    assert status.state is SourceState.RECONNECTING
    assert status.trouble is not None
    assert status.trouble.code == "SOURCE_STALLED"
    stop.set()
    source.told.put(None)


def test_a_camera_that_waits_for_its_trigger_is_not_taken_for_a_broken_one(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    source, stop = ToldSource(stalls=True), threading.Event()
    source.camera = CameraStatus(clock=ImageClock.DEVICE, trigger="Line1")
    capture = Capture(source, stop=stop)
    source.told.put(shot(0))
    capture.start()
    until(lambda: capture.status().state is SourceState.RUNNING)
    later_s = time.monotonic() + 2.5
    with monkeypatch.context() as patch:
        patch.setattr("server.capture.capture.time.monotonic", lambda: later_s)
        status = capture.status()
    assert status.trouble is not None
    assert status.trouble.code == "CAMERA_NOT_TRIGGERED"
    assert status.trouble.message == "told waits for a pulse on Line1, and none came for 2 s"
    stop.set()
    source.told.put(None)


def test_an_image_that_a_frozen_camera_repeats_is_not_live() -> None:
    source, stop = ToldSource(stalls=True), threading.Event()
    capture = Capture(source, stop=stop)
    began_s = time.monotonic()
    # Each image twice, as of a slower camera; then one for ever.
    greys = [1, 1, 2, 2, *[3] * 40]
    for number, grey in enumerate(greys):
        source.told.put(shot(number, grey=grey, at_s=began_s + 0.1 * number))
    with capture_logs() as logs:
        capture.start()
        until(lambda: source.opened == 2)
        status = capture.status()
        # It came first as the fifth; after a quarter of a second it is old.
        assert status.images == 7
        assert status.state is SourceState.RECONNECTING
        assert status.trouble is not None
        assert status.trouble.code == "SOURCE_FROZEN"
        # No more of it after the source was opened again; the next new image is live.
        until(source.told.empty)
        assert capture.status().images == 7
        source.told.put(shot(99))
        until(lambda: capture.status().state is SourceState.RUNNING)
        assert capture.status().images == 100
    stop.set()
    source.told.put(None)
    capture.close()
    assert [line["event"] for line in logs if line["log_level"] == "warning"] == [
        "the source told gave the same image for 2 s"
    ]


def test_a_folder_or_a_film_may_show_the_same_image_for_long() -> None:
    source, stop = ToldSource(), threading.Event()
    capture = Capture(source, stop=stop)
    began_s = time.monotonic()
    for number in range(40):
        source.told.put(shot(number, grey=7, at_s=began_s + 0.1 * number))
    capture.start()
    until(lambda: capture.status().images == 40)
    assert capture.status().state is SourceState.RUNNING
    stop.set()
    source.told.put(None)
    capture.close()


class Numbered:
    def image_at(self, at_s: float) -> np.ndarray:
        return np.full((4, 6, 3), round(at_s * 100) % 256, dtype=np.uint8)


def test_the_theatre_shows_number_by_rate_seconds_of_its_own_clock() -> None:
    stop = threading.Event()
    source = RehearsalSource(Numbered(), rate_hz=25.0, stop=stop, fast=True, first_number=7, last_number=9)
    source.open()
    shots = [source.read() for _ in range(4)]
    given = [shot for shot in shots if shot is not None]
    assert [shot.number for shot in given] == [7, 8, 9]
    assert [shot.source_time_s for shot in given] == pytest.approx([0.28, 0.32, 0.36])
    assert [int(shot.image[0, 0, 0]) for shot in given] == [28, 32, 36]
    assert shots[3] is None


def silence(kind: EventKind, at_s: float, lasts_s: float) -> Event:
    return Event(kind=kind, at_s=at_s, lasts_s=lasts_s)


def fast_source(*silences: Event, last_number: int | None = None) -> RehearsalSource:
    return RehearsalSource(
        Numbered(),
        rate_hz=25.0,
        stop=threading.Event(),
        fast=True,
        silences=silences,
        last_number=last_number,
    )


def test_a_silent_theatre_leaves_out_the_images_of_that_time() -> None:
    source = fast_source(silence(EventKind.CAMERA_STALLS, 0.08, 0.2), last_number=9)
    source.open()
    given = [shot.number for shot in iter(source.read, None) if shot is not None]
    assert given == [0, 1, 7, 8, 9]
    for_good = fast_source(silence(EventKind.CAMERA_STOPS, 0.08, float("inf")))
    for_good.open()
    assert [for_good.read() is None for _ in range(4)] == [False, False, True, True]


class Clock(threading.Event):
    """Time that passes while somebody waits or renders."""

    now_s = 100.0

    def __call__(self) -> float:
        return self.now_s

    def wait(self, timeout: float | None = None) -> bool:
        self.now_s += timeout or 0.0
        return False


class SlowlyRendered(Numbered):
    def __init__(self, clock: Clock, takes_s: float) -> None:
        self.clock, self.takes_s = clock, takes_s

    def image_at(self, at_s: float) -> np.ndarray:
        self.clock.now_s += self.takes_s
        return super().image_at(at_s)


@pytest.mark.parametrize(
    ("takes_s", "numbers", "max_late_s"),
    [(0.015, [0, 1, 2, 3, 4, 5], 1e-9), (0.06, [0, 2, 4, 5, 7, 8], 0.06)],
    ids=["in time", "slower than the rate"],
)
def test_the_theatres_images_are_rendered_before_they_are_due(
    takes_s: float, numbers: Sequence[int], max_late_s: float
) -> None:
    clock = Clock()
    source = RehearsalSource(
        SlowlyRendered(clock, takes_s), rate_hz=25.0, stop=clock, first_number=0, clock=clock
    )
    source.open()
    began_s = clock.now_s
    shots, late_s = [], []
    for _ in numbers:
        shot = source.read()
        assert shot is not None
        shots.append(shot)
        late_s.append(clock.now_s - shot.captured_at_s)
        clock.now_s += 1e-4
    # The age of an image counts from the instant that it shows, however long it was rendered.
    assert [shot.captured_at_s - began_s for shot in shots] == pytest.approx(
        [shot.number / 25 for shot in shots]
    )
    assert [shot.source_time_s for shot in shots] == pytest.approx([shot.number / 25 for shot in shots])
    assert late_s[0] == pytest.approx(takes_s), "the first is due at once"
    assert all(-1e-9 <= late <= max_late_s for late in late_s[1:])
    assert [shot.number for shot in shots] == numbers


def test_a_theatre_whose_camera_stops_says_so_and_its_clock_goes_on() -> None:
    clock = Clock()
    source = RehearsalSource(
        Numbered(),
        rate_hz=10.0,
        stop=clock,
        silences=(silence(EventKind.CAMERA_STOPS, 2.0, 3.0),),
        clock=clock,
    )
    source.open()
    assert source.read() is not None
    clock.now_s += 2.5
    for _ in range(3):
        with pytest.raises(CaptureError, match="gives no images"):
            source.read()
        source.open()
    clock.now_s += 3.0
    back = source.read()
    assert back is not None
    assert back.source_time_s == pytest.approx(5.5)


def test_another_scene_begins_at_zero_with_the_next_number() -> None:
    source = fast_source()
    source.open()
    for _ in range(3):
        source.read()
    source.play(Numbered(), scene_number=4, silences=(silence(EventKind.CAMERA_STALLS, 9.0, 1.0),))
    assert (source.begun.scene_number, source.begun.first_number) == (4, 4)
    assert source.stalls
    shot = source.read()
    assert shot is not None
    assert (shot.number, shot.source_time_s) == (4, 0.0)
