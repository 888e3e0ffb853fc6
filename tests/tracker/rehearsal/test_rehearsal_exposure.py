"""Noise, blur and strips: renderer optimisations do not change measured values."""

from functools import lru_cache
from itertools import pairwise

import numpy as np
import numpy.typing as npt
import pytest

from tests.tracker.rehearsal.stills import STILLS
from tracker.geometry import Array
from tracker.rehearsal import Event, EventKind, Renderer, Skill, Theatre, TheatreSettings, strips
from tracker.rehearsal.point_spread import DEFOCUS_PX, EXPOSURE_S, MAX_EXPOSURE_S, point_spread
from tracker.rehearsal.printed_plane import PrintedPlane

SIZE = (960, 540)
DRILL_AWAY_S = 34.0


@lru_cache(maxsize=6)
def staged(
    noise: float = 1.0, light: float = 0.0, *, events: tuple[Event, ...] = ()
) -> tuple[Theatre, Renderer]:
    settings = TheatreSettings(
        seed=3,
        size_wh_px=SIZE,
        noise=noise,
        light=light,
        skill=Skill.WANDERING,
        reference=True,
        events=events,
    )
    theatre = Theatre(settings)
    renderer = theatre.renderer(store=STILLS)
    assert isinstance(renderer, Renderer)
    return theatre, renderer


def inside(corners_px: Array) -> tuple[slice, slice]:
    """The middle of a marker."""
    low, high = corners_px.min(axis=0), corners_px.max(axis=0)
    left, top = np.ceil(low + 0.15 * (high - low)).astype(int)
    right, bottom = np.floor(high - 0.15 * (high - low)).astype(int)
    return slice(top, bottom), slice(left, right)


def marker_at(theatre: Theatre, name: str, at_s: float) -> tuple[slice, slice]:
    truth = theatre.truth_at(at_s)
    if name == "drill":
        return inside(truth.corners_px)
    assert truth.camera_from_reference is not None
    square = np.array([[-1, 1, 0], [1, 1, 0], [1, -1, 0], [-1, -1, 0]]) * 15.0
    return inside(theatre.camera.px_from_camera(truth.camera_from_reference.move_points(square)))


@lru_cache(maxsize=24)
def image_of(noise: float, at_s: float) -> npt.NDArray[np.uint8]:
    """The image, which shows both markers; tests of one and of the other share it."""
    return staged(noise)[1].image_at(at_s)


def noise_of(at_s: float, where: tuple[slice, slice]) -> npt.NDArray[np.float64]:
    return image_of(1.0, at_s)[where].astype(np.float64) - image_of(0.0, at_s)[where]


def test_no_two_images_are_equal_even_where_nothing_moves() -> None:
    settings = TheatreSettings(seed=3, size_wh_px=(320, 180), light=0.0)
    renderer = Theatre(settings).renderer()
    images = {renderer.image_at(DRILL_AWAY_S + number / 30.0).tobytes() for number in range(60)}
    assert len(images) == 60


@pytest.mark.parametrize("name", ["drill", "reference"])
def test_a_markers_noise_is_as_strong_as_its_light_makes_it(name: str) -> None:
    theatre, _ = staged(0.0)
    off, expected = [], []
    for at_s in (9.0, 12.5, 20.0):
        where = marker_at(theatre, name, at_s)
        levels = image_of(0.0, at_s)[where]
        plain = levels[(levels > 4) & (levels < 240)].astype(np.float64)
        off.append((noise_of(at_s, where)[(levels > 4) & (levels < 240)] ** 2).mean())
        # Of shot and read noise, and of rounding to whole levels.
        expected.append((0.6**2 + 0.012 * plain + 1.0 / 12.0).mean())
    assert np.mean(off) == pytest.approx(np.mean(expected), rel=0.05)


@pytest.mark.parametrize("name", ["drill", "reference"])
def test_a_markers_noise_is_new_in_each_image(name: str) -> None:
    theatre, _ = staged(0.0)
    times_s = [20.0 + number / 30.0 for number in range(4)]
    fields = [noise_of(at_s, marker_at(theatre, name, at_s)) for at_s in times_s]
    rows, columns = (min(field.shape[axis] for field in fields) for axis in (0, 1))
    inner = np.s_[8 : rows - 8, 8 : columns - 8]
    for one, other in pairwise(fields):
        # Nor is it the previous noise, shifted slightly.
        moved = [
            np.roll(other[:rows, :columns], (down, across), axis=(0, 1))[inner]
            for down in range(-8, 9, 2)
            for across in range(-8, 9, 2)
        ]
        here = one[:rows, :columns][inner].ravel()
        assert max(abs(np.corrcoef(here, there.ravel())[0, 1]) for there in moved) < 0.12


def test_noise_never_wraps_around_black_or_white() -> None:
    noisy, clean = staged(10.0, 10.0)[1], staged(0.0, 10.0)[1]
    for at_s in (DRILL_AWAY_S, DRILL_AWAY_S + 0.7):
        off = noisy.image_at(at_s).astype(np.int16) - clean.image_at(at_s)
        # Six deviations of a white pixel's noise.
        assert np.abs(off).max() < 6.0 * 10.0 * 1.85


def test_a_jump_causes_no_motion_blur() -> None:
    jump = Event(kind=EventKind.DRILL_JUMPS, at_s=20.0, size_mm=20.0)
    theatre, renderer = staged(0.0, events=(jump,))
    steepest = []
    for at_s in (20.0, 20.0 + 1.0 / 30.0):
        grey = renderer.image_at(at_s)[marker_at(theatre, "drill", at_s)][..., 1].astype(np.float64)
        steepest.append(np.sort(np.abs(np.diff(grey, axis=1)).ravel())[-50:].mean())
    assert steepest[0] == pytest.approx(steepest[1], rel=0.15)


def test_strips_show_what_one_large_rectangle_would(monkeypatch: pytest.MonkeyPatch) -> None:
    _, renderer = staged(0.0)
    times_s = (0.4, 16.0, 30.8)
    in_strips = [renderer.image_at(at_s).astype(np.int16) for at_s in times_s]
    monkeypatch.setattr(strips, "STRIP_PX", 544)
    for image, at_s in zip(in_strips, times_s, strict=True):
        assert np.abs(image - renderer.image_at(at_s)).max() <= 2


@pytest.mark.parametrize("blur", [0.8, 1.0, 4.0, 10.0])
@pytest.mark.parametrize("speed_px_s", [(0.0, 0.0), (20.0, -12.0), (90.0, 60.0), (-300.0, 210.0)], ids=str)
def test_a_point_is_spread_as_defocus_and_motion_spread_it(
    blur: float, speed_px_s: tuple[float, float]
) -> None:
    spread = point_spread(blur, np.array(speed_px_s))
    assert spread is not None
    kernel = np.einsum("ny,nx->yx", spread.along_y, spread.along_x)
    assert kernel.sum() == pytest.approx(1.0)
    at = np.arange(kernel.shape[0]) - kernel.shape[0] // 2
    mean = np.array([(kernel * at[None, :]).sum(), (kernel * at[:, None]).sum()])
    np.testing.assert_allclose(mean, 0.0, atol=1e-6)
    path = np.array(speed_px_s) * min(EXPOSURE_S * blur, MAX_EXPOSURE_S)
    expected = (DEFOCUS_PX * blur) ** 2 * np.eye(2) + np.outer(path, path) / 12.0
    found = np.array(
        [
            [(kernel * at[None, :] ** 2).sum(), (kernel * np.outer(at, at)).sum()],
            [(kernel * np.outer(at, at)).sum(), (kernel * at[:, None] ** 2).sum()],
        ]
    )
    np.testing.assert_allclose(found, expected, atol=0.02 + 0.06 * expected.max())
    even = np.full((24, 24, 4), 255, dtype=np.uint8)
    assert spread.of(even).min() == 255


def test_fewer_samples_are_taken_only_where_blur_hides_their_softness() -> None:
    theatre, _ = staged(0.0)
    pose = theatre.truth_at(9.0).camera_from_marker
    plane = PrintedPlane(np.full((560, 560), 200, dtype=np.uint8), per_mm=16.0, middle_px=(280.0, 280.0))
    for blur_px2, samples in ((0.0, 4), (0.05, 3), (0.36, 1)):
        sampled = plane.sampled(theatre.camera, pose, blur_px2=blur_px2)
        assert sampled.samples == samples
        assert sampled.drawn_px2 <= max(blur_px2, 0.0)


def test_a_drill_that_leaves_the_image_is_drawn_at_every_place() -> None:
    renderer = Theatre(TheatreSettings(seed=1, size_wh_px=(640, 360))).renderer(store=STILLS)
    for number in range(285, 316):
        image = renderer.image_at(number / 10.0)
        assert image.shape == (360, 640, 3)
