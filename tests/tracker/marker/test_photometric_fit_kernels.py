"""Kernels of photometric verification against plain NumPy."""

from typing import Any

import cv2
import numpy as np
import pytest

from tests.tracker.scenes import code_model
from tracker.geometry import Array
from tracker.marker.photometric_fit.grid_kernels import (
    GRID_CELLS,
    PAD,
    SQUARE_CELLS,
    cells_per_px,
    lens_blur,
    render_model,
)
from tracker.marker.photometric_fit.occlusion_kernels import half_plane_weights, residual_components
from tracker.marker.photometric_fit.scale_space import scale_space_of
from tracker.marker.photometric_fit.shadow_kernels import shadow_edge
from tracker.marker.sampling_kernels import square_to_quad
from tracker.warm_up import warm_up

FINE = 16  # texels a field
FACING = np.eye(2)  # fields per px


def _blurred(blur: tuple[float, float, float], *, smears: bool = True) -> Array:
    """The model on paper, finely, by its spectrum: blurred by a Gaussian, and smeared evenly along a line.

    Where nothing `smears`, the Gaussian is longer along that line.
    """
    size = (GRID_CELLS + 2 * PAD) * FINE
    small = cv2.resize(
        code_model().square, (SQUARE_CELLS * FINE, SQUARE_CELLS * FINE), interpolation=cv2.INTER_AREA
    )
    fields = np.pad(small / 255.0, (size - SQUARE_CELLS * FINE) // 2, constant_values=1.0)
    ku, kv = np.meshgrid(*(2 * np.pi * np.fft.fftfreq(size, 1.0 / FINE),) * 2)
    values, vectors = np.linalg.eigh(np.array([[blur[0], blur[2]], [blur[2], blur[1]]]))
    along = ku * vectors[0, 1] + kv * vectors[1, 1]
    more = values[1] - values[0]
    shrunk = np.exp(-0.5 * values[0] * (ku**2 + kv**2))
    if smears:
        shrunk *= np.sinc(along * np.sqrt(12.0 * more) / (2.0 * np.pi))
    else:
        shrunk *= np.exp(-0.5 * more * along**2)
    return np.asarray(np.fft.ifft2(np.fft.fft2(fields) * shrunk).real)


def _at_fields(fine: Array) -> Array:
    """Return the mean of the four texels around each cell centre."""
    first = PAD * FINE + FINE // 2
    cut = slice(first, first + GRID_CELLS * FINE, FINE)
    before = slice(first - 1, first - 1 + GRID_CELLS * FINE, FINE)
    return np.asarray((fine[cut, cut] + fine[before, cut] + fine[cut, before] + fine[before, before]) / 4.0)


@pytest.mark.parametrize(
    ("blur", "within"),
    [
        ((0.2, 0.2, 0.0), 0.02),
        ((1.5, 1.7, 0.05), 0.01),
        ((3.0, 0.6, 0.0), 0.03),
        ((2.0, 2.0, 1.4), 0.03),
        # A way of 11 fields, nearly half of the square.
        ((10.0, 0.5, 0.0), 0.04),
    ],
)
def test_the_rendered_image_is_the_blurred_model(blur: tuple[float, float, float], within: float) -> None:
    pictures = scale_space_of(code_model().square)
    shown = np.empty((6, GRID_CELLS, GRID_CELLS), np.float32)
    render_model(pictures.layers, pictures.blurs_cells, np.array(blur), FACING, shown)
    fine = _blurred(blur)
    np.testing.assert_allclose(shown[0], _at_fields(fine), atol=within)
    slopes = (np.gradient(fine, 1.0 / FINE, axis=1), np.gradient(fine, 1.0 / FINE, axis=0))
    for number, slope in enumerate(slopes, start=1):
        np.testing.assert_allclose(shown[number], _at_fields(slope), atol=0.08)
    bend = np.gradient(slopes[0], 1.0 / FINE, axis=0)
    assert np.corrcoef(shown[5].ravel(), _at_fields(bend).ravel())[0, 1] > 0.98


def test_defocus_is_a_gaussian_at_any_tilt() -> None:
    pictures = scale_space_of(code_model().square)
    shown, blur = np.empty((6, GRID_CELLS, GRID_CELLS), np.float32), np.empty(3)
    # Seen at 60 degrees, the image's pixels are twice as high as wide on the marker.
    tilted = np.array([[1.0, 0.0], [0.0, 2.0]])
    lens_blur(tilted, 1.3, blur)
    render_model(pictures.layers, pictures.blurs_cells, blur, tilted, shown)
    own = tuple(float(v) for v in blur)
    gaussian, box = (
        _at_fields(_blurred((own[0], own[1], own[2]), smears=smears)) for smears in (False, True)
    )
    np.testing.assert_allclose(shown[0], gaussian, atol=0.02)
    assert float(np.abs(shown[0] - box).max()) > 0.04


def test_cells_per_px_at_the_centre_of_a_square() -> None:
    quad = np.array([[100.0, 50.0], [148.0, 50.0], [148.0, 74.0], [100.0, 74.0]])
    to_px, ahead = np.empty(8), np.empty((2, 2))
    square_to_quad(quad, to_px)
    unit = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    cells_per_px(to_px, unit, ahead)
    np.testing.assert_allclose(ahead, [[SQUARE_CELLS / 48.0, 0.0], [0.0, SQUARE_CELLS / 24.0]], atol=1e-9)
    cells_per_px(to_px, 0.25 + 0.5 * unit, ahead)
    np.testing.assert_allclose(ahead, [[SQUARE_CELLS / 24.0, 0.0], [0.0, SQUARE_CELLS / 12.0]], atol=1e-9)


def test_components_over_the_border_are_distinguished_from_those_inside() -> None:
    rest, labels = np.zeros((30, 30)), np.empty((30, 30), np.int64)
    rest[0:8, 10:14] = 1.0  # from the paper into the square
    rest[12:16, 12:17] = -1.0
    rest[20, 20] = 5.0  # a speck: it and its neighbours are too few
    areas = residual_components(rest, np.ones((30, 30)), 3, 0.5, 10, labels)
    assert areas.tolist() == [16]
    assert (labels[2:6, 11:13] == -1).all()
    assert (labels[13:15, 13:16] == 1).all()
    assert labels[20, 20] == 0


def test_illumination_of_the_visible_part_reveals_the_occluder() -> None:
    pictures = scale_space_of(code_model().square)
    shown = np.empty((6, GRID_CELLS, GRID_CELLS), np.float32)
    render_model(pictures.layers, pictures.blurs_cells, np.array([0.5, 0.5, 0.0]), FACING, shown)
    seen = 30.0 + 150.0 * shown[0].astype(np.float64)
    seen[:, 20:] = 95.0
    weight = np.empty((GRID_CELLS, GRID_CELLS))
    assert half_plane_weights(seen, shown[0], 12, np.array([0.0, 0.35, 0.7]), 0.25, weight)
    assert weight[:, :20].min() > 0.8
    assert float(weight[:, 20:].mean()) < 0.5
    assert not half_plane_weights(30.0 + 150.0 * shown[0], shown[0], 12, np.array([0.0]), 0.25, weight)


@pytest.mark.parametrize(("angle_deg", "place"), [(20.0, 0.1), (80.0, -0.4), (140.0, 0.35)])
def test_the_edge_of_a_shadow_is_found_where_it_is(angle_deg: float, place: float) -> None:
    pictures = scale_space_of(code_model().square)
    shown = np.empty((6, GRID_CELLS, GRID_CELLS), np.float32)
    render_model(pictures.layers, pictures.blurs_cells, np.array([0.5, 0.5, 0.0]), FACING, shown)
    v, u = (np.mgrid[0:GRID_CELLS, 0:GRID_CELLS] - (GRID_CELLS - 1) / 2.0) * (2.0 / SQUARE_CELLS)
    angle = np.radians(angle_deg)
    lit = 1.0 - 0.7 / (1.0 + np.exp(-(u * np.cos(angle) + v * np.sin(angle) - place) / 0.06))
    seen = lit * (30.0 + 150.0 * shown[0].astype(np.float64))
    edge = np.empty(3)
    part = shadow_edge(seen, shown[0], np.ones((GRID_CELLS, GRID_CELLS), np.bool_), 12, 9, 0.1, edge)
    assert part > 0.9
    assert edge[0] == pytest.approx(angle, abs=0.1)
    assert edge[1] == pytest.approx(place, abs=0.06)


def test_the_warm_up_compiles_every_kernel_of_the_photometric_fit() -> None:
    warm_up()
    loops: list[Any] = [render_model, residual_components, half_plane_weights, shadow_edge]
    assert all(loop.signatures for loop in loops)
