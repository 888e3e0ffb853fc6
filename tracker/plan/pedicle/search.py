"""Search for the bar of bone at a click: a coarse centre line from sections in all plausible directions."""

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt
import scipy

from tracker.geometry import Array
from tracker.plan.pedicle.course import Course
from tracker.plan.pedicle.neighbourhood import Neighbourhood
from tracker.plan.pedicle.outlines import Outlines, outlines_of, planes_across

TRANSVERSE_DEG = np.arange(-24.0, 49.0, 12.0)
SAGITTAL_DEG = np.arange(-36.0, 37.0, 12.0)
# Search distances: first at the click, then further away.
ALONG_MM = ((0.0,), (-3.5, 3.5), (-7.0, 7.0))
# Deviation from the expected direction without penalty, and the sd of the penalty beyond.
USUAL_DEG, UNUSUAL_SD_DEG = 12.0, 20.0
ASIDE_MM = (-3.0, -1.5, 0.0, 1.5, 3.0)
MIN_MM2 = 12.0
MIN_FOUND, MIN_FOUND_ALONG = 0.8, 0.72
SHORT_MM, MIN_END_MM = 5.0, 2.0
MAX_GAP_DEG = 75.0
WALK_MM, WALK_STEP_MM = 16.0, 1.0
# A section larger than the narrowest one by this factor belongs to body or arch.
GROWN = 1.4
GROWTH_SD = 0.3
COLLAPSED, OPENED = 0.65, 2.2
MAX_BESIDE_MM = (-2.0, 0.0, 2.0)
# Sd of a section's centre about the axis, and of the first direction.
CENTRE_SD_MM, FIRST_SD_DEG = 0.4, 6.0
# A rotated line changes the sections; damping by this share makes the iteration converge.
TURN_SHARE = 0.6
MAX_ROUNDS = 8


@dataclass(frozen=True, slots=True, kw_only=True)
class Start:
    """Start of the tracing along a bar: section centre, area, current and first axis."""

    centre_mm: Array
    axis: Array
    first_axis: Array
    area_mm2: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Bar:
    """A bar of bone around a straight line, between its openings into body and arch.

    Attributes:
        centre_mm: (3,), middle of its narrowest part.
        axis: unit (3,), forwards.
        area_mm2: of the narrowest section.
        behind_mm: how far it reaches back from the centre.
        ahead_mm: how far it reaches forwards.
        opens_ahead: whether it opens into something larger in front.
        opens_behind: whether it opens into something larger behind.
        sections: outlines along it, at `along_mm` from the centre.
        along_mm: (n,).
    """

    centre_mm: Array
    axis: Array
    area_mm2: float
    behind_mm: float
    ahead_mm: float
    opens_ahead: bool
    opens_behind: bool
    sections: Outlines
    along_mm: Array

    @property
    def length_mm(self) -> float:
        """Return the distance between the openings behind and in front."""
        return self.behind_mm + self.ahead_mm

    @property
    def is_clear(self) -> bool:
        """Return whether the bar opens at both ends, with some length between them."""
        return (
            self.opens_ahead
            and self.opens_behind
            and self.length_mm >= SHORT_MM
            and min(self.behind_mm, self.ahead_mm) >= MIN_END_MM
        )

    def contains(self, point_mm: Array) -> bool:
        """Return whether a point lies inside the outlines, or less than half a millimetre outside."""
        along = float((point_mm - self.centre_mm) @ self.axis)
        row = int(np.argmin(np.abs(self.along_mm - along)))
        one = self.sections.only(row)
        return bool(_around(one, point_mm, self.axis[None])[0]) and abs(along - self.along_mm[row]) < 1.0


def forward_directions(side: str) -> Array:
    """Return the unit directions (n, 3) that a pedicle of this side can have, forwards."""
    mirror = 1.0 if side == "left" else -1.0
    transverse, sagittal = np.meshgrid(np.radians(TRANSVERSE_DEG), np.radians(SAGITTAL_DEG), indexing="ij")
    ways = np.stack([-mirror * np.tan(transverse), -np.ones_like(transverse), np.tan(sagittal)], axis=-1)
    flat = ways.reshape(-1, 3)
    return np.asarray(flat / np.linalg.norm(flat, axis=1, keepdims=True))


def find_bar(near: Neighbourhood, seed_mm: Array, side: str, course: Course) -> Bar | None:
    """Return the bar of bone around a click, or None if no section around it is closed.

    The section through the click comes first. Sections before and behind it are tried if its bar does not
    open at both ends, as for a click near the body.
    """
    bars: list[Bar] = []
    for some_mm in ALONG_MM:
        start = _best_start(near, seed_mm, side, some_mm, course)
        bar = None if start is None else _settled(near, start)
        if bar is None:
            continue
        if bar.is_clear and bar.contains(seed_mm):
            return bar
        bars.append(bar)
    return max(bars, key=lambda bar: (bar.contains(seed_mm), bar.length_mm)) if bars else None


def bar_along(near: Neighbourhood, bar: Bar, centre_mm: Array, axis: Array) -> Bar:
    """Return the bar with sections across a fixed axis; unchanged if no section is closed."""
    start = Start(centre_mm=centre_mm, axis=axis, first_axis=axis, area_mm2=bar.area_mm2)
    walked = _walk(near, start)
    if walked is None:
        return bar
    return replace(walked, axis=axis)


def _settled(near: Neighbourhood, first: Start) -> Bar | None:
    """Return the bar with its line refitted until convergence."""
    bar, start = None, first
    for _ in range(MAX_ROUNDS):
        bar = _walk(near, start)
        if bar is None:
            return None
        moved = float(np.linalg.norm(bar.centre_mm - start.centre_mm))
        turned = float(np.degrees(np.arccos(np.clip(bar.axis @ start.axis, -1.0, 1.0))))
        start = Start(centre_mm=bar.centre_mm, axis=bar.axis, first_axis=first.axis, area_mm2=bar.area_mm2)
        if moved < 0.15 and turned < 0.3:
            break
    return bar


def _best_start(
    near: Neighbourhood, seed_mm: Array, side: str, some_mm: tuple[float, ...], course: Course
) -> Start | None:
    """Return centre and direction of the smallest closed section at the click; of nested ones the outer."""
    directions = forward_directions(side)
    grid = (len(TRANSVERSE_DEG), len(SAGITTAL_DEG))
    away = np.linalg.norm(course.off_deg(directions, side), axis=1)
    unusual = 0.5 * (np.maximum(away - USUAL_DEG, 0.0) / UNUSUAL_SD_DEG) ** 2
    best: tuple[float, Start] | None = None
    for along_mm in some_mm:
        areas, centres = _largest_around(near, seed_mm, directions, along_mm)
        # An outline much smaller than that of most directions is a part of a wall.
        usual = float(np.nanmedian(areas)) if np.isfinite(areas).any() else 0.0
        known = np.where(np.isfinite(areas) & (areas >= 0.4 * usual), areas, 1e6)
        # The area is a smooth function of direction; an outlier has closed around another structure.
        steady = scipy.ndimage.median_filter(known.reshape(grid), size=3, mode="nearest").ravel()
        score = np.log(steady) + unusual + 0.03 * abs(along_mm)
        score = np.where(np.abs(np.log(known / steady)) < 0.25, score, np.inf)
        way = int(np.argmin(score))
        if known[way] < 1e6 and np.isfinite(score[way]) and (best is None or score[way] < best[0]):
            axis = directions[way]
            found = Start(centre_mm=centres[way], axis=axis, first_axis=axis, area_mm2=float(known[way]))
            best = (float(score[way]), found)
    return None if best is None else best[1]


def _largest_around(
    near: Neighbourhood, seed_mm: Array, directions: Array, along_mm: float
) -> tuple[Array, Array]:
    """Return for each direction (n, 3) the largest closed outline at the click: area (n,), NaN, and centre.

    A start inside a wall closes around a piece of that wall; a start between the walls around both.
    """
    across, up = planes_across(directions)
    offsets = [(x, y) for x in ASIDE_MM for y in ASIDE_MM]
    starts = [seed_mm + along_mm * directions + x * across + y * up for x, y in offsets]
    axis = np.tile(directions, (len(offsets), 1))
    cut = outlines_of(near, np.concatenate(starts), axis, rays=20)
    closed = (cut.found_ratio >= MIN_FOUND) & _around(cut, seed_mm, axis) & (cut.area_mm2 >= MIN_MM2)
    area = np.where(closed, cut.area_mm2, -1.0).reshape(len(offsets), -1)
    best = np.argmax(area, axis=0)
    way = np.arange(len(directions))
    largest = area[best, way]
    centres = cut.centroid_mm.reshape(len(offsets), -1, 3)[best, way]
    return np.where(largest > 0.0, largest, np.nan), centres


def _around(cut: Outlines, seed_mm: Array, axis: Array) -> npt.NDArray[np.bool_]:
    """Return which outlines (m,) contain the click, projected along their axis."""
    away = seed_mm - cut.centre_mm
    away = away - (away * axis).sum(axis=1, keepdims=True) * axis
    x, y = (away * cut.across).sum(axis=1), (away * cut.up).sum(axis=1)
    rays = cut.smooth_mm.shape[1]
    ray = np.round(np.arctan2(y, x) / (2.0 * np.pi) * rays).astype(int) % rays
    wall = np.take_along_axis(cut.smooth_mm, ray[:, None], axis=1)[:, 0]
    return np.asarray(np.hypot(x, y) <= wall + 0.5)


def _walk(near: Neighbourhood, start: Start) -> Bar | None:
    """Trace sections along the line, each started at the previous centre, and fit the line through them.

    The area changes slowly from section to section; a sudden collapse means an outline around a piece of a
    wall, and the section is searched again from shifted starts.
    """
    first = _section(near, start.centre_mm, start.axis, start.area_mm2)
    if not _is_closed(first):
        return None
    rows = {0: first}
    for way in (1, -1):
        at, area = first.centroid_mm[0], float(first.area_mm2[0])
        minimum, missed = area, 0
        for n in range(1, int(WALK_MM / WALK_STEP_MM) + 1):
            at = at + way * WALK_STEP_MM * start.axis
            cut = _section(near, at, start.axis, area)
            rows[way * n] = cut
            if _is_closed(cut) and float(cut.area_mm2[0]) > COLLAPSED * area:
                at, area, missed = cut.centroid_mm[0], float(cut.area_mm2[0]), 0
                minimum = min(minimum, area)
            else:
                missed += 1
            if missed == 2 or area > OPENED * minimum:
                break
    order = sorted(rows)
    return _line(_stacked([rows[n] for n in order]), np.array(order) * WALK_STEP_MM, start)


def _is_closed(cut: Outlines) -> bool:
    return bool(cut.found_ratio[0] >= MIN_FOUND_ALONG and cut.gap_deg[0] <= MAX_GAP_DEG)


def _section(near: Neighbourhood, at: Array, axis: Array, like_mm2: float) -> Outlines:
    """Return the section there; if it collapses, the most similar one from shifted starts."""
    cut = outlines_of(near, at[None], axis[None], rays=40, recentred=1)
    if _is_closed(cut) and cut.area_mm2[0] > COLLAPSED * like_mm2:
        return cut
    (across,), (up,) = planes_across(axis[None])
    starts = np.array([at + x * across + y * up for x in MAX_BESIDE_MM for y in MAX_BESIDE_MM])
    cuts = outlines_of(near, starts, np.tile(axis, (len(starts), 1)), rays=40, recentred=2)
    closed = (cuts.found_ratio >= MIN_FOUND_ALONG) & (cuts.gap_deg <= MAX_GAP_DEG)
    # A section whose centre moved away belongs to another bone.
    near_by = np.linalg.norm(cuts.centroid_mm - at, axis=1) < 3.5
    unlike = np.where(closed & near_by, np.abs(np.log(cuts.area_mm2 / like_mm2)), np.inf)
    row = int(np.argmin(unlike))
    return cuts.only(row) if np.isfinite(unlike[row]) else cut


def _line(sections: Outlines, along: Array, start: Start) -> Bar | None:
    closed = (sections.found_ratio >= MIN_FOUND_ALONG) & (sections.gap_deg <= MAX_GAP_DEG)
    area = np.where(
        closed & (sections.area_mm2 > COLLAPSED * start.area_mm2 * 0.6), sections.area_mm2, np.inf
    )
    if not np.isfinite(area).any():
        return None
    # The local minimum of the area, descending from the start.
    lowest = _downhill(_running_median(area), int(np.argmin(np.abs(along))))
    if not np.isfinite(area[lowest]):
        lowest = int(np.argmin(area))
    minimum = float(area[max(lowest - 1, 0) : lowest + 2].min())
    within = area <= GROWN * minimum
    first, last = lowest, lowest
    while first > 0 and within[first - 1]:
        first -= 1
    while last < len(area) - 1 and within[last + 1]:
        last += 1
    reach = slice(max(first - 2, 0), last + 3)
    weight = np.exp(-(np.maximum(area[reach] / minimum - 1.0, 0.0) ** 2) / (2.0 * GROWTH_SD**2))
    at, turned = _line_through(sections.centroid_mm[reach], weight, along[lowest], start, along[reach])
    half = 0.5 * WALK_STEP_MM
    return Bar(
        centre_mm=at,
        axis=turned,
        area_mm2=minimum,
        behind_mm=float(along[lowest] - along[first] + half),
        ahead_mm=float(along[last] - along[lowest] + half),
        opens_ahead=last < len(area) - 1,
        opens_behind=first > 0,
        sections=sections,
        along_mm=along - along[lowest],
    )


def _line_through(
    points: Array, weight: Array, lowest: float, start: Start, along: Array
) -> tuple[Array, Array]:
    """Fit a line to centres (n, 3); the first direction is a prior for few centres."""
    axis = start.axis
    mean = (weight[:, None] * points).sum(axis=0) / weight.sum()
    from_mean = (points - mean) @ axis
    across = points - mean - from_mean[:, None] * axis
    wanted = start.first_axis / (start.first_axis @ axis) - axis
    hold = (CENTRE_SD_MM / np.tan(np.radians(FIRST_SD_DEG))) ** 2
    pull = (weight * from_mean**2).sum() + hold
    slope = ((weight * from_mean)[:, None] * across).sum(axis=0) / pull + wanted * (hold / pull)
    turned = axis + TURN_SHARE * slope
    row = int(np.argmin(np.abs(along - lowest)))
    return mean + turned * from_mean[row], turned / np.linalg.norm(turned)


def _running_median(area: Array) -> Array:
    padded = np.concatenate([area[:1], area, area[-1:]])
    return np.asarray(np.median(np.stack([padded[:-2], padded[1:-1], padded[2:]]), axis=0))


def _downhill(area: Array, start: int) -> int:
    finite = np.flatnonzero(np.isfinite(area))
    at = int(finite[np.argmin(np.abs(finite - start))]) if len(finite) else start
    while True:
        beside = [n for n in (at - 2, at - 1, at + 1, at + 2) if 0 <= n < len(area)]
        best = min(beside, key=lambda n: area[n])
        if area[best] >= area[at]:
            return at
        at = best


def _stacked(cuts: list[Outlines]) -> Outlines:
    return Outlines(
        centre_mm=np.concatenate([cut.centre_mm for cut in cuts]),
        across=np.concatenate([cut.across for cut in cuts]),
        up=np.concatenate([cut.up for cut in cuts]),
        radius_mm=np.concatenate([cut.radius_mm for cut in cuts]),
        smooth_mm=np.concatenate([cut.smooth_mm for cut in cuts]),
        found_ratio=np.concatenate([cut.found_ratio for cut in cuts]),
        gap_deg=np.concatenate([cut.gap_deg for cut in cuts]),
    )
