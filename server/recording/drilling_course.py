"""Course of each drilling in a recording, for the report of the operation.

A course belongs to one planned channel and one tool. Only images with displayed figures count, with their
rounded values and 95 % errors. The tool is in the bone where the clearance to the wall is defined and the tip
is not beside the pedicle. Without a pedicle it is unknown what the tool is in, and there is no course.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from math import isfinite
from typing import Any, TypeAlias

from server.number_format import finite
from tracker.navigation import Status
from tracker.navigation.clearance import WallSource
from tracker.navigation.figures import rounded_down, rounded_up
from tracker.plan.screw import GertzbeinRobbins, grade_of_breach

# Figures of an image in the report.
REPORTED = ("entry", "angle", "depth", "wall")
# Longer intervals between two images count as time without figures.
MAX_GAP_S = 0.5
IN_BONE = frozenset({Status.WITHIN, Status.OVER, Status.THROUGH})

Json: TypeAlias = Any


@dataclass(frozen=True, slots=True, kw_only=True)
class RecordedFigure:
    """A figure as it was displayed, in mm or deg; None where unknown or undefined.

    Attributes:
        value: Rounded value.
        error_95: Half width of its 95 % interval, rounded up.
    """

    value: float | None
    error_95: float | None


@dataclass(frozen=True, slots=True, kw_only=True)
class DrillingInstant:
    """Figures of one image.

    Attributes:
        at_s: Time since the first image of the recording.
        entry, angle, depth, wall: Its figures.
    """

    at_s: float
    entry: RecordedFigure
    angle: RecordedFigure
    depth: RecordedFigure
    wall: RecordedFigure


@dataclass(frozen=True, slots=True, kw_only=True)
class DrillingCourse:
    """Drilling of one channel with one tool.

    Attributes:
        channel: Name of the channel.
        tool: Name of the tool.
        images: Number of images with figures of the tool in the bone.
        from_s, to_s: First and last of them, since the first image of the recording.
        at_entry: First image with figures after the tool last entered the bone before the deepest image.
        deepest: Image with the maximum depth of the tip.
        nearest: Image with the minimum clearance; of equal ones that with the larger error.
        against: Wall to which the clearance of `nearest` was measured; None if the recording lacks it.
        grade: Gertzbein-Robbins grade of that clearance; None without a wall of bone.
        worst_grade: Grade at the lower limit of its 95 % interval; None where this is unknown.
        missing_s: Time without figures while the tool was, or may have been, in the bone: from the image with
            figures before it to the next one.
        longest_missing_s: The longest of these periods.
    """

    channel: str
    tool: str
    images: int
    from_s: float
    to_s: float
    at_entry: DrillingInstant
    deepest: DrillingInstant
    nearest: DrillingInstant
    against: WallSource | None
    grade: GertzbeinRobbins | None
    worst_grade: GertzbeinRobbins | None
    missing_s: float
    longest_missing_s: float


class DrillingCourses:
    """Collects the courses from the results of all images, in the order of their capture."""

    def __init__(self) -> None:
        self._courses: dict[tuple[str, str], _Course] = {}
        self._channel = ""
        self._begin_s: float | None = None

    def add(self, unix_s: float, snapshot: Json) -> None:
        """Add the results of an image: its Unix time and the content of its `SnapshotMessage`."""
        begin_s = self._begin_s = unix_s if self._begin_s is None else self._begin_s
        channel, geometry = snapshot.get("channel"), ""
        if isinstance(channel, Mapping):
            # A channel that was moved is another one, although its name is the same.
            geometry = repr([channel.get(f"{end}_in_vertebra_mm") for end in ("entry", "target")])
        if geometry != self._channel:
            self._end_periods()
            self._channel = geometry
        if not geometry:
            return
        name = str(snapshot.get("channel_name") or "")
        for tool in snapshot["tools"]:
            key = name + geometry, str(tool["name"])
            course = self._courses.setdefault(key, _Course(channel=name, tool=str(tool["name"])))
            course.add(unix_s - begin_s, tool.get("assessment", {}))

    def courses(self) -> tuple[DrillingCourse, ...]:
        """Return the courses of all tools that were in the bone, in the order of their first image."""
        self._end_periods()
        found = [one for course in self._courses.values() for one in course.result()]
        return tuple(sorted(found, key=lambda one: one.from_s))

    def _end_periods(self) -> None:
        for course in self._courses.values():
            course.end_period()


@dataclass(slots=True)
class _Course:
    channel: str
    tool: str
    images: int = 0
    from_s: float = 0.0
    to_s: float = 0.0
    # First image since the tool entered the bone.
    entered: DrillingInstant | None = None
    at_entry: DrillingInstant | None = None
    deepest: DrillingInstant | None = None
    nearest: DrillingInstant | None = None
    against: WallSource | None = None
    missing: list[float] = field(default_factory=list)
    # Of the present period with this channel.
    first_s: float | None = None
    last_s: float = 0.0
    live_s: float | None = None
    was_in_bone: bool = False
    has_missing: bool = False

    def add(self, at_s: float, assessment: Json) -> None:
        self.first_s = at_s if self.first_s is None else self.first_s
        self.last_s = at_s
        try:
            figures = assessment["figures"]
            instant = DrillingInstant(at_s=at_s, **{name: _figure(figures[name]) for name in REPORTED})
            is_in_bone = figures["wall"]["status"] in IN_BONE and figures["to_go"]["status"] != Status.OUTSIDE
        except (LookupError, TypeError):
            # Absent, damaged, or of a version with other figures.
            self.has_missing = True
            return
        self._add_missing(at_s, is_in_bone=is_in_bone)
        if is_in_bone:
            self._add_figures(instant, assessment.get("against"))
        else:
            self.entered = None
        self.live_s, self.was_in_bone, self.has_missing = at_s, is_in_bone, False

    def end_period(self) -> None:
        """End the present period: another channel was chosen, or the recording ends."""
        if self.was_in_bone and self.has_missing and self.live_s is not None:
            self.missing.append(self.last_s - self.live_s)
        self.first_s = self.live_s = None
        self.was_in_bone = self.has_missing = False

    def result(self) -> Iterator[DrillingCourse]:
        """Yield the course, unless the tool was never in the bone."""
        at_entry, deepest, nearest = self.at_entry, self.deepest, self.nearest
        if at_entry is None or deepest is None or nearest is None:
            return
        grade, worst_grade = _grades(nearest.wall, self.against)
        yield DrillingCourse(
            channel=self.channel,
            tool=self.tool,
            images=self.images,
            from_s=self.from_s,
            to_s=self.to_s,
            at_entry=at_entry,
            deepest=deepest,
            nearest=nearest,
            against=self.against,
            grade=grade,
            worst_grade=worst_grade,
            missing_s=_duration_s(sum(self.missing)),
            longest_missing_s=_duration_s(max(self.missing, default=0.0)),
        )

    def _add_missing(self, at_s: float, *, is_in_bone: bool) -> None:
        if not (is_in_bone or self.was_in_bone):
            return
        before_s = self.live_s
        if before_s is None:
            # The tool may have entered the bone at any time since the channel was chosen.
            before_s = self.first_s if self.has_missing and self.first_s is not None else at_s
        if self.has_missing or at_s - before_s > MAX_GAP_S:
            self.missing.append(at_s - before_s)

    def _add_figures(self, instant: DrillingInstant, against: str | None) -> None:
        if not self.images:
            self.from_s = instant.at_s
        self.images, self.to_s = self.images + 1, instant.at_s
        self.entered = self.entered or instant
        if self.deepest is None or _depth_mm(instant) > _depth_mm(self.deepest):
            self.deepest, self.at_entry = instant, self.entered
        if self.nearest is None or _clearance(instant) < _clearance(self.nearest):
            self.nearest = instant
            self.against = next((one for one in WallSource if one == against), None)


def _duration_s(duration_s: float) -> float:
    """Return a duration rounded up to 0.1 s; a float resolves Unix time to a quarter of a microsecond."""
    return rounded_up(round(duration_s, 5))


def _figure(figure: Json) -> RecordedFigure:
    return RecordedFigure(value=_number(figure["value"]), error_95=_number(figure["error_95"]))


def _number(value: object) -> float | None:
    return finite(float(value)) if isinstance(value, int | float) else None


def _depth_mm(instant: DrillingInstant) -> float:
    return -float("inf") if instant.depth.value is None else instant.depth.value


def _clearance(instant: DrillingInstant) -> tuple[float, float]:
    """Return the sort key of the clearance: smaller first, then the larger or unknown error."""
    value, error_95 = instant.wall.value, instant.wall.error_95
    return (
        float("inf") if value is None else value,
        -float("inf") if error_95 is None else -error_95,
    )


def _grades(
    wall: RecordedFigure, against: WallSource | None
) -> tuple[GertzbeinRobbins | None, GertzbeinRobbins | None]:
    """Return the grade of the displayed clearance, and at the lower limit of its 95 % interval."""
    # The planned cylinder is not bone; a breach of it has no grade.
    if against not in (WallSource.BONE, WallSource.PEDICLE) or wall.value is None:
        return None, None
    grade = grade_of_breach(-wall.value)
    if wall.error_95 is None or not isfinite(wall.error_95):
        return grade, None
    return grade, grade_of_breach(-rounded_down(wall.value - wall.error_95, decimals=2))
