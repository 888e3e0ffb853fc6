"""Sections of the benchmark command."""

from collections.abc import Callable

from tests.benchmarks import accuracy, live, timing
from tests.benchmarks.alarms.good_drilling import good_drilling_table, stationary_drill_table
from tests.benchmarks.alarms.latency import breach_table
from tests.benchmarks.calibration.coverage import measure_calibration
from tests.benchmarks.calibration.rendered_coverage import measure_rendered_calibration
from tests.benchmarks.ct_reading import measure_ct_reading
from tests.benchmarks.ct_upload import measure_ct_upload
from tests.benchmarks.figures import Figure, Share, size_of
from tests.benchmarks.limits.condition_tables import condition_tables
from tests.benchmarks.limits.limit_figures import limit_figures
from tests.benchmarks.limits.limit_plots import limit_plots
from tests.benchmarks.limits.pace_tables import pace_tables
from tests.benchmarks.limits.run import measure, one_thread
from tests.benchmarks.load.load_tables import measure_load
from tests.benchmarks.offline import OfflineRun, measure_offline, times_s
from tests.benchmarks.options import BenchmarkOptions
from tests.benchmarks.overlay import measure_overlay
from tests.benchmarks.pedicles import measure_pedicles
from tests.benchmarks.recording import measure_recording
from tests.benchmarks.running_server import running_server
from tests.benchmarks.scenes.rigs import RIGS
from tests.benchmarks.section_result import SectionResult
from tests.benchmarks.tables import Table
from tests.benchmarks.tools import measure_tools
from tests.benchmarks.viewer import measure_viewer
from tracker.rehearsal import Theatre

LIVE_RATE_HZ = 30.0
ALARM_SECONDS = 600.0
MEDIAN_95 = "Sizes of errors, median / 95th percentile, of the claims that are not false."
MEDIAN_99 = "median / 99th percentile"


def measure_limits(options: BenchmarkOptions) -> SectionResult:
    """Measure the tracker on scenes of all conditions, beside its peers and the bound."""
    run = measure(options)
    return SectionResult(
        tables=[*condition_tables(run), *pace_tables(run)],
        figures=limit_figures(run),
        plots=limit_plots(run),
        is_complete=not options.conditions and set(options.rigs) == set(RIGS),
    )


def measure_rehearsal(options: BenchmarkOptions) -> SectionResult:
    """Measure poses against the truth: image by image, then in messages of a running server."""
    measured = _offline(options)
    return SectionResult(
        tables=[*_offline_tables(measured), *_live_tables(options)],
        # A harder theatre than the written one says nothing about the tracker.
        figures=_offline_figures(measured) if options.has_default_difficulty else {},
    )


def _offline(options: BenchmarkOptions) -> OfflineRun:
    measured = OfflineRun()
    with one_thread():
        for seed in options.seeds:
            one = measure_offline(
                Theatre(options.settings_of(seed)), times_s(seconds=options.seconds, rate_hz=options.rate_hz)
            )
            measured.stepped += one.stepped
            measured.searched += one.searched
            measured.timed += one.timed
    return measured


def _offline_tables(measured: OfflineRun) -> list[Table]:
    groups = accuracy.groups_by_phase(measured.stepped)
    both = [("step", measured.stepped), ("search alone", measured.searched)]
    return [
        accuracy.found_table("Found, by `Tracker.step` in each image", groups),
        accuracy.found_table("Found, all phases: the step, and the stateless search of each image", both),
        accuracy.pose_table("Pose against truth, by `Tracker.step`", groups, note=MEDIAN_95),
        accuracy.calibration_table("Is the stated uncertainty of the tip true?", groups),
        timing.stage_table(f"Time of each stage, {MEDIAN_99}, one thread", measured.timed),
        timing.ratio_table(
            f"Against `cv2.aruco` on the same images, {MEDIAN_99}, one thread", measured.timed
        ),
    ]


def _offline_figures(measured: OfflineRun) -> dict[str, Figure]:
    figures: dict[str, Figure | None] = {}
    for way, some in (("step", measured.stepped), ("search", measured.searched)):
        in_view = sum(one.in_view for one in some)
        false = len(accuracy.false_claims(some))
        found = in_view - len(accuracy.missed(some)) - sum(one.in_view for one in accuracy.false_claims(some))
        figures[f"{way}, found in view"] = Share(count=found, of=in_view)
        figures[f"{way}, false claims"] = Share(count=false, of=len(some), is_good=False, is_strict=True)
        figures[f"{way}, tip mm, median"] = size_of([one.tip_mm for one in accuracy.errors_of(some)])
    for way, ratios in (
        ("step", [one.step_ms / one.aruco_ms for one in measured.timed if one.tracked]),
        ("search", [one.search_ms / one.aruco_ms for one in measured.timed]),
    ):
        figures[f"{way} by cv2.aruco, median"] = size_of(ratios, is_time=True)
    return {name: figure for name, figure in figures.items() if figure is not None}


def _live_tables(options: BenchmarkOptions) -> list[Table]:
    seed = options.seeds[0]
    with running_server(options, seed=seed, live_rate_hz=LIVE_RATE_HZ) as server:
        received = live.listen(server, seconds=options.live_seconds)
    judgements = live.judge_messages(Theatre(options.settings_of(seed)), received, live_rate_hz=LIVE_RATE_HZ)
    groups = accuracy.groups_by_phase(judgements)
    return [
        accuracy.found_table("Live: found, in each message of `/ws/live`", groups),
        accuracy.pose_table(
            "Live: the pose in each message against the truth of its image", groups, note=MEDIAN_95
        ),
        live.pace_table(f"Live: age of the messages, {MEDIAN_99}", received),
        live.stage_table(f"Live: time of each stage as the messages tell it, {MEDIAN_99}", received),
    ]


def measure_drawing(options: BenchmarkOptions) -> SectionResult:
    """Measure drawing and encoding of one image."""
    return SectionResult(tables=measure_overlay(options))


def measure_server(options: BenchmarkOptions) -> SectionResult:
    """Measure a running server with one viewer of pictures."""
    with running_server(options, seed=options.seeds[0], live_rate_hz=LIVE_RATE_HZ) as server:
        return SectionResult(tables=measure_viewer(server))


def measure_ct(options: BenchmarkOptions) -> SectionResult:
    """Measure reading a large CT, and uploading it to a running server."""
    return SectionResult(tables=[*measure_ct_reading(), *measure_ct_upload(options)])


def measure_boards(_options: BenchmarkOptions) -> SectionResult:
    """Measure the calibration from rendered boards against its truth."""
    return measure_rendered_calibration()


def measure_phantoms(_options: BenchmarkOptions) -> SectionResult:
    """Measure pedicles of CT phantoms against their truth."""
    return measure_pedicles()


def measure_alarms(options: BenchmarkOptions) -> SectionResult:
    """Measure the latency of breach alarms, and false alarms."""
    # Eight breaches in each of the hand's cycles of 40 s.
    seconds = (
        ALARM_SECONDS if options.live_seconds == BenchmarkOptions().live_seconds else options.live_seconds
    )
    return SectionResult(
        tables=[breach_table(options, seconds=seconds), good_drilling_table(), stationary_drill_table()]
    )


SECTIONS: dict[str, Callable[[BenchmarkOptions], SectionResult]] = {
    "limits": measure_limits,
    "rehearsal": measure_rehearsal,
    "overlay": measure_drawing,
    "server": measure_server,
    "load": measure_load,
    "tools": measure_tools,
    "alarms": measure_alarms,
    "ct": measure_ct,
    "calibration": measure_calibration,
    "boards": measure_boards,
    "pedicles": measure_phantoms,
    "recording": measure_recording,
}
