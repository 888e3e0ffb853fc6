"""A step of the set-up looks at live images: newest first, none twice, and its end is told."""

import threading
from collections.abc import Callable

from server.live import Instant, LiveHub
from server.procedure.following import Follower
from tracker.errors import InvalidInput

InstantOf = Callable[..., Instant]


class Looks:
    """Remembers what was looked at; each look waits until the test lets it go."""

    def __init__(self, error: Exception | None = None) -> None:
        self.sequences: list[int] = []
        self.began = threading.Semaphore(0)
        self.go_on = threading.Semaphore(0)
        self.error = error

    def __call__(self, instant: Instant) -> None:
        self.sequences.append(instant.sequence)
        self.began.release()
        assert self.go_on.acquire(timeout=30.0)
        if self.error is not None:
            raise self.error


def test_a_slow_look_skips_to_the_newest_instant(instant_of: InstantOf) -> None:
    hub, looks = LiveHub(), Looks()
    hub.publish(instant_of(3))
    follower = Follower(hub, looks, name="test")
    hub.publish(instant_of(4))
    assert looks.began.acquire(timeout=30.0)
    for sequence in (5, 6, 7):
        hub.publish(instant_of(sequence))
    looks.go_on.release()
    assert looks.began.acquire(timeout=30.0)
    looks.go_on.release()
    follower.stop()
    assert looks.sequences == [4, 7]
    assert follower.problem is None


def test_what_a_look_raises_ends_it_and_is_told(instant_of: InstantOf) -> None:
    for error, code in (
        (InvalidInput("ODD", "an image is odd", "Give another."), "ODD"),
        (ZeroDivisionError("a bug"), "STEP_FAILED"),
    ):
        hub, looks = LiveHub(), Looks(error)
        follower = Follower(hub, looks, name="test")
        hub.publish(instant_of(0))
        looks.go_on.release()
        follower._thread.join(30.0)
        assert follower.problem is not None
        assert follower.problem.code == code
        follower.stop()
