"""Buffered images of a stream are detected by their arrival rhythm."""

from collections.abc import Iterable

from server.capture.backlog import Backlog


def judged(*intervals_s: float) -> str:
    """Results for an image at 0 and one after each of these intervals: L for live, o for old."""
    backlog, at_s = Backlog(), 0.0
    said = ["o" if backlog.is_old(at_s) else "L"]
    for interval_s in intervals_s:
        at_s += interval_s
        said.append("o" if backlog.is_old(at_s) else "L")
    return "".join(said)


def steady(images: int, period_s: float = 0.033) -> Iterable[float]:
    return [period_s] * images


def test_images_in_rhythm_are_live_but_the_first() -> None:
    assert judged(*steady(5)) == "oLLLLL"
    assert judged(*steady(5, 0.5)) == "oLLLLL"


def test_what_a_server_kept_before_the_stream_was_opened_is_old() -> None:
    assert judged(*steady(8, 0.003), *steady(3)) == "o" + "o" * 8 + "LLL"


def test_after_a_pause_the_first_image_and_all_upon_its_heels_are_old() -> None:
    assert judged(*steady(10), 1.0, *steady(30, 0.002), *steady(3)) == "o" + "L" * 10 + "o" * 31 + "LLL"


def test_after_a_pause_without_a_burst_one_image_is_lost() -> None:
    assert judged(*steady(10), 0.4, *steady(3)) == "o" + "L" * 10 + "oLLL"


def test_jitter_is_no_pause() -> None:
    assert judged(*steady(10), 0.2, 0.001, 0.05, 0.01, 0.08) == "o" + "L" * 15


def test_bursts_for_ever_are_never_live() -> None:
    burst = [0.4, *steady(11, 0.002)]
    assert set(judged(*steady(10), *burst, *burst, *burst)[11:]) == {"o"}
    backlog = Backlog()
    for number in range(50):
        backlog.is_old(number * 0.033)
    assert backlog.old_for_s(49 * 0.033) == 0.0
    assert backlog.old_for_s(49 * 0.033 + 2.5) == 2.5


def test_a_camera_that_becomes_slow_is_live() -> None:
    assert judged(*steady(10), *steady(20, 0.5)) == "o" + "L" * 10 + "o" + "L" * 19


def test_a_camera_that_becomes_fast_is_live() -> None:
    assert judged(*steady(10, 0.5), *steady(20)) == "o" + "L" * 30


def test_after_it_is_opened_again_nothing_is_known() -> None:
    backlog = Backlog()
    for number in range(20):
        backlog.is_old(number * 0.5)
    backlog.restart()
    assert [backlog.is_old(at_s) for at_s in (100.0, 100.033, 100.066)] == [True, False, False]
