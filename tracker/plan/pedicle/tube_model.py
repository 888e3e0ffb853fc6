"""Parametric pedicle model: a curved bar that widens, with a cortical shell around marrow."""

from dataclasses import dataclass

import numpy as np
import scipy

from tracker.geometry import Array

# Order of the parameters.
CENTRE = slice(0, 6)  # x then y, each constant, slope and bend over the window
AXES = slice(6, 9)  # log half width, log half height, roll
GROWTH = slice(9, 13)  # width then height, each slope and bend over the window
SHAPE = slice(13, 17)  # cos 3, sin 3, cos 4, sin 4 of the outline
CORTEX, THICKNESS, MARROW, BLUR = 17, 18, 19, 20
OUTSIDE = slice(21, 26)  # mean, cos, sin, cos 2, sin 2 around the outline
COUNT = 26


@dataclass(frozen=True, slots=True, kw_only=True)
class Samples:
    """Voxels in the pedicle's frame.

    Attributes:
        along: (n,), from -1 to 1 over the window.
        across_mm: (n, 2), to the left and up.
        hu: (n,).
        box_mm2: (n,), variance of a voxel's box along the direction of the nearest wall.
    """

    along: Array
    across_mm: Array
    hu: Array
    box_mm2: Array


@dataclass(frozen=True, slots=True, kw_only=True)
class Section:
    """Half axes, roll and centre of the outline at places along the bar, (n,) each."""

    x_mm: Array
    y_mm: Array
    half_width_mm: Array
    half_height_mm: Array


def section_at(parameters: Array, along: Array) -> Section:
    """Return the elliptic outline at places (n,), -1..1 along the bar."""
    c, g = parameters[CENTRE], parameters[GROWTH]
    a, b = np.exp(parameters[AXES][:2])
    squared = along * along
    return Section(
        x_mm=c[0] + c[1] * along + c[2] * squared,
        y_mm=c[3] + c[4] * along + c[5] * squared,
        half_width_mm=a * np.maximum(1.0 + g[0] * along + g[1] * squared, 0.2),
        half_height_mm=b * np.maximum(1.0 + g[2] * along + g[3] * squared, 0.2),
    )


def wall_distance_mm(parameters: Array, along: Array, across_mm: Array) -> tuple[Array, Array]:
    """Return the distance (n,) to the outer wall, negative inside, and the polar angle (n,) in rad."""
    section = section_at(parameters, along)
    x, y = across_mm[:, 0] - section.x_mm, across_mm[:, 1] - section.y_mm
    roll = parameters[AXES][2]
    u, v = np.cos(roll) * x + np.sin(roll) * y, np.cos(roll) * y - np.sin(roll) * x
    a, b = section.half_width_mm, section.half_height_mm
    angle = np.arctan2(v, u)
    around = np.arctan2(v / b, u / a)
    c3, s3, c4, s4 = parameters[SHAPE]
    bump = (
        1.0
        + c3 * np.cos(3 * around)
        + s3 * np.sin(3 * around)
        + c4 * np.cos(4 * around)
        + s4 * np.sin(4 * around)
    )
    q = np.sqrt((u / a) ** 2 + (v / b) ** 2)
    slope = np.sqrt((u / (a * a)) ** 2 + (v / (b * b)) ** 2) / np.maximum(q, 1e-6)
    distance = (q - bump) / np.maximum(slope, 0.5 / np.maximum(a, b))
    return distance, angle


def model_hu(parameters: Array, samples: Samples) -> Array:
    """Return the modelled HU of each voxel (n,): outside, cortex and marrow, blurred by voxel and scanner."""
    distance, angle = wall_distance_mm(parameters, samples.along, samples.across_mm)
    sigma = np.sqrt(samples.box_mm2 + np.exp(2.0 * parameters[BLUR]))
    outside = outside_hu(parameters, angle)
    cortex, marrow = parameters[CORTEX], parameters[MARROW]
    thickness = np.exp(parameters[THICKNESS])
    into_wall, into_core = (
        scipy.special.ndtr(-distance / sigma),
        scipy.special.ndtr(-(distance + thickness) / sigma),
    )
    return np.asarray(outside + (cortex - outside) * into_wall + (marrow - cortex) * into_core)


def outside_hu(parameters: Array, angle: Array) -> Array:
    """Return the HU of the surrounding tissue, which depends on the polar angle."""
    o = parameters[OUTSIDE]
    return np.asarray(
        o[0]
        + o[1] * np.cos(angle)
        + o[2] * np.sin(angle)
        + o[3] * np.cos(2 * angle)
        + o[4] * np.sin(2 * angle)
    )


def outline(parameters: Array, along: float, count: int = 180) -> Array:
    """Return points (count, 2) of the outline at one place along the bar, in mm to the left and up."""
    section = section_at(parameters, np.array([along]))
    around = 2.0 * np.pi * np.arange(count) / count
    c3, s3, c4, s4 = parameters[SHAPE]
    bump = (
        1.0
        + c3 * np.cos(3 * around)
        + s3 * np.sin(3 * around)
        + c4 * np.cos(4 * around)
        + s4 * np.sin(4 * around)
    )
    u = section.half_width_mm[0] * bump * np.cos(around)
    v = section.half_height_mm[0] * bump * np.sin(around)
    roll = parameters[AXES][2]
    x = section.x_mm[0] + np.cos(roll) * u - np.sin(roll) * v
    y = section.y_mm[0] + np.sin(roll) * u + np.cos(roll) * v
    return np.stack([x, y], axis=1)
