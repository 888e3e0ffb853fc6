"""What the command measures, section by section."""

from collections.abc import Callable

import cv2

from tests.benchmarks import accuracy, live, timing
from tests.benchmarks.asked import Asked
from tests.benchmarks.offline import Offline, measure_offline, times_s
from tests.benchmarks.overlay import measure_overlay
from tests.benchmarks.running_server import running_server
from tests.benchmarks.tables import Table
from tests.benchmarks.viewer import measure_viewer
from tracker.rehearsal import Theatre

LIVE_RATE_HZ = 30.0
MEDIAN_95 = "Sizes of errors, median / 95th percentile, of the claims that are not false."
MEDIAN_99 = "median / 99th percentile"


def measure_rehearsal(asked: Asked) -> list[Table]:
    """Poses against the truth: image by image, then as a running server tells them."""
    return [*_offline_tables(asked), *_live_tables(asked)]


def _offline_tables(asked: Asked) -> list[Table]:
    measured = Offline()
    threads = cv2.getNumThreads()
    # One thread each, so that the ratio compares work and not cores.
    cv2.setNumThreads(1)
    try:
        for seed in asked.seeds:
            one = measure_offline(
                Theatre(asked.settings_of(seed)), times_s(seconds=asked.seconds, rate_hz=asked.rate_hz)
            )
            measured.stepped += one.stepped
            measured.searched += one.searched
            measured.timed += one.timed
    finally:
        cv2.setNumThreads(threads)
    groups = accuracy.groups_by_phase(measured.stepped)
    both = [("step", measured.stepped), ("search alone", measured.searched)]
    return [
        accuracy.found_table("Found, by `Tracker.step` in each image", groups),
        accuracy.found_table("Found, all phases: the step, and the stateless search of each image", both),
        accuracy.pose_table("Pose against truth, by `Tracker.step`", groups, note=MEDIAN_95),
        accuracy.honesty_table("Is the stated uncertainty of the tip true?", groups),
        timing.stage_table(f"Time of each stage, {MEDIAN_99}, one thread", measured.timed),
        timing.ratio_table(
            f"Against `cv2.aruco` on the same images, {MEDIAN_99}, one thread", measured.timed
        ),
    ]


def _live_tables(asked: Asked) -> list[Table]:
    seed = asked.seeds[0]
    with running_server(asked, seed=seed, live_rate_hz=LIVE_RATE_HZ) as server:
        heard = live.listen(server, seconds=asked.live_seconds)
    judgements = live.judge_messages(Theatre(asked.settings_of(seed)), heard, live_rate_hz=LIVE_RATE_HZ)
    groups = accuracy.groups_by_phase(judgements)
    return [
        accuracy.found_table("Live: found, in each message of `/ws/live`", groups),
        accuracy.pose_table(
            "Live: the pose in each message against the truth of its image", groups, note=MEDIAN_95
        ),
        live.pace_table(f"Live: age of the messages, {MEDIAN_99}", heard),
        live.stage_table(f"Live: time of each stage as the messages tell it, {MEDIAN_99}", heard),
    ]


def measure_server(asked: Asked) -> list[Table]:
    """A running server with one viewer of pictures."""
    with running_server(asked, seed=asked.seeds[0], live_rate_hz=LIVE_RATE_HZ) as server:
        return measure_viewer(server)


SECTIONS: dict[str, Callable[[Asked], list[Table]]] = {
    "rehearsal": measure_rehearsal,
    "overlay": measure_overlay,
    "server": measure_server,
}
