"""A set-up step processes live images: newest first, none twice; its end is reported."""

import threading
from collections.abc import Callable

from server.live import Instant, LiveHub
from server.procedure.live_listener import LiveListener
from tracker.errors import InvalidInput

InstantOf = Callable[..., Instant]


class RecordingCallback:
    """Records processed images; each call waits until the test releases it."""

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
    hub, callback = LiveHub(), RecordingCallback()
    hub.publish(instant_of(3))
    listener = LiveListener(hub, callback, name="test")
    hub.publish(instant_of(4))
    assert callback.began.acquire(timeout=30.0)
    for sequence in (5, 6, 7):
        hub.publish(instant_of(sequence))
    callback.go_on.release()
    assert callback.began.acquire(timeout=30.0)
    callback.go_on.release()
    listener.stop()
    assert callback.sequences == [4, 7]
    assert listener.problem is None


def test_what_a_look_raises_ends_it_and_is_reported(instant_of: InstantOf) -> None:
    for error, code in (
        (InvalidInput("ODD", "an image is odd", "Give another."), "ODD"),
        (ZeroDivisionError("a bug"), "STEP_FAILED"),
    ):
        hub, callback = LiveHub(), RecordingCallback(error)
        listener = LiveListener(hub, callback, name="test")
        hub.publish(instant_of(0))
        callback.go_on.release()
        listener._thread.join(30.0)
        assert listener.problem is not None
        assert listener.problem.code == code
        listener.stop()
