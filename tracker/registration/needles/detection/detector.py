"""Detect thin straight bars with a head, ranked by score."""

import dataclasses
from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
import numpy.typing as npt

from tracker.camera import CameraModel
from tracker.errors import InvalidInput
from tracker.geometry import Array
from tracker.registration.needles.detection.bars import Bar, bars, is_collinear, single_edge_bars
from tracker.registration.needles.detection.cross_sections import CrossSections, cross_sections
from tracker.registration.needles.detection.head import head_length_px
from tracker.registration.needles.observation import NeedleObservation
from tracker.registration.needles.view_prior import ViewPrior

Image8 = npt.NDArray[np.uint8]
LONGEST_PX = 400.0
# Weight of a cross section without a bar, relative to one with a bar.
MISSING_WEIGHT = 1.5
UP_PX = (0.0, -1.0)
MIN_LENGTH_IN_WIDTHS = 12.0
# Maximum saturation of metal, and maximum change of colour along a wire.
MAX_COLOUR_RATIO, MAX_SHADE_CHANGE = 0.25, 45.0
MAX_PIECES = 120
MIN_COMPLETE_RATIO = 0.7
MAX_BEND_PX = 0.6
# Lower bounds of the sd. Across: image noise alone gives a far smaller value, but uneven illumination of a
# wire shifts both edges equally. Along: another needle in front, or bright fat, may end a needle early.
MIN_ACROSS_SD_PX, ALONG_SD_PX = 0.5, 8.0
NEAR_PX, NEAR_DEG = 12.0, 12.0
SAME_PX, SAME_END_PX = 3.5, 20.0


@dataclass(frozen=True, slots=True, kw_only=True)
class WidthRange:
    """Range of the wire's width in the image, in px."""

    narrowest_px: float = 2.5
    widest_px: float = 9.0


@dataclass(frozen=True, slots=True, kw_only=True)
class DetectedNeedle:
    """A detected needle candidate.

    Attributes:
        seen: the observation; its entry into the bone is not determined.
        score_ratio: 0..1, from completeness, straightness and head.
        has_head: whether a wider head is detected at its end.
        complete_ratio: share of its length on which both sides are visible.
        bend_px: RMS deviation of its centre line from a straight line.
    """

    seen: NeedleObservation
    score_ratio: float
    has_head: bool
    complete_ratio: float
    bend_px: float


def expected_width_px(view: ViewPrior, camera: CameraModel, *, radius_mm: float = 0.8) -> WidthRange:
    """Return the width of a wire of this radius at the measured distance, with a depth margin."""
    width = 2.0 * radius_mm * float(camera.matrix[0, 0]) / view.distance_mm
    return WidthRange(narrowest_px=max(1.5, 0.65 * width), widest_px=max(4.0, 1.4 * width))


def detect_needles(
    image: npt.ArrayLike,
    camera: CameraModel,
    *,
    width: WidthRange | None = None,
    near: NeedleObservation | None = None,
    heads_to: npt.ArrayLike = UP_PX,
) -> tuple[DetectedNeedle, ...]:
    """Return all needle candidates in the image, the most likely first; empty if there are none.

    Args:
        image: (h, w, 3) BGR or (h, w) grey, uint8.
        camera: calibrated; its distortion bends a straight wire.
        width: of the wire.
        heads_to: (2,), image direction of the heads; up for a prone patient.
        near: approximate needle, as marked by a person; only candidates there are returned.

    Raises:
        InvalidInput: IMAGE_INVALID.
    """
    picture = _checked(image, camera)
    span = width or WidthRange()
    heads = np.asarray(heads_to, dtype=np.float64).reshape(2)
    grey = np.asarray(cv2.cvtColor(picture, cv2.COLOR_BGR2GRAY), dtype=np.uint8)
    pieces = bars(grey, span.narrowest_px, span.widest_px)
    likely = [bar for bar in pieces if _is_metal(picture, bar) and (near is None or _is_near(bar, near))]
    found = _grown(picture, camera, likely[:MAX_PIECES], heads)
    headed = [one for one in found if one.has_head]
    if near is None and headed:
        width_px = float(np.median([one.seen.width_px for one in headed]))
        halves = single_edge_bars(grey, width_px, [_bar_of(one) for one in headed])
        found += _grown(picture, camera, halves[:MAX_PIECES], heads, found)
    # Of two overlapping candidates the longer one is kept, because a crossing object shortens and bends a
    # detection.
    longest = sorted(found, key=lambda one: -one.score_ratio * one.seen.length_px)
    return tuple(sorted(_each_once(longest), key=lambda one: -one.score_ratio))


def _grown(
    picture: Image8,
    camera: CameraModel,
    pieces: Sequence[Bar],
    heads_to: Array,
    known: Sequence[DetectedNeedle] = (),
) -> list[DetectedNeedle]:
    """Return the needles of these pieces, except for known ones."""
    out: list[DetectedNeedle] = []
    taken = [_bar_of(one) for one in known]
    for bar in pieces:
        if any(is_collinear(one, bar.middle_px, bar.along) for one in taken):
            continue
        needle = _needle(picture, camera, bar, heads_to)
        if needle is not None:
            taken.append(_bar_of(needle))
            out.append(needle)
    return out


def _needle(picture: Image8, camera: CameraModel, bar: Bar, heads_to: Array) -> DetectedNeedle | None:
    """Return the complete needle of a piece; None if the piece is not part of a needle."""
    middle, along, width = bar.middle_px, bar.along, bar.width_px
    span = (-bar.length_px, bar.length_px)
    for _ in range(3):
        sections = cross_sections(
            picture, middle, along, width, max(span[0], -LONGEST_PX), min(span[1], LONGEST_PX)
        )
        sections = _of_one_shade(sections)
        run = _run(sections)
        if run.stop - run.start < 6:
            return None
        good = np.flatnonzero(sections.is_bar[run]) + run.start
        slope, shift = np.polyfit(sections.at_px[good], sections.off_px[good], 1)
        beside = np.array([-along[1], along[0]])
        width = float(np.median(sections.width_px[good]))
        at = 0.5 * (sections.at_px[run.start] + sections.at_px[run.stop - 1])
        middle = middle + at * along + (slope * at + shift) * beside
        along = along + slope * beside
        along /= np.linalg.norm(along)
        half = 0.5 * (run.stop - run.start)
        span = (-half - 60.0, half + 60.0)
    sections = cross_sections(
        picture, middle, along, width, max(span[0], -LONGEST_PX), min(span[1], LONGEST_PX)
    )
    return _judged(picture, camera, sections, (middle, along, width), heads_to)


def _judged(
    picture: Image8,
    camera: CameraModel,
    sections: CrossSections,
    line: tuple[Array, Array, float],
    heads_to: Array,
) -> DetectedNeedle | None:
    middle, along, width = line
    sections = _of_one_shade(sections)
    run = _run(sections)
    good = np.flatnonzero(sections.is_bar[run]) + run.start
    length = float(run.stop - run.start)
    if length < MIN_LENGTH_IN_WIDTHS * width or len(good) < MIN_COMPLETE_RATIO * length:
        return None
    beside = np.array([-along[1], along[0]])
    points = middle + sections.at_px[good, None] * along + sections.off_px[good, None] * beside
    ends, bend = _straight(camera, points)
    if bend > MAX_BEND_PX:
        return None
    if (ends[1] - ends[0]) @ heads_to < 0.0:
        ends = ends[::-1]
    has_head = head_length_px(picture, ends[1], ends[1] - ends[0], width) > 0.0
    whole = len(good) / length
    spread = float(np.std(sections.width_px[good]) / width)
    score = whole * (1.0 - bend / (2.0 * MAX_BEND_PX)) * (1.0 - min(spread, 0.5)) * (1.0 if has_head else 0.5)
    seen = NeedleObservation(
        entry_px=ends[0],
        head_px=ends[1],
        across_sd_px=max(MIN_ACROSS_SD_PX, 3.0 * bend / np.sqrt(len(good))),
        along_sd_px=ALONG_SD_PX,
        width_px=width,
    )
    return DetectedNeedle(seen=seen, score_ratio=score, has_head=has_head, complete_ratio=whole, bend_px=bend)


def _straight(camera: CameraModel, points_px: Array) -> tuple[Array, float]:
    """Fit the undistorted straight line; return its ends (2, 2) px and the RMS of the points."""
    focal = np.diag(camera.matrix)[:2]
    flat = camera.normalised_from_px(points_px) * focal
    centre = flat.mean(axis=0)
    _, _, axes = np.linalg.svd(flat - centre)
    along, off = (flat - centre) @ axes[0], (flat - centre) @ axes[1]
    ends = centre + np.array([along.min(), along.max()])[:, None] * axes[0]
    back = camera.px_from_camera(np.column_stack([ends / focal, np.ones(2)]))
    return back, float(np.sqrt(np.mean(off**2)))


def _is_metal(picture: Image8, bar: Bar) -> bool:
    """Return whether a bar is as unsaturated as metal; always True for a grey image."""
    at = np.linspace(-0.4, 0.4, 9)[:, None] * bar.length_px * bar.along + bar.middle_px
    column, row = np.rint(at).astype(int).T
    height, width = picture.shape[:2]
    colour = picture[np.clip(row, 0, height - 1), np.clip(column, 0, width - 1)].astype(np.float64)
    middle = np.median(colour, axis=0)
    return bool(np.ptp(middle) <= MAX_COLOUR_RATIO * max(float(middle.max()), 40.0))


def _of_one_shade(sections: CrossSections) -> CrossSections:
    """Mark sections as missing whose colour differs from the bar's median."""
    if not sections.is_bar.any():
        return sections
    own = np.median(sections.inside[sections.is_bar], axis=0)
    off = np.linalg.norm(sections.inside - own, axis=1) / np.sqrt(3.0)
    colour = np.ptp(sections.inside, axis=1) / np.maximum(sections.inside.max(axis=1), 40.0)
    is_same_colour = (off < MAX_SHADE_CHANGE) & (colour < 1.5 * MAX_COLOUR_RATIO)
    return dataclasses.replace(sections, is_bar=sections.is_bar & is_same_colour)


def _run(sections: CrossSections) -> slice:
    """Return the maximum-sum run of sections: present ones count positive, missing ones negative.

    It bridges another needle in front if enough is visible on both sides, and excludes what lies beyond the
    head.
    """
    weights = np.where(sections.is_bar, 1.0, -MISSING_WEIGHT)
    sums = np.concatenate([[0.0], np.cumsum(weights)])
    lowest = np.minimum.accumulate(sums)
    stop = int(np.argmax(sums - lowest))
    start = int(np.argmin(sums[: stop + 1]))
    return slice(start, stop)


def _bar_of(needle: DetectedNeedle) -> Bar:
    line = needle.seen.head_px - needle.seen.entry_px
    length = float(np.linalg.norm(line))
    return Bar(
        middle_px=0.5 * (needle.seen.head_px + needle.seen.entry_px),
        along=line / length,
        width_px=needle.seen.width_px,
        length_px=length,
    )


def _each_once(found: list[DetectedNeedle]) -> list[DetectedNeedle]:
    retained: list[DetectedNeedle] = []
    for one in found:
        bar = _bar_of(one)
        if not any(_lies_on(bar, _bar_of(other)) for other in retained):
            retained.append(one)
    return retained


def _lies_on(bar: Bar, longer: Bar) -> bool:
    """Return whether all of a bar lies on another one: it is then a piece of the same needle."""
    beside = np.array([-longer.along[1], longer.along[0]])
    half = 0.5 * bar.length_px * bar.along
    ends = np.stack([bar.middle_px - half, bar.middle_px + half]) - longer.middle_px
    within = np.abs(ends @ longer.along) < 0.5 * longer.length_px + SAME_END_PX
    return bool((np.abs(ends @ beside) < SAME_PX).all() and within.all())


def _is_near(bar: Bar, near: NeedleObservation) -> bool:
    line = near.head_px - near.entry_px
    along = line / np.linalg.norm(line)
    beside = np.array([-along[1], along[0]])
    off = bar.middle_px - near.entry_px
    return (
        abs(float(off @ beside)) < NEAR_PX
        and -NEAR_PX < float(off @ along) < near.length_px + NEAR_PX
        and abs(float(bar.along @ beside)) < np.sin(np.radians(NEAR_DEG))
    )


def _checked(image: npt.ArrayLike, camera: CameraModel) -> Image8:
    picture = np.asarray(image)
    width, height = camera.size_wh_px
    if picture.dtype != np.uint8 or picture.shape not in {(height, width), (height, width, 3)}:
        raise InvalidInput(
            "IMAGE_INVALID",
            f"the image is {picture.dtype} of shape {picture.shape}, needed uint8 of {height} rows and "
            f"{width} columns, grey or BGR",
            "Give an image of the camera that was calibrated.",
            {"shape": str(picture.shape), "dtype": str(picture.dtype), "size_wh_px": [width, height]},
        )
    if picture.ndim == 2:
        return np.asarray(cv2.cvtColor(picture, cv2.COLOR_GRAY2BGR), dtype=np.uint8)
    return picture
