"""Parametric pedicle model: a curved bar that widens, with a cortical shell around marrow."""

from dataclasses import dataclass

import numpy as np

from tracker.geometry import Array
from tracker.plan.pedicle.tube_kernels import model_with_jacobian, walls_at

# Order of the parameters.
CENTRE = slice(0, 6)  # x then y, each constant, slope and bend over the window
AXES = slice(6, 9)  # log half width, log half height, roll
GROWTH = slice(9, 13)  # width then height, each slope and bend over the window
SHAPE = slice(13, 17)  # cos 3, sin 3, cos 4, sin 4 of the outline
CORTEX, THICKNESS, MARROW, BLUR = 17, 18, 19, 20
OUTSIDE = slice(21, 26)  # mean, cos, sin, cos 2, sin 2 around the outline
SLICE_BLUR = 26  # across the slices, where BLUR is within them
BLURS = [BLUR, SLICE_BLUR]
AROUND = slice(27, 29)  # cos, sin of the log thickness around the outline
COUNT = 29


@dataclass(frozen=True, slots=True, kw_only=True)
class Samples:
    """Voxels in the pedicle's frame.

    Attributes:
        rows: (n, 7), by column: place along the bar from -1 to 1 over the window; position to the left and
            up, in mm; of each part of the voxel, largest side across the nearest wall, in mm, the variance of
            its other sides, and the one along that wall in the section, in mm2; squared cosine between the
            wall's normal and that of the slices.
        offsets: (k, 3), of the parts of a voxel from its centre: along, to the left and up, as in `rows`.
        hu: (n,).
    """

    rows: Array
    offsets: Array
    hu: Array


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
    distance, angle = np.empty(len(along)), np.empty(len(along))
    walls_at(parameters, along, np.ascontiguousarray(across_mm), distance, angle)
    return distance, angle


def model_hu(parameters: Array, samples: Samples) -> tuple[Array, Array]:
    """Return the modelled HU of each voxel (n,) and its derivatives (n, 29).

    Outside, cortex and marrow, blurred by voxel and scanner; the wall is as curved as the outline.
    """
    hu, jacobian = np.empty(len(samples.hu)), np.empty((len(samples.hu), COUNT))
    model_with_jacobian(parameters, samples.rows, samples.offsets, hu, jacobian)
    return hu, jacobian


def outline(parameters: Array, along: float, count: int = 180) -> Array:
    """Return points (count, 2) of the outline at one place along the bar, in mm to the left and up."""
    section = section_at(parameters, np.array([along]))
    around = 2.0 * np.pi * np.arange(count) / count
    c3, s3, c4, s4 = parameters[SHAPE]
    a, b = section.half_width_mm[0], section.half_height_mm[0]
    c, s = np.cos(around), np.sin(around)
    speed_squared = (a * s) ** 2 + (b * c) ** 2
    bump = (
        c3 * np.cos(3 * around) + s3 * np.sin(3 * around) + c4 * np.cos(4 * around) + s4 * np.sin(4 * around)
    )
    along_normal = bump * a * b / speed_squared
    u, v = a * c + along_normal * b * c, b * s + along_normal * a * s
    roll = parameters[AXES][2]
    x = section.x_mm[0] + np.cos(roll) * u - np.sin(roll) * v
    y = section.y_mm[0] + np.sin(roll) * u + np.cos(roll) * v
    return np.stack([x, y], axis=1)
