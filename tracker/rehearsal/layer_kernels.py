"""Drawing of the drill's body, and compositing of moving layers into an image.

Compiled, because most pixels around an oblique drill are empty and can be skipped; as array operations these
two took half of the time per image.
"""

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from tracker.compiled import compiled
from tracker.rehearsal.lens import MARGIN_NODES, NODE_PX

# Tolerance of the depth test between the body and static objects.
OCCLUSION_MM = 1.0 / 3.0


class Portrait(NamedTuple):
    """Side view of the drill's body.

    Attributes:
        picture: (h, w, 4) uint8, BGR and coverage, premultiplied; columns along the axis, rows across it.
        bulge_mm: (h, w) float32, height of the surface before the axis.
        first_row: first row that is not empty.
        last_row: last row that is not empty.
        near_columns: number of columns from the first that can be occluded.
        start_mm: distance of the first column's border from the tip.
        half_mm: distance of the first row's border from the axis.
        per_mm: pixels to a millimetre.
    """

    picture: npt.NDArray[np.uint8]
    bulge_mm: npt.NDArray[np.float32]
    first_row: int
    last_row: int
    near_columns: int
    start_mm: float
    half_mm: float
    per_mm: float


class Axis(NamedTuple):
    """Axis of the drill in the camera's frame.

    Attributes:
        tip_mm: (3,) of the tip.
        back: (3,) unit vector from the tip to the handpiece.
    """

    tip_mm: npt.NDArray[np.float64]
    back: npt.NDArray[np.float64]


@compiled
def draw_body(layer, places, rays, portrait, axis, still_mm):
    """Draw the body, without what lies behind something static, into stacked rectangles.

    Args:
        layer: (n * h, w, 4) uint8, zeros; BGR and coverage, premultiplied.
        places: (n, 2) x and y of each rectangle in the image, multiples of `NODE_PX`.
        rays: (rows, columns, 3) float32, `RayGrid.nodes`.
        portrait: `Portrait`.
        axis: `Axis`.
        still_mm: (h, w) float32, depth of the static objects in the image.
    """
    height, width = layer.shape[0] // len(places), layer.shape[1]
    rows, columns = height // NODE_PX + 2, width // NODE_PX + 2
    located = np.empty((3, rows, columns), dtype=np.float32)
    for number in range(len(places)):
        left, top = places[number, 0], places[number, 1]
        _locate(
            rays,
            top // NODE_PX + MARGIN_NODES - 1,
            left // NODE_PX + MARGIN_NODES - 1,
            portrait,
            axis,
            located,
        )
        _draw_rectangle(layer, number * height, height, left, top, located, portrait, still_mm)


@compiled
def _locate(rays, first_row, first_column, portrait, axis, out):
    """Write column and row of the portrait that nodes show, and the depth of the axis in mm, to `out`."""
    tip, back = axis.tip_mm, axis.back
    slant = back[0] * tip[0] + back[1] * tip[1] + back[2] * tip[2]
    normal_x = back[1] * tip[2] - back[2] * tip[1]
    normal_y = back[2] * tip[0] - back[0] * tip[2]
    normal_z = back[0] * tip[1] - back[1] * tip[0]
    for i in range(out.shape[1]):
        row = min(max(first_row + i, 0), rays.shape[0] - 1)
        for j in range(out.shape[2]):
            column = min(max(first_column + j, 0), rays.shape[1] - 1)
            x, y = rays[row, column, 0], rays[row, column, 1]
            toward = back[0] * x + back[1] * y + back[2]
            reach = tip[0] * x + tip[1] * y + tip[2]
            lean = max(x * x + y * y + 1.0 - toward * toward, 1e-6)
            depth = (reach - toward * slant) / lean
            beside = (normal_x * x + normal_y * y + normal_z) / np.sqrt(lean)
            out[0, i, j] = (depth * toward - slant - portrait.start_mm) * portrait.per_mm - 0.5
            out[1, i, j] = (beside + portrait.half_mm) * portrait.per_mm - 0.5
            out[2, i, j] = depth


@compiled
def _draw_rectangle(layer, first, height, left, top, located, portrait, still_mm):
    """Draw one rectangle into the layer, from its row `first` on; `located` as by `_locate`."""
    width = layer.shape[1]
    picture, bulge_mm = portrait.picture, portrait.bulge_mm
    one, zero = np.float32(1.0), np.float32(0.0)
    steepness = np.float32(0.5 / OCCLUSION_MM)
    for i in range(located.shape[1] - 1):
        y = NODE_PX * i - NODE_PX // 2
        for j in range(located.shape[2] - 1):
            x = NODE_PX * j - NODE_PX // 2
            r0, r1 = located[1, i, j], located[1, i, j + 1]
            r2, r3 = located[1, i + 1, j], located[1, i + 1, j + 1]
            if max(r0, r1, r2, r3) < portrait.first_row or min(r0, r1, r2, r3) > portrait.last_row:
                continue
            c0, c1 = located[0, i, j], located[0, i, j + 1]
            c2, c3 = located[0, i + 1, j], located[0, i + 1, j + 1]
            d0, d1 = located[2, i, j], located[2, i, j + 1]
            d2, d3 = located[2, i + 1, j], located[2, i + 1, j + 1]
            for down in range(max(-y, 0), min(NODE_PX, height - y)):
                fy = np.float32((down + 0.5) / NODE_PX)
                for across in range(max(-x, 0), min(NODE_PX, width - x)):
                    fx = np.float32((across + 0.5) / NODE_PX)
                    p, q = (one - fx) * (one - fy), fx * (one - fy)
                    r, s = (one - fx) * fy, fx * fy
                    column = p * c0 + q * c1 + r * c2 + s * c3
                    row = p * r0 + q * r1 + r * r2 + s * r3
                    if column < zero or row < zero:
                        continue
                    u, v = np.uint64(column), np.uint64(row)
                    right, below = u + np.uint64(1), v + np.uint64(1)
                    if right >= picture.shape[1] or below >= picture.shape[0]:
                        continue
                    if picture[v, u, 3] == 0 and picture[below, right, 3] == 0:
                        continue
                    visible = one
                    gx, gy = column - np.float32(u), row - np.float32(v)
                    w0, w1 = (one - gx) * (one - gy), gx * (one - gy)
                    w2, w3 = (one - gx) * gy, gx * gy
                    if u < portrait.near_columns:
                        at_y, at_x = top + y + down, left + x + across
                        if 0 <= at_y < still_mm.shape[0] and 0 <= at_x < still_mm.shape[1]:
                            bulge = w0 * bulge_mm[v, u] + w1 * bulge_mm[v, right]
                            bulge += w2 * bulge_mm[below, u] + w3 * bulge_mm[below, right]
                            depth = p * d0 + q * d1 + r * d2 + s * d3 - bulge
                            in_front = np.float32(0.5) + steepness * (still_mm[at_y, at_x] - depth)
                            visible = min(max(in_front, zero), one)
                    w0, w1, w2, w3 = w0 * visible, w1 * visible, w2 * visible, w3 * visible
                    for channel in range(4):
                        value = w0 * picture[v, u, channel] + w1 * picture[v, right, channel]
                        value += w2 * picture[below, u, channel] + w3 * picture[below, right, channel]
                        layer[first + y + down, x + across, channel] = np.uint8(value + np.float32(0.5))


@compiled
def composite(image, places, layer, margin, light, noise):
    """Lay stacked rectangles over an image, with the sensor's gain and noise.

    Args:
        image: (h, w, 3) uint8, BGR; changed.
        places: (n, 2) x and y of each rectangle in the image, without its margin.
        layer: (n * rows, columns, 4) uint8, BGR and coverage, or (n * rows, columns, 2), grey and coverage,
            premultiplied.
        margin: of each rectangle in the layer, in px.
        light: (h, w) float32 gain of the illumination, and a factor of it.
        noise: (256,) standard deviation of a grey level, (h, w, 3) noise of standard deviation 1, int16 each,
            and the scale of their product. Levels that are less than half covered already have theirs.
    """
    gain, flicker = light
    sigmas, bank, scale = noise
    flicker, scale = np.float32(flicker), np.float32(scale)
    half, zero, white = np.float32(0.5), np.float32(0.0), np.float32(255.0)
    last = layer.shape[2] - 1
    green, red = last // 2, last // 3 * 2
    rows = layer.shape[0] // len(places)
    for number in range(len(places)):
        left, top = places[number, 0], places[number, 1]
        begin = max(-left, 0)
        end = min(layer.shape[1] - 2 * margin, image.shape[1] - left)
        for row in range(max(-top, 0), min(rows - 2 * margin, image.shape[0] - top)):
            drawn = layer[number * rows + margin + row, margin + begin :]
            under = image[top + row, left + begin :]
            lit, noisy = gain[top + row, left + begin :], bank[top + row, left + begin :]
            for k in range(end - begin):
                coverage = drawn[k, last]
                if coverage == 0:
                    continue
                brightness = lit[k] * flicker
                b, g, r = brightness * drawn[k, 0], brightness * drawn[k, green], brightness * drawn[k, red]
                if coverage < 255:
                    transparency = np.float32(255 - coverage) * np.float32(1.0 / 255.0)
                    b += transparency * under[k, 0]
                    g += transparency * under[k, 1]
                    r += transparency * under[k, 2]
                if coverage > 127:
                    sigma = sigmas[min(int(brightness * drawn[k, green]), 255)] * scale
                    b += sigma * noisy[k, 0]
                    g += sigma * noisy[k, 1]
                    r += sigma * noisy[k, 2]
                under[k, 0] = np.uint8(min(max(b + half, zero), white))
                under[k, 1] = np.uint8(min(max(g + half, zero), white))
                under[k, 2] = np.uint8(min(max(r + half, zero), white))
