"""Latency from synthetic times: the true values are recovered whatever ids, images and clocks do."""

from dataclasses import replace

import numpy as np
import pytest

from server.latency import ClockComparison, PaintedCode, ReadImage, ShownImage, latency_report
from server.latency.clocks import ServerClock
from tests.server.latency.made_run import Run
from tracker.errors import CalibrationError

AFTER_CAPTURE = {"tracking": 12.0, "server": 6.0, "line": 4.0, "page": 10.0}


def of_hand(painted: list[tuple[int, float]], shown: list[tuple[int, int | None, float]]) -> list[float]:
    """Median and 99th percentile of codes (number, painted) and images (number, code, shown), in ms."""
    report = latency_report(
        painted=[PaintedCode(code=code, painted_at_ms=at_ms) for code, at_ms in painted],
        read=[
            ReadImage(image_number=number, captured_at_s=at / 1e3, concluded_at_s=at / 1e3, code=code)
            for number, code, at in shown
        ],
        shown=[
            ShownImage(image_number=number, sent_at_s=at / 1e3, received_at_ms=at, shown_at_ms=at)
            for number, _, at in shown
        ],
        comparisons=[ClockComparison(requested_at_ms=0.0, responded_at_ms=2.0, server_s=0.001)],
        min_timed=1,
    )
    return [report.samples, report.median_ms, report.p99_ms]


@pytest.mark.parametrize(
    ("painted", "shown", "said"),
    [
        pytest.param(
            [(0, 100), (1, 200), (2, 300)],
            [(1, 0, 150), (2, 1, 260), (3, 2, 390)],
            [2, 75.0, 90.0],
            id="each-code-in-one-image-but-the-first-whose-beginning-nobody-saw",
        ),
        pytest.param(
            [(0, 100), (1, 200)],
            [(1, 0, 150), (2, 1, 260), (3, 1, 290), (4, 1, 320)],
            [1, 60.0, 60.0],
            id="a-code-counts-where-it-is-seen-first",
        ),
        pytest.param(
            [(0, 100), (1, 200), (0, 300), (1, 400)],
            [(1, 0, 150), (2, 1, 260), (3, 0, 370), (4, 1, 480)],
            [3, 70.0, 80.0],
            id="a-number-that-comes-again-is-the-newest-painting-of-it",
        ),
        pytest.param(
            [(0, 100), (1, 200), (2, 300), (3, 400)],
            [(1, 0, 150), (2, 3, 460)],
            [3, 160.0, 260.0],
            id="codes-that-no-image-shows-are-as-late-as-the-next-one-that-is-seen",
        ),
        pytest.param(
            [(0, 100), (1, 200), (2, 300)],
            [(1, 0, 150), (2, None, 250), (3, 1, 280), (4, None, 310), (5, None, 340), (6, 2, 370)],
            [1, 80.0, 80.0],
            id="behind-two-unreadable-images-nobody-knows-when-the-code-came",
        ),
        pytest.param(
            [(0, 100), (1, 200), (2, 300)],
            [(1, 0, 150), (2, 1, 260), (3, 0, 290), (4, 2, 370)],
            [2, 65.0, 70.0],
            id="an-older-code-is-a-reflection-and-no-way-back",
        ),
        pytest.param(
            [(0, 100), (1, 200)],
            [(1, 0, 150), (2, 1, 260), (1, 0, 300), (2, 1, 310)],
            [1, 60.0, 60.0],
            id="an-image-that-is-sent-again-counts-once",
        ),
        pytest.param(
            [(0, 100), (1, 200)],
            [(1, 0, 150), (2, 77, 230), (3, 1, 260)],
            [1, 60.0, 60.0],
            id="a-number-that-was-never-painted-is-not-read",
        ),
    ],
)
def test_cases_that_a_hand_can_check(
    painted: list[tuple[int, float]], shown: list[tuple[int, int | None, float]], said: list[float]
) -> None:
    assert of_hand(painted, shown) == said


def test_what_was_put_in_comes_out_with_each_stage() -> None:
    run = Run()
    report = run.report()
    truth = run.first_shown_ms(range(1, run.codes))
    assert report.samples == run.codes - 1
    assert report.median_ms == pytest.approx(float(np.median(truth)), abs=0.1)
    assert report.p99_ms == pytest.approx(float(np.percentile(truth, 99, method="higher")), abs=0.1)
    for stage, ms in AFTER_CAPTURE.items():
        assert report.stage_ms[stage] == pytest.approx(ms, abs=0.1), stage
    # A code waits for half an image period on average, which is stated.
    assert report.late_on_average_ms == 16.5
    waited_ms = report.stage_ms["screen and camera"] - run.camera_ms
    assert waited_ms == pytest.approx(report.late_on_average_ms, abs=5.0)
    assert report.clock_error_ms == 1.5


@pytest.mark.parametrize("drift_ratio", [2e-4, -2e-4], ids=["server-faster", "server-slower"])
def test_clocks_that_drift_leave_the_latency_and_its_stages(drift_ratio: float) -> None:
    still, drifting = Run().report(), Run(drift_ratio=drift_ratio).report()
    assert drifting.median_ms == still.median_ms
    assert drifting.p99_ms == still.p99_ms
    for stage, ms in still.stage_ms.items():
        # 4 ms in 20 s if uncorrected.
        assert drifting.stage_ms[stage] == pytest.approx(ms, abs=0.3), stage


def test_a_wrong_comparison_moves_time_between_stages_and_leaves_their_sum() -> None:
    right, wrong = Run(), Run()
    wrong.comparisons = [replace(one, server_s=one.server_s + 0.02) for one in wrong.comparisons]
    said, off = right.report(), wrong.report()
    assert off.median_ms == said.median_ms
    assert off.stage_ms["line"] == pytest.approx(said.stage_ms["line"] + 20.0, abs=0.1)
    assert off.stage_ms["screen and camera"] == pytest.approx(
        said.stage_ms["screen and camera"] - 20.0, abs=0.1
    )


def test_slow_answers_say_nothing_of_the_clocks() -> None:
    fast = [
        ClockComparison(requested_at_ms=at, responded_at_ms=at + 2.0, server_s=(at + 1.0) / 1e3)
        for at in (0.0, 9e3)
    ]
    # All of its 300 ms on the return path.
    slow = ClockComparison(requested_at_ms=4e3, responded_at_ms=4300.0, server_s=4.001)
    clock = ServerClock.of([*fast, slow])
    assert clock.page_ms(4.0) == pytest.approx(4000.0, abs=1e-6)
    assert clock.error_ms == 1.0


@pytest.mark.parametrize("drift_ratio", [2e-4, -2e-4])
def test_a_moment_of_a_drifting_clock_is_right_at_both_ends(drift_ratio: float) -> None:
    run = Run(drift_ratio=drift_ratio)
    clock = ServerClock.of(run.comparisons)
    for page_ms in (1000.0, 20_000.0):
        assert clock.page_ms(run.server_s(page_ms)) == pytest.approx(page_ms, abs=0.01)


def test_a_slope_that_no_quartz_has_is_noise_of_the_line() -> None:
    compared = [
        ClockComparison(requested_at_ms=at, responded_at_ms=at + 20.0, server_s=(at + late) / 1e3)
        for at, late in ((0.0, 0.0), (3000.0, 10.0), (6000.0, 20.0))
    ]
    clock = ServerClock.of(compared)
    assert clock.ms_per_s == 1000.0
    assert clock.page_ms(6.0) == pytest.approx(6000.0, abs=clock.error_ms)


def test_numbers_that_begin_again_are_distinguished() -> None:
    long, short = Run(codes=160), Run(codes=160, cycle=60)
    assert short.report() == long.report()


def test_a_slow_camera_times_every_code_and_states_the_resolution() -> None:
    run = Run(period_ms=200.0)
    report = run.report()
    # Except those before the first image with a code, and the last one.
    assert report.samples == run.codes - 2
    assert (report.image_period_ms, report.late_on_average_ms) == (200.0, 100.0)
    truth = run.first_shown_ms(range(1, run.codes - 1))
    assert report.median_ms == pytest.approx(float(np.median(truth)), abs=0.1)


def test_images_that_the_page_missed_make_codes_late_and_hide_none() -> None:
    # Half a second in which the page drew nothing.
    run = Run(unseen=frozenset(range(300, 316)))
    report = run.report()
    assert report.samples == run.codes - 1
    assert report.skipped_images == 16
    assert report.p99_ms > 400.0
    assert report.median_ms == pytest.approx(Run().report().median_ms, abs=2.0)


def test_a_hand_before_the_camera_leaves_its_codes_out() -> None:
    report = Run(blind=frozenset(range(300, 316))).report()
    assert report.samples < Run().codes - 4
    assert report.p99_ms < 120.0


@pytest.mark.parametrize(
    ("run", "code", "said"),
    [
        pytest.param(
            Run(blind=frozenset(range(12, 10_000))),
            "LATENCY_CODE_NOT_READ",
            "the code was read in 11 of 609 images, the minimum is 100",
            id="camera-turned-away",
        ),
        pytest.param(
            Run(codes=40),
            "LATENCY_CODE_NOT_READ",
            "39 of 40 codes could be timed, the minimum is 100",
            id="ended-too-early",
        ),
        pytest.param(
            Run(unseen=frozenset(range(0, 10_000, 4))),
            "LATENCY_IMAGES_SKIPPED",
            "151 of 607 images were not shown on this page, the maximum is 60",
            id="page-too-slow",
        ),
        pytest.param(
            Run(unlooked=frozenset(range(0, 10_000, 4))),
            "LATENCY_IMAGES_SKIPPED",
            "153 of 609 images on this page were not searched for a code, the maximum is 60",
            id="server-too-slow",
        ),
    ],
)
def test_what_cannot_be_timed_is_rejected_in_numbers(run: Run, code: str, said: str) -> None:
    with pytest.raises(CalibrationError) as rejected:
        run.report()
    assert rejected.value.code == code
    assert rejected.value.message == said
    assert rejected.value.remedy.endswith(".")


def test_nothing_at_all_is_rejected_too() -> None:
    with pytest.raises(CalibrationError, match="read in 0 of 0 images, the minimum is 100"):
        latency_report(painted=[], read=[], shown=[], comparisons=Run().comparisons, min_timed=100)
