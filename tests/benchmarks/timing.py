"""Tables of times: each stage by its name in the code, and against OpenCV's own detection."""

from collections.abc import Iterable, Mapping, Sequence

from tests.benchmarks.offline import TimedImage
from tests.benchmarks.tables import Table, median, number, pair

STAGES = ("grey", "gradient", "candidates", "fit", "score", "judgement")


def stage_table(title: str, timed: Sequence[TimedImage]) -> Table:
    """Table of stage times: of a tracking step, and of a search in the whole image."""
    steps = [one for one in timed if one.tracked]
    columns = [
        ([one.step_stage_ms for one in steps], [one.step_ms for one in steps]),
        ([one.search_stage_ms for one in timed], [one.search_ms for one in timed]),
    ]
    rows = [
        [stage, *(pair(_of_stage(stage, stages), 99.0) for stages, _ in columns)]
        for stage in _names(stages for stages, _ in columns)
    ]
    rows.append(["**all**", *(pair(whole, 99.0) for _, whole in columns)])
    return Table(
        title=title, columns=["stage", "step that tracked, ms", "search of the whole image, ms"], rows=rows
    )


def ratio_table(title: str, timed: Sequence[TimedImage]) -> Table:
    """Table of times against `cv2.aruco` with its defaults, on the same images."""
    aruco = median(one.aruco_ms for one in timed)
    rows = [
        [name, pair(values, 99.0), number(median(values) / aruco)]
        for name, values in (
            ("step that tracked", [one.step_ms for one in timed if one.tracked]),
            ("step, all images", [one.step_ms for one in timed]),
            ("search of the whole image", [one.search_ms for one in timed]),
            ("cv2.aruco, defaults", [one.aruco_ms for one in timed]),
        )
    ]
    return Table(title=title, columns=["", "ms", "of cv2.aruco's median"], rows=rows)


def _names(lists: Iterable[Sequence[Mapping[str, float]]]) -> list[str]:
    """Return the stages that occurred, in pipeline order."""
    present = {name for stages in lists for one in stages for name in one}
    return [*(name for name in STAGES if name in present), *sorted(present - set(STAGES))]


def _of_stage(stage: str, stages: Sequence[Mapping[str, float]]) -> list[float]:
    return [one[stage] for one in stages if stage in one]
