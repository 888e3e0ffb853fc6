"""Isthmus of a fitted bar: width, height, centre and axis with standard deviations."""

from dataclasses import dataclass

import numpy as np
import scipy

from tracker.geometry import Array
from tracker.plan.pedicle import tube_model
from tracker.plan.pedicle.fit import FittedBar, narrowest

ROUND_RATIO = 1.08
# Sd of the roll of the principal axes, because real sections are not ellipses. Above this probability that
# the other axis is nearer to left-right, the smaller extent is used as the width.
ROLL_SD_DEG, EITHER_RATIO = 6.0, 0.2
# Error of the model that is common to a whole wall, so that residuals do not show it: of an extent as a ratio
# of the voxel along it, and of the axis.
MODEL_VOXELS, MODEL_DEG = 0.03, 0.05
# Axis and wall errors for a misfit of this share of the contrast, over a short window.
UNLIKE_RATIO, UNLIKE_DEG, UNLIKE_HALF_MM, MAX_UNLIKE_DEG = 0.1, 10.0, 3.0, 20.0

# A bar without a waist is measured at its centre, with an sd of this share of half its window.
MAX_PLACE_SHARE = 0.5


@dataclass(frozen=True, slots=True, kw_only=True)
class Isthmus:
    """The narrowest section, in LPS.

    Attributes:
        centre_mm: (3,).
        axis: unit (3,), forwards.
        width_mm: see `PedicleMeasure`; height_mm too.
        outline_mm: (n, 3).
        width_sd_mm: and height_sd_mm, centre_sd_mm: standard deviations.
        slope_sd_deg: of the axis's direction, to the left and up.
        bent_sd_deg: additional sd for a bent bar that hardly narrows, whose narrowest place is uncertain.
        other_way_ratio: probability that width and height are swapped, as for an oblique section.
        usual_ratio: influence of the anatomical prior on the transverse angle, 0 to 1.
    """

    centre_mm: Array
    axis: Array
    width_mm: float
    height_mm: float
    outline_mm: Array
    width_sd_mm: float
    height_sd_mm: float
    centre_sd_mm: float
    slope_sd_deg: tuple[float, float]
    bent_sd_deg: tuple[float, float]
    other_way_ratio: float
    usual_ratio: float = 0.0

    @property
    def is_oblique(self) -> bool:
        """Return whether either principal axis can be the width; the smaller one is used."""
        return self.other_way_ratio > EITHER_RATIO


def isthmus_of(fitted: FittedBar, voxel_mm: tuple[float, float]) -> Isthmus:
    """Return the narrowest section of a fitted bar, in voxels of this size from side to side and upwards."""
    at = narrowest(fitted)
    numbers = _numbers(fitted.parameters, at, fitted.half_mm)
    spread = _spread(fitted, at)
    centre = (
        fitted.origin_mm
        + at * fitted.half_mm * fitted.axis
        + numbers[2] * fitted.left
        + numbers[3] * fitted.up
    )
    axis = fitted.axis + numbers[4] * fitted.left + numbers[5] * fitted.up
    points = tube_model.outline(fitted.parameters, at)
    outline = (
        fitted.origin_mm
        + at * fitted.half_mm * fitted.axis
        + points[:, :1] * fitted.left
        + points[:, 1:] * fitted.up
    )
    floor = MODEL_VOXELS * np.array(voxel_mm)
    bent = np.degrees(_bend_per_mm(fitted)) * _place_sd_mm(fitted)
    slopes = np.degrees(spread[4:6])
    unlike = UNLIKE_DEG * (fitted.misfit_ratio / UNLIKE_RATIO) ** 3 * UNLIKE_HALF_MM / fitted.half_mm
    model_deg = float(np.hypot(MODEL_DEG, min(unlike, MAX_UNLIKE_DEG)))
    other_way = _other_way_ratio(fitted, at)
    either = abs(numbers[0] - numbers[1]) * np.sqrt(other_way * (1.0 - other_way))
    # An underestimate leads to a thinner screw, an overestimate to a breach.
    wide, high = (1, 0) if other_way > EITHER_RATIO and numbers[0] > numbers[1] else (0, 1)
    return Isthmus(
        centre_mm=centre,
        axis=axis / np.linalg.norm(axis),
        width_mm=float(numbers[wide]),
        height_mm=float(numbers[high]),
        outline_mm=outline,
        width_sd_mm=float(np.linalg.norm([spread[wide], floor[wide], either])),
        height_sd_mm=float(np.linalg.norm([spread[high], floor[high], either])),
        centre_sd_mm=float(np.linalg.norm([spread[2], spread[3], *floor])),
        slope_sd_deg=(float(np.hypot(slopes[0], model_deg)), float(np.hypot(slopes[1], model_deg))),
        bent_sd_deg=(float(bent[0]), float(bent[1])),
        other_way_ratio=other_way,
    )


def _bend_per_mm(fitted: FittedBar) -> Array:
    """Return the curvature of the axis, to the left and up, in rad per mm."""
    c = fitted.parameters[tube_model.CENTRE]
    return np.asarray(np.abs([c[2], c[5]]) * 2.0 / fitted.half_mm**2)


def _place_sd_mm(fitted: FittedBar) -> float:
    """Return the sd of the narrowest place along the bar; on a bent bar it adds to that of the axis."""
    slope, bend = fitted.parameters[tube_model.GROWTH][:2]
    slope_sd, bend_sd = np.sqrt(np.diag(fitted.covariance)[tube_model.GROWTH][:2])
    waist = max(float(bend), float(bend_sd), 1e-6)
    place = np.hypot(slope_sd / (2.0 * waist), slope * bend_sd / (2.0 * waist**2))
    return float(min(place, MAX_PLACE_SHARE) * fitted.half_mm)


def _numbers(parameters: Array, at: float, half_mm: float) -> Array:
    """Return width, height, centre (x, y) and slope (x, y) of the section at one place."""
    points = tube_model.outline(parameters, at)
    section = tube_model.section_at(parameters, np.array([at]))
    direction = _width_direction(parameters, section)
    across = np.array([-direction[1], direction[0]])
    c = parameters[tube_model.CENTRE]
    return np.array(
        [
            _extent(points - [section.x_mm[0], section.y_mm[0]], direction),
            _extent(points - [section.x_mm[0], section.y_mm[0]], across),
            section.x_mm[0],
            section.y_mm[0],
            (c[1] + 2.0 * c[2] * at) / half_mm,
            (c[4] + 2.0 * c[5] * at) / half_mm,
        ]
    )


def _extent(points: Array, direction: Array) -> float:
    """Return the extent (mm) along a direction (2,): mean of calliper width and chord through the centre.

    For an ellipse both are equal. A truncated Fourier series does not follow a corner, where the calliper
    width is too large and the chord between the corners too small.
    """
    turned = np.arctan2(points @ [-direction[1], direction[0]], points @ direction)
    order = np.argsort(turned)
    radius = np.linalg.norm(points, axis=1)[order]
    ends = np.interp([0.0, np.pi], turned[order], radius, period=2.0 * np.pi)
    return float(0.5 * (ends.sum() + np.ptp(points @ direction)))


def _other_way_ratio(fitted: FittedBar, at: float) -> float:
    """Return the probability that the other principal axis is the left-right one, given the roll sd."""
    section = tube_model.section_at(fitted.parameters, np.array([at]))
    direction = _width_direction(fitted.parameters, section)
    turned_deg = abs(float(np.degrees(np.arctan2(direction[1], direction[0]))))
    own_deg = float(np.degrees(np.sqrt(fitted.covariance[tube_model.AXES, tube_model.AXES][2, 2])))
    return float(scipy.special.ndtr(-(45.0 - turned_deg) / np.hypot(own_deg, ROLL_SD_DEG)))


def _width_direction(parameters: Array, section: tube_model.Section) -> Array:
    """Return the principal axis nearest to left-right; left-right itself if the section is round."""
    a, b = section.half_width_mm[0], section.half_height_mm[0]
    if max(a, b) < ROUND_RATIO * min(a, b):
        return np.array([1.0, 0.0])
    roll = float(parameters[tube_model.AXES][2])
    roll = (roll + np.pi / 4.0) % (np.pi / 2.0) - np.pi / 4.0
    return np.array([np.cos(roll), np.sin(roll)])


def _spread(fitted: FittedBar, at: float) -> Array:
    """Return the standard deviations of `_numbers`, by propagation of the parameter covariance."""
    base = _numbers(fitted.parameters, at, fitted.half_mm)
    slopes = np.zeros((len(base), tube_model.COUNT))
    for n in range(tube_model.OUTSIDE.start):
        step = 1e-4 * max(1.0, abs(float(fitted.parameters[n])))
        moved = fitted.parameters.copy()
        moved[n] += step
        slopes[:, n] = (_numbers(moved, at, fitted.half_mm) - base) / step
    return np.asarray(np.sqrt(np.maximum(np.diag(slopes @ fitted.covariance @ slopes.T), 0.0)))
