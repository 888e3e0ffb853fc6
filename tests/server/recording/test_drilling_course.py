"""The course of a drilling: which images count, and the time without figures."""

from pathlib import Path
from typing import Any

import pytest

from server.recording.drilling_course import DrillingCourse, DrillingCourses
from server.recording.timeline import make_index, store_index, stored_summary
from server.recording_file import RecordingReader, Topic
from tests.server.recording.reviewed import write_drilling

HIDDEN = "hidden"
PERIOD_S = 0.1


def image(
    where: tuple[float, ...] | str, *, channel: str = "L4 left", against: str = "bone"
) -> dict[str, Any]:
    """Return results of an image: depth, clearance and its error; "hidden" for absent figures."""
    assessment: dict[str, Any] = {"kind": "absent", "reason": "MARKER_UNSEEN"}
    if not isinstance(where, str):
        depth, wall, error, *_ = (*where, 0.2)
        inside = "outside" if depth < 0.0 else "within"
        figure = {"value": 0.5, "error_95": 0.3, "status": "within"}
        figures = {
            "entry": figure,
            "angle": figure,
            "depth": {**figure, "value": depth},
            "to_go": figure,
            "wall": {"value": None if depth < 0.0 else wall, "error_95": error, "status": inside},
        }
        assessment = {"kind": "assessment", "figures": figures, "against": against}
    ends = {"entry_in_vertebra_mm": [0.0, 0.0, 0.0], "target_in_vertebra_mm": [0.0, float(len(channel)), 0.0]}
    return {"channel_name": channel, "channel": ends, "tools": [{"name": "drill", "assessment": assessment}]}


def course(*places: tuple[float, ...] | str, period_s: float = PERIOD_S) -> DrillingCourse:
    courses = DrillingCourses()
    for number, where in enumerate(places):
        courses.add(1.7e9 + number * period_s, image(where))
    (found,) = courses.courses()
    return found


OUT, IN = (-5.0, 0.0), (10.0, 2.0)


@pytest.mark.parametrize(
    ("places", "missing_s", "longest_s"),
    [
        ((OUT, IN, IN, OUT), 0.0, 0.0),
        ((OUT, IN, HIDDEN, HIDDEN, IN, HIDDEN, IN), 0.5, 0.3),
        # Before the first and after the last figures it may have been in the bone.
        ((HIDDEN, HIDDEN, IN, OUT), 0.2, 0.2),
        ((OUT, IN, HIDDEN, HIDDEN), 0.2, 0.2),
        ((OUT, HIDDEN, HIDDEN, OUT, IN, OUT, HIDDEN), 0.0, 0.0),
    ],
    ids=["never", "twice", "while entering", "until the end", "only outside"],
)
def test_time_without_figures_counts_from_the_last_figures_to_the_next(
    places: tuple[Any, ...], missing_s: float, longest_s: float
) -> None:
    found = course(*places)
    assert (found.missing_s, found.longest_missing_s) == (missing_s, longest_s)


def test_a_gap_without_images_is_time_without_figures() -> None:
    assert course(IN, IN, period_s=0.4).missing_s == 0.0
    assert course(IN, IN, period_s=0.7).missing_s == 0.7


def test_the_entry_is_that_of_the_deepest_attempt_and_the_clearance_that_of_all() -> None:
    found = course(OUT, (1.0, 0.4), OUT, (2.0, 3.0), (20.0, 1.5), (15.0, 1.0), OUT, (3.0, 2.0))
    assert (found.at_entry.depth.value, found.deepest.depth.value) == (2.0, 20.0)
    assert (found.nearest.wall.value, found.nearest.depth.value) == (0.4, 1.0)
    assert found.images == 5
    assert [found.from_s, found.to_s] == pytest.approx([0.1, 0.7])


@pytest.mark.parametrize(
    ("wall", "error", "grade", "worst"),
    [
        (0.3, 0.2, "A", "A"),
        (0.1, 0.2, "A", "B"),
        (-0.1, 1.8, "B", "B"),
        (-0.1, 1.9, "B", "C"),
        (-2.0, 0.1, "C", "C"),
        (0.3, None, "A", None),
    ],
)
def test_grades_come_from_the_displayed_clearance_and_its_interval(
    wall: float, error: float, grade: str, worst: str
) -> None:
    found = course((10.0, wall, error))
    assert (found.grade, found.worst_grade) == (grade, worst)


def test_of_equal_clearances_the_less_certain_one_is_reported() -> None:
    assert course((10.0, 0.5, 0.1), (11.0, 0.5, 0.9), (12.0, 0.5, 0.2)).nearest.wall.error_95 == 0.9


def test_a_breach_of_the_planned_cylinder_has_no_grade() -> None:
    courses = DrillingCourses()
    courses.add(0.0, image((10.0, -3.0), against="channel"))
    (found,) = courses.courses()
    assert (found.against, found.grade, found.worst_grade) == ("channel", None, None)


def test_another_channel_ends_the_time_without_figures_of_the_first() -> None:
    courses = DrillingCourses()
    places: list[tuple[float, ...] | str] = [IN, HIDDEN, IN, HIDDEN, IN]
    for number, where in enumerate(places):
        courses.add(number * PERIOD_S, image(where, channel="L4 right" if number in (2, 3) else "L4 left"))
    assert [(one.channel, one.missing_s) for one in courses.courses()] == [
        ("L4 left", 0.1),
        ("L4 right", 0.1),
    ]


def test_results_of_another_version_are_absent() -> None:
    older = image(IN)
    del older["tools"][0]["assessment"]["figures"]["to_go"]
    courses = DrillingCourses()
    courses.add(0.0, older)
    assert courses.courses() == ()


def test_the_course_of_a_recording_has_its_recorded_figures(tmp_path: Path) -> None:
    modes = (
        ("path",) * 4 + ("hidden",) * 4 + ("near",) * 3 + ("breach",) * 3 + ("path",) * 2 + ("hidden",) * 2
    )
    path = write_drilling(tmp_path / "case.mcap", modes)
    (found,) = make_index(path).courses
    figures = [
        one.json()["tools"][0]["assessment"]["figures"]
        for one, mode in zip(_snapshots(path), modes, strict=True)
        if mode != "hidden"
    ]
    worst = min(figures, key=lambda one: float(one["wall"]["value"]))
    assert found.nearest.wall.value == worst["wall"]["value"] < 0.0
    assert found.nearest.wall.error_95 == worst["wall"]["error_95"]
    assert found.deepest.depth.value == max(one["depth"]["value"] for one in figures)
    assert (found.channel, found.tool, found.images, found.grade) == ("L3 left", "drill", 12, "B")
    # 0.3 s to 0.8 s, and 1.5 s to the end.
    assert (found.missing_s, found.longest_missing_s) == (0.7, 0.5)
    store_index(lambda _ratio, _doing: None, recording=str(path))
    summary = stored_summary(path)
    assert summary is not None
    assert summary.courses == (found,)


def _snapshots(path: Path) -> list[Any]:
    return [one for one in RecordingReader(path).messages() if one.topic is Topic.SNAPSHOT]
