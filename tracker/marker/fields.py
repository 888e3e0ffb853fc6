"""The fields of a square as an image shows them: sampled, blurred, in light that varies."""

from functools import cache

import cv2
import numpy as np
import numpy.typing as npt

from tracker.edges import GreyImage
from tracker.geometry import Array
from tracker.marker.kernels import sample_square

FIELDS, RING = 24, 3  # fields a side of the square, and of its white paper around it
WIDE = FIELDS + 2 * RING
PAD = 6  # beyond, so that blur at one side does not wrap round to the other
SAMPLES = 2
SHADOW_ANGLES, SHADOW_PLACES, SHADOW_SOFT_FIELDS = 16, 11, 1.2
LEAST_GAINED_RATIO = 0.15

Mask = npt.NDArray[np.bool_]


def sampled(image: GreyImage, to_px: Array, corners: Array) -> Array:
    """Fields (WIDE, WIDE) of the square and its paper, whose corners (4, 2) are in the unit square."""
    middle = corners.mean(axis=0)
    wide = middle + (corners - middle) * (WIDE / FIELDS)
    px = cv2.perspectiveTransform(wide[None].astype(np.float64), to_px)[0]
    return np.asarray(sample_square(image, px, WIDE, SAMPLES), dtype=np.float64)


def spectrum_of(square: GreyImage) -> Array:
    """Of the model's fields on white paper, 0 dark to 1 bright."""
    low, high = float(square.min()), float(square.max())
    small = cv2.resize(square, (FIELDS, FIELDS), interpolation=cv2.INTER_AREA).astype(np.float64)
    fields = np.pad((small - low) / (high - low), RING + PAD, constant_values=1.0)
    return np.asarray(np.fft.rfft2(fields))


def pictures(spectrum: Array, blur: Array) -> list[Array]:
    """The blurred model, its slopes along u and v, and what more blur (3,) does to it."""
    n = WIDE + 2 * PAD
    ku, kv = np.meshgrid(2 * np.pi * np.fft.rfftfreq(n), 2 * np.pi * np.fft.fftfreq(n))
    base = spectrum * np.exp(-0.5 * (blur[0] * ku**2 + blur[1] * kv**2 + 2.0 * blur[2] * ku * kv))
    changes = (np.ones_like(ku), 1j * ku, 1j * kv, -0.5 * ku**2, -0.5 * kv**2, -ku * kv)
    cut = slice(PAD, PAD + WIDE)
    return [np.fft.irfft2(base * one, s=(n, n))[cut, cut] for one in changes]


@cache
def grid() -> tuple[Array, Array]:
    """(u, v) of the fields, -1..1 over the square."""
    v, u = (np.mgrid[0:WIDE, 0:WIDE] - (WIDE - 1) / 2.0) * (2.0 / FIELDS)
    return u, v


@cache
def inside_square() -> Mask:
    """Which fields lie inside the outline."""
    u, v = grid()
    return np.asarray(np.maximum(np.abs(u), np.abs(v)) < 1.0)


def light_terms(shadow: Array | None, *, order: int = 2) -> Array:
    """What light may add (fields, n): glare, and the ink's own grey in light that varies."""
    u, v = grid()
    terms = [u**m * v ** (n - m) for n in range(order + 1) for m in range(n + 1)]
    if shadow is not None:
        terms.append(shadow)
    return np.stack([one.ravel() for one in terms], axis=1)


def gain_terms(shadow: Array | None) -> Array:
    """How contrast may vary (fields, n)."""
    u, v = grid()
    terms = [np.ones_like(u), u, v]
    if shadow is not None:
        terms.append(shadow)
    return np.stack([one.ravel() for one in terms], axis=1)


def shadow_in(seen: Array, picture: Array) -> Array | None:
    """The straight edge of a shadow, or of a cover, that explains most of what is left, if any."""
    base = np.linalg.qr(np.column_stack([light_terms(None), gain_terms(None) * picture.ravel()[:, None]]))[0]
    left = seen.ravel() - base @ (base.T @ seen.ravel())
    edges, steps = _steps()
    gained = _gained(left, base, steps, picture)
    best = int(np.argmax(gained))
    if gained[best] < LEAST_GAINED_RATIO * float(left @ left):
        return None
    angle, place, soft = edges[best]
    near = [
        (angle + a * np.pi / SHADOW_ANGLES, place + b * 2.2 / (SHADOW_PLACES - 1), soft * c)
        for a in (-0.5, -0.25, 0.0, 0.25, 0.5)
        for b in (-0.5, -0.25, 0.0, 0.25, 0.5)
        for c in (0.25, 0.5, 1.0, 2.0, 4.0)
    ]
    steps = np.stack([_edge(*one) for one in near])
    return np.asarray(steps[int(np.argmax(_gained(left, base, steps, picture)))].reshape(seen.shape))


def _gained(left: Array, base: Array, steps: Array, picture: Array) -> Array:
    """By how much (k,) each step of the light (k, fields), on ink and paper, lowers the squares."""
    first, second = steps.T, steps.T * picture.ravel()[:, None]
    first = first - base @ (base.T @ first)
    second = second - base @ (base.T @ second)
    aa, ab, bb = (first**2).sum(axis=0), (first * second).sum(axis=0), (second**2).sum(axis=0)
    a, b = left @ first, left @ second
    det = np.maximum(aa * bb - ab**2, 1e-9 * aa * bb + 1e-12)
    return np.asarray((bb * a * a - 2.0 * ab * a * b + aa * b * b) / det)


def _edge(angle: float, place: float, soft: float) -> Array:
    """Light (fields,) that goes from 0 to 1 across a line."""
    u, v = grid()
    across = u * np.cos(angle) + v * np.sin(angle) - place
    return np.asarray(0.5 + 0.5 * np.tanh(across.ravel() * FIELDS / 4.0 / soft))


@cache
def _steps() -> tuple[list[tuple[float, float, float]], Array]:
    edges = [
        (float(angle), float(place), SHADOW_SOFT_FIELDS)
        for angle in np.arange(SHADOW_ANGLES) * np.pi / SHADOW_ANGLES
        for place in np.linspace(-1.1, 1.1, SHADOW_PLACES)
    ]
    return edges, np.stack([_edge(*one) for one in edges])
