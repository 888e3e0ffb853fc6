"""The rehearsal as a source of images: numbers, times, outages and scenes."""

import threading
from collections.abc import Sequence

import numpy as np
import pytest

from server.capture.rehearsal import RehearsalSource
from server.errors import CaptureError
from tracker.rehearsal import Event, EventKind


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


def fast_source(*outages: Event, last_number: int | None = None) -> RehearsalSource:
    return RehearsalSource(
        Numbered(),
        rate_hz=25.0,
        stop=threading.Event(),
        fast=True,
        outages=outages,
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
    """Time that passes while waiting or rendering."""

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
    # The age of an image counts from the instant that it shows, whatever its rendering time.
    assert [shot.captured_at_s - began_s for shot in shots] == pytest.approx(
        [shot.number / 25 for shot in shots]
    )
    assert [shot.source_time_s for shot in shots] == pytest.approx([shot.number / 25 for shot in shots])
    assert late_s[0] == pytest.approx(takes_s), "the first is due at once"
    assert all(-1e-9 <= late <= max_late_s for late in late_s[1:])
    assert [shot.number for shot in shots] == numbers


def test_a_theatre_whose_camera_stops_reports_it_and_its_clock_continues() -> None:
    clock = Clock()
    source = RehearsalSource(
        Numbered(),
        rate_hz=10.0,
        stop=clock,
        outages=(silence(EventKind.CAMERA_STOPS, 2.0, 3.0),),
        clock=clock,
    )
    source.open()
    assert source.read() is not None
    clock.now_s += 2.5
    for _ in range(3):
        with pytest.raises(CaptureError, match="stopped its camera"):
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
    source.play(Numbered(), scene_number=4, outages=(silence(EventKind.CAMERA_STALLS, 9.0, 1.0),))
    assert (source.played_scene.scene_number, source.played_scene.first_number) == (4, 4)
    assert source.stalls
    shot = source.read()
    assert shot is not None
    assert (shot.number, shot.source_time_s) == (4, 0.0)
