"""Background work has a lower priority than figures and alarms."""

import os
import sys
import threading
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

from server.capture.capture import Capture
from server.capture.rehearsal import RehearsalSource
from server.priority import NICENESS, lower_thread_priority
from server.stream.scaling.picture_cache import PictureCache

MAX_NICENESS = 19
pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="threads have priorities on Linux only")


def niceness() -> int:
    return os.getpriority(os.PRIO_PROCESS, threading.get_native_id())


def lowered(before: int) -> int:
    return min(before + NICENESS, MAX_NICENESS)


def test_one_thread_goes_behind_the_others() -> None:
    before = niceness()
    with ThreadPoolExecutor(1, initializer=lower_thread_priority) as pool:
        assert pool.submit(niceness).result() == lowered(before)
    with ThreadPoolExecutor(1) as pool:
        assert pool.submit(niceness).result() == before


@pytest.mark.parametrize("is_simulated", [True, False])
def test_a_simulated_image_waits_for_tracking_and_a_real_camera_does_not(*, is_simulated: bool) -> None:
    seen, before = list[int](), niceness()

    class Renderer:
        def image_at(self, at_s: float) -> np.ndarray[tuple[int, ...], np.dtype[np.uint8]]:
            seen.append(niceness())
            return np.full((4, 4, 3), round(at_s * 10) % 255, np.uint8)

    stop = threading.Event()
    source = RehearsalSource(Renderer(), rate_hz=10.0, stop=stop, fast=True, last_number=3)
    capture = Capture(source, stop=stop, is_simulated=is_simulated)
    capture.start()
    assert capture.take(timeout_s=60.0) is not None
    stop.set()
    capture.close(timeout_s=60.0)
    assert set(seen) == {lowered(before) if is_simulated else before}


def test_pictures_wait_for_figures() -> None:
    pictures = PictureCache(quality=80)
    assert pictures._thread.submit(niceness).result() == lowered(niceness())
    pictures.close()
