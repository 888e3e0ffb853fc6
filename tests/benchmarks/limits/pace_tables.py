"""Tables of times, of moving and returning markers, of the first image and of images without a marker."""

from collections.abc import Sequence

from tests.benchmarks.limits import goals
from tests.benchmarks.limits.condition_tables import PEERS, coverage, errors, of, right, stated, wrong
from tests.benchmarks.limits.pace import PaceRun
from tests.benchmarks.limits.peers import APRILTAG_ABSENT
from tests.benchmarks.limits.returning import MAX_IMAGES
from tests.benchmarks.limits.run import LimitsRun
from tests.benchmarks.tables import NOTHING, Table, median, number, pair

RETURNED_WITHIN = (1, 3, 6, 16, MAX_IMAGES)


def pace_tables(run: LimitsRun) -> list[Table]:
    """Return the tables of everything that was measured."""
    return [
        table
        for table in (
            _time_table(run),
            _hand_table(run),
            _return_table(run),
            _first_table(run),
            _empty_table(run),
        )
        if table.rows
    ]


def ratios(times_ms: Sequence[float], others_ms: Sequence[float]) -> list[float]:
    """Return the ratios image by image."""
    return [own / other for own, other in zip(times_ms, others_ms, strict=True)]


def _time_table(run: LimitsRun) -> Table:
    rows = []
    for one in run.paces:
        width, height = one.rig.size_wh_px
        load = f"{width}x{height}, {one.known} known, {one.in_view} in view"
        search, step = goals.SEARCH_OF_ARUCO.get(one.rig.name), goals.STEP_OF_ARUCO.get(one.rig.name)
        idle = goals.IDLE_STEP_OF_ARUCO.get(one.rig.name) if one.known == 1 else None
        is_single = one.in_view == one.known == 1
        rows.append(
            [
                load,
                str(len(one.search_ms)),
                pair(one.search_ms, 99.0),
                _by(run, one, "cv2.aruco"),
                _pair_of(search) if is_single else NOTHING,
                _by(run, one, "AprilTag"),
                pair(one.step_ms, 99.0),
                pair(ratios(one.step_ms, one.by_step_ms), 99.0, 3),
                _pair_of(step) if is_single else _pair_of(idle) if one.in_view == 0 else _four(run, one),
                pair(one.peers_ms["cv2.aruco"], 99.0),
                pair(one.peers_ms["AprilTag"], 99.0) if "AprilTag" in run.peers else APRILTAG_ABSENT,
            ]
        )
    if rows:
        paper = f"{goals.PAPER_SEARCH_MS:g} at most"
        rows.append(["the paper's search, on its own machine", NOTHING, paper, *([NOTHING] * 8)])
    return Table(
        title="Time of search and step, one thread: median / 99th percentile",
        columns=[
            "image, markers",
            "n",
            "search ms",
            "search by cv2.aruco",
            "goal",
            "search by AprilTag",
            "step ms",
            "step by cv2.aruco",
            "goal",
            "cv2.aruco ms",
            "AprilTag ms",
        ],
        rows=rows,
    )


def _by(run: LimitsRun, one: PaceRun, peer: str) -> str:
    if peer not in run.peers:
        return APRILTAG_ABSENT
    return pair(ratios(one.search_ms, one.peers_ms[peer]), 99.0, 3)


def _pair_of(goal: tuple[float, float] | None) -> str:
    return NOTHING if goal is None else f"{goal[0]:g} / {goal[1]:g}"


def _four(run: LimitsRun, one: PaceRun) -> str:
    """Return the time ratio of a step with four markers in view to one with one, both by the same peer.

    Not in ms, because other work may slow down one of both.
    """
    if one.in_view < one.known:
        return NOTHING
    single = next(each for each in run.paces if each.rig == one.rig and each.in_view == each.known == 1)
    by_peer = [median(ratios(each.step_ms, each.by_step_ms)) for each in (one, single)]
    times = by_peer[0] / by_peer[1]
    return f"{times:.2f} of one, goal {goals.FOUR_OF_ONE:g}"


def _hand_table(run: LimitsRun) -> Table:
    rows = [
        [
            f"{one.rig} {one.speed}",
            str(len(one.stepped)),
            of(right(one.stepped), one.stepped),
            of(sum(each.found_by == "track" for each in one.stepped), one.stepped),
            pair(errors(one.stepped, "tip_mm"), 95.0, 3),
            str(wrong(one.stepped)),
            str(sum(each.is_mirrored for each in one.stepped)),
            pair(one.ratios, 99.0, 3),
            _pair_of(goals.STEP_OF_ARUCO[one.rig]),
            coverage(one.stepped)[2] if stated(one.stepped) else NOTHING,
        ]
        for one in run.hands
    ]
    return Table(
        title="A moving hand at 60 Hz, followed by step",
        columns=[
            "camera, speed",
            "n",
            "found",
            "by tracking",
            "tip mm, median / p95",
            "wrong",
            "mirrored",
            "by cv2.aruco, median / p99",
            "goal",
            "tip inside 95 %",
        ],
        rows=rows,
        note=f"Goals: found {goals.FOUND_IN_HAND:g}; p95 of the tip at most {goals.P95_OF_MEDIAN:g} medians.",
    )


def _return_table(run: LimitsRun) -> Table:
    rows = []
    for one in run.returns:
        within = (
            sum(images <= max_images for images in one.images) / len(one.images)
            for max_images in RETURNED_WITHIN
        )
        goal = goals.IMAGES_TO_RETURN.get(one.condition)
        rows.append(
            [
                f"{one.rig} {one.condition}",
                str(len(one.images)),
                *(number(share) for share in within),
                NOTHING if goal is None else f"0.95 within {goal}",
                str(wrong(one.claims)),
            ]
        )
    return Table(
        title="A marker that comes back into view: share found by step, by the number of images",
        columns=[
            "camera, condition",
            "n",
            *(f"within {max_images}" for max_images in RETURNED_WITHIN),
            "goal",
            "wrong",
        ],
        rows=rows,
    )


def _first_table(run: LimitsRun) -> Table:
    rows = []
    for rig, is_warmed in dict.fromkeys((one.rig, one.is_warmed) for one in run.first_images):
        some = [one for one in run.first_images if (one.rig, one.is_warmed) == (rig, is_warmed)]
        rows.append(
            [
                f"{rig}, {'warmed up itself' if is_warmed else 'as it comes'}",
                str(len(some)),
                number(median(one.first_ms for one in some)),
                number(median(one.later_ms for one in some)),
                number(median(one.first_ms / one.later_ms for one in some)),
                f"{goals.FIRST_OF_LATER:g}",
            ]
        )
    return Table(
        title="First image of a fresh process, its loops compiled before: median",
        columns=["camera, process", "n", "first search ms", "later ms", "first by later", "goal"],
        rows=rows,
    )


def _empty_table(run: LimitsRun) -> Table:
    rows = [
        [
            rig,
            *(
                f"{wrong(some[name])} of {len(some[name])}" if name in some else APRILTAG_ABSENT
                for name in ("coaxial", *PEERS)
            ),
        ]
        for rig, some in run.empty.items()
    ]
    return Table(
        title="Claims in images without a marker",
        columns=["camera", "search, for three markers at once", *PEERS],
        rows=rows,
    )
