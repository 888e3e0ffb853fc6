"""Figures of a run for comparison with the next one."""

from collections.abc import Iterator, Sequence

from tests.benchmarks.figures import Figure, Share, size_of
from tests.benchmarks.limits.condition_tables import errors, right, stated, wrong
from tests.benchmarks.limits.conditions_run import DISTURBED_IMAGES
from tests.benchmarks.limits.evaluation import COVERED, Evaluation
from tests.benchmarks.limits.pace_tables import RETURNED_WITHIN, ratios
from tests.benchmarks.limits.run import LimitsRun

# A tracker that is lost, or on the wrong solution, stays so for some images.
LOST_IN_A_ROW = 10


def limit_figures(run: LimitsRun) -> dict[str, Figure]:
    """Return each figure by its name; unmeasured ones are omitted."""
    named = [*_of_conditions(run), *_of_hands(run), *_of_paces(run), *_of_returns(run), *_of_empty(run)]
    return {name: figure for name, figure in named if figure is not None}


Named = tuple[str, Figure | None]


def _of_conditions(run: LimitsRun) -> Iterator[Named]:
    for rig, some in run.conditions.items():
        for one in some:
            name = f"{rig} {one.condition}"
            yield f"{name}, found by search", Share(count=right(one.searched), of=len(one.searched))
            if one.stepped:
                retained = Share(count=right(one.stepped), of=len(one.stepped), in_a_row=DISTURBED_IMAGES)
                yield f"{name}, tracked by step", retained
            yield from _claims(f"{name} by search", one.searched)
            yield from _claims(f"{name} by step", one.stepped, DISTURBED_IMAGES)
            yield f"{name}, tip mm, median", size_of(errors(one.searched, "tip_mm"))
            yield f"{name}, tip by bound, median", size_of(one.of_bound)
            yield f"{name}, tip mm by step, median", size_of(errors(one.stepped, "tip_mm"))
        for way, in_a_row, all_of in (
            ("search", 1, [each for one in some for each in one.searched]),
            ("step", DISTURBED_IMAGES, [each for one in some for each in one.stepped]),
        ):
            yield from _coverage(f"{rig} all, {way}", all_of, in_a_row)


def _claims(name: str, judgements: Sequence[Evaluation], in_a_row: int = 1) -> Iterator[Named]:
    count = len(judgements)
    if not count:
        return
    yield f"{name}, wrong", Share(count=wrong(judgements), of=count, is_good=False, is_strict=True)
    mirrored = sum(one.is_mirrored for one in judgements)
    yield f"{name}, mirrored", Share(count=mirrored, of=count, is_good=False, in_a_row=in_a_row)


def _coverage(name: str, judgements: Sequence[Evaluation], in_a_row: int) -> Iterator[Named]:
    """Only low coverage counts as worse: an overestimated covariance misleads nobody."""
    some = stated(judgements)
    for number, what in enumerate(COVERED):
        inside = sum(one.covered[number] for one in some)
        share = Share(count=inside, of=len(some), in_a_row=in_a_row) if some else None
        yield f"{name}, {what} inside 95 %", share


def _of_hands(run: LimitsRun) -> Iterator[Named]:
    for one in run.hands:
        name = f"{one.rig} hand {one.speed}"
        found = Share(count=right(one.stepped), of=len(one.stepped), in_a_row=LOST_IN_A_ROW)
        yield f"{name}, found by step", found
        yield from _claims(name, one.stepped, LOST_IN_A_ROW)
        yield f"{name}, tip mm, median", size_of(errors(one.stepped, "tip_mm"))
        yield f"{name}, tip mm, p95", size_of(errors(one.stepped, "tip_mm"), 95.0)
        yield f"{name}, step by cv2.aruco, median", size_of(one.ratios, is_time=True)


def _of_paces(run: LimitsRun) -> Iterator[Named]:
    for one in run.paces:
        width, height = one.rig.size_wh_px
        name = f"{width}x{height}, {one.known} known, {one.in_view} in view"
        search = ratios(one.search_ms, one.peers_ms["cv2.aruco"])
        step = ratios(one.step_ms, one.by_step_ms)
        for way, taken in (("search", search), ("step", step)):
            yield f"{name}, {way} by cv2.aruco, median", size_of(taken, is_time=True)
            yield f"{name}, {way} by cv2.aruco, p99", size_of(taken, 99.0, is_time=True)
    for rig, is_warmed in dict.fromkeys((one.rig, one.is_warmed) for one in run.first_images):
        some = [one for one in run.first_images if (one.rig, one.is_warmed) == (rig, is_warmed)]
        state = "warmed up itself" if is_warmed else "as it comes"
        by_later = [one.first_ms / one.later_ms for one in some]
        yield f"{rig} first image, {state}, by later", size_of(by_later, is_time=True)


def _of_returns(run: LimitsRun) -> Iterator[Named]:
    for one in run.returns:
        name = f"{one.rig} {one.condition} that comes back"
        for max_images in RETURNED_WITHIN:
            count = sum(images <= max_images for images in one.images)
            yield f"{name}, found within {max_images} images", Share(count=count, of=len(one.images))
        yield (
            f"{name}, wrong",
            Share(count=wrong(one.claims), of=len(one.claims), is_good=False, is_strict=True)
            if one.claims
            else None,
        )


def _of_empty(run: LimitsRun) -> Iterator[Named]:
    for rig, some in run.empty.items():
        own = some["coaxial"]
        yield (
            f"{rig} without a marker, claims",
            Share(count=wrong(own), of=len(own), is_good=False, is_strict=True),
        )
