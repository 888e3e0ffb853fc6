"""The rendered image against the theatre's ground truth, and the effect of each setting."""

from functools import lru_cache

import cv2
import numpy as np
import numpy.typing as npt
import pytest

from tests.tracker.rehearsal.stills import STILLS
from tracker.geometry import Array
from tracker.rehearsal import Renderer, Theatre, TheatreSettings, Truth

SIZE = (1280, 720)
SIDE_MM = 25.0


@lru_cache(maxsize=6)
def staged(
    seed: int = 1,
    noise: float = 0.0,
    blur: float = 1.0,
    clutter: float = 0.0,
    light: float = 0.0,
    size: tuple[int, int] = SIZE,
) -> tuple[Theatre, Renderer]:
    theatre = Theatre(
        TheatreSettings(seed=seed, size_wh_px=size, noise=noise, blur=blur, clutter=clutter, light=light)
    )
    renderer = theatre.renderer(store=STILLS)
    assert isinstance(renderer, Renderer)
    return theatre, renderer


def edge_offsets_px(image: npt.NDArray[np.uint8], theatre: Theatre, truth: Truth) -> Array:
    """Signed distances (4 sides, 41 points) of the black square's outer edges in the image from the truth.

    At each true point of an edge the grey profile across it gives the edge as the middle of its gradient.
    """
    grey = cv2.cvtColor(image, cv2.COLOR_BGR2GRAY).astype(np.float32)
    half = SIDE_MM / 2.0
    corners = np.array([[-half, half, 0], [half, half, 0], [half, -half, 0], [-half, -half, 0]])
    steps = np.linspace(-4.0, 4.0, 81)
    out = []
    for side in range(4):
        a, b = corners[side], corners[(side + 1) % 4]
        ratio = np.linspace(0.12, 0.88, 41)[:, None]
        outwards = (a + b) / 2.0 / half
        on_edge = truth.camera_from_marker.move_points(a + ratio * (b - a))
        beside = truth.camera_from_marker.move_points(a + ratio * (b - a) + 0.01 * outwards)
        px = theatre.camera.px_from_camera(on_edge)
        along = np.gradient(px, axis=0)
        normal = np.stack([along[:, 1], -along[:, 0]], axis=1)
        normal /= np.linalg.norm(normal, axis=1, keepdims=True)
        normal *= np.sign(((theatre.camera.px_from_camera(beside) - px) * normal).sum(axis=1))[:, None]
        at = (px[:, None] + steps[:, None] * normal[:, None]).astype(np.float32)
        profile = cv2.remap(grey, at[..., 0], at[..., 1], cv2.INTER_CUBIC)
        slope = np.gradient(profile, steps, axis=1)
        out.append((slope * steps).sum(axis=1) / slope.sum(axis=1))
    return np.asarray(out, dtype=np.float64)


@pytest.mark.parametrize(
    ("seed", "at_s"), [(1, 3.3), (2, 9.0), (1, 17.77), (2, 25.0)], ids=["approach", "align", "drill", "drift"]
)
def test_every_edge_of_the_square_is_at_its_true_position(seed: int, at_s: float) -> None:
    theatre, renderer = staged(seed=seed)
    truth = theatre.truth_at(at_s)
    assert truth.marker_in_view
    offsets = edge_offsets_px(renderer.image_at(at_s), theatre, truth)
    assert np.abs(np.median(offsets, axis=1)).max() < 0.02
    assert np.abs(offsets).max() < 0.08


def test_the_edges_lie_right_while_the_hand_moves_fast() -> None:
    theatre, renderer = staged(blur=2.0)
    at_s = 1.0
    before, after = theatre.truth_at(at_s - 0.01), theatre.truth_at(at_s + 0.01)
    assert np.linalg.norm(after.corners_px - before.corners_px, axis=1).min() / 0.02 > 50.0
    offsets = edge_offsets_px(renderer.image_at(at_s), theatre, theatre.truth_at(at_s))
    assert np.abs(np.median(offsets, axis=1)).max() < 0.03


def test_corners_found_by_crossing_the_edges_agree_with_the_truth() -> None:
    # Not cv2.cornerSubPix: on the corner of a blurred dark square it lands 0.2 px inside, for any image.
    theatre, renderer = staged(noise=0.2, light=1.0)
    misses = []
    for at_s in (4.0, 15.0, 24.0):
        truth = theatre.truth_at(at_s)
        offsets = np.median(edge_offsets_px(renderer.image_at(at_s), theatre, truth), axis=1)
        corners = truth.corners_px
        lines = []
        for side in range(4):
            a, b = corners[side], corners[(side + 1) % 4]
            normal = np.array([(b - a)[1], -(b - a)[0]]) / np.linalg.norm(b - a)
            normal *= np.sign(normal @ (a - corners.mean(axis=0)))
            lines.append((normal, float(normal @ a) + offsets[side]))
        for side in range(4):
            (m, c), (n, d) = lines[side - 1], lines[side]
            misses.append(np.linalg.norm(np.linalg.solve(np.stack([m, n]), [c, d]) - corners[side]))
    assert np.median(misses) < 0.02
    assert np.max(misses) < 0.06


def test_the_printed_face_is_neither_turned_nor_mirrored() -> None:
    theatre, renderer = staged()
    truth = theatre.truth_at(9.0)
    side = theatre.marker.image.shape[0]
    flat = np.array([[0, 0], [side, 0], [side, side], [0, side]], dtype=np.float32) - 0.5
    matrix = cv2.getPerspectiveTransform(truth.corners_px.astype(np.float32), flat)
    grey = cv2.cvtColor(renderer.image_at(9.0), cv2.COLOR_BGR2GRAY)
    seen = cv2.warpPerspective(grey, matrix, (side, side)).astype(np.float64)
    correlation = [
        np.corrcoef(seen.ravel(), other.ravel())[0, 1]
        for face in (theatre.marker.image, theatre.marker.image[:, ::-1])
        for other in (np.rot90(face, turns) for turns in range(4))
    ]
    assert correlation[0] > 0.95
    assert max(correlation[1:]) < 0.85


def test_the_same_seed_and_time_give_the_same_image_to_the_bit() -> None:
    settings = TheatreSettings(seed=7, size_wh_px=(640, 360))
    first, second = Theatre(settings).renderer(), Theatre(settings).renderer()
    first.image_at(3.0)
    np.testing.assert_array_equal(first.image_at(12.34), second.image_at(12.34))


def test_another_seed_or_another_time_gives_another_image() -> None:
    _, one = staged(seed=1, noise=1.0, size=(640, 360))
    _, two = staged(seed=2, noise=1.0, size=(640, 360))
    here = one.image_at(12.0).astype(np.int16)
    assert np.abs(here - two.image_at(12.0)).mean() > 3.0
    # The noise does not repeat with the motion's period.
    assert np.abs(here - one.image_at(52.0)).mean() > 0.5


def test_noise_is_none_at_0_and_grows_with_its_knob() -> None:
    spread = []
    for noise in (0.0, 1.0, 4.0):
        _, renderer = staged(noise=noise, size=(640, 360))
        difference = renderer.image_at(9.0).astype(np.float64) - renderer.image_at(9.0 + 1e-5)
        spread.append(float(difference[20:80, 20:120].std()) / np.sqrt(2.0))
    assert spread[0] == 0.0
    assert 0.5 < spread[1] < 3.0
    assert spread[2] == pytest.approx(4.0 * spread[1], rel=0.15)


def test_blur_softens_the_marker() -> None:
    sharpness = []
    for blur in (0.0, 1.0, 4.0):
        theatre, renderer = staged(blur=blur)
        low = theatre.truth_at(9.0).corners_px.min(axis=0).astype(int)
        grey = cv2.cvtColor(renderer.image_at(9.0), cv2.COLOR_BGR2GRAY)
        part = grey[low[1] - 10 : low[1] + 90, low[0] - 10 : low[0] + 90]
        # The steepest of the marker's edges, not the single best pixel.
        slopes = np.sort(np.abs(cv2.Sobel(part, cv2.CV_64F, 1, 0)).ravel())
        sharpness.append(float(slopes[-300:].mean()))
    assert sharpness[0] > 1.2 * sharpness[1] > 1.2 * 1.5 * sharpness[2]


def test_a_very_blurred_drill_has_no_cut_edges() -> None:
    theatre, renderer = staged(blur=10.0)
    empty = renderer.image_at(34.0).astype(np.int16)
    changed = np.abs(renderer.image_at(9.0) - empty).max(axis=2)
    # Right of the board, the drill's rightmost part, its blur fades out without a step.
    corners = theatre.truth_at(9.0).corners_px
    (_, top), (right, bottom) = corners.min(axis=0).astype(int), corners.max(axis=0).astype(int)
    tail = changed[top:bottom, right : right + 80].max(axis=0)
    assert tail[-1] == 0
    faint = tail[tail < 20]
    assert faint[0] > 10
    assert np.abs(np.diff(faint)).max() <= 7


def test_worse_light_is_dimmer_more_uneven_and_unsteady() -> None:
    means = []
    for light in (0.0, 1.0, 8.0):
        _, renderer = staged(light=light, size=(640, 360))
        means.append([float(renderer.image_at(at_s).mean()) for at_s in (32.5, 34.0, 72.5)])
    assert means[0][0] > means[1][0] > 1.3 * means[2][0]
    assert max(means[0]) == min(means[0])
    assert max(means[2]) - min(means[2]) > max(means[1]) - min(means[1]) > 0.0


def test_clutter_fills_the_drapes() -> None:
    edges = []
    for clutter in (0.0, 1.0, 8.0):
        _, renderer = staged(clutter=clutter, size=(640, 360))
        grey = cv2.cvtColor(renderer.image_at(34.0), cv2.COLOR_BGR2GRAY)
        edges.append(int((cv2.Canny(grey, 60, 150) > 0).sum()))
    assert edges[0] < edges[1] < edges[2]


def test_the_bone_occludes_the_burr_once_it_is_inside() -> None:
    theatre, renderer = staged()
    tip_is_dark = []
    for at_s in (9.0, 20.0):
        truth = theatre.truth_at(at_s)
        tip = theatre.camera.px_from_camera(truth.camera_from_tool.translation_mm)[0].astype(int)
        around = np.s_[tip[1] - 6 : tip[1] + 7, tip[0] - 6 : tip[0] + 7]
        empty = renderer.image_at(34.0)[around].astype(np.int16)
        difference = np.abs(renderer.image_at(at_s)[around] - empty).max(axis=2)
        tip_is_dark.append(float((difference > 60).mean()))
    assert tip_is_dark[0] > 0.1
    assert tip_is_dark[1] == 0.0


@pytest.mark.parametrize("size", [(640, 360), (641, 363)], ids=str)
def test_images_have_the_requested_size(size: tuple[int, int]) -> None:
    theatre, renderer = staged(size=size)
    for at_s in (1.0, 30.8, 37.6):
        image = renderer.image_at(at_s)
        assert image.shape == (size[1], size[0], 3)
        assert image.dtype == np.uint8
    offsets = edge_offsets_px(renderer.image_at(9.0), theatre, theatre.truth_at(9.0))
    assert np.abs(np.median(offsets, axis=1)).max() < 0.03
