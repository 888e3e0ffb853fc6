"""A slice shows its plane in radiological orientation, with the LPS position of each pixel."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tracker.errors import PlanError
from tracker.geometry import rotation_from_vector
from tracker.plan import Channel, Volume
from tracker.plan.slices import (
    WINDOWS,
    Plane,
    Slice,
    Window,
    across_channel,
    along_channel,
    oblique_slice,
    patient_slice,
    reach_mm,
    shown,
)

PLANES: tuple[Plane, ...] = ("axial", "sagittal", "coronal")
EDGES = {"axial": "RLAP", "sagittal": "APHF", "coronal": "RLHF"}


def mountains(affine: np.ndarray, shape: tuple[int, int, int] = (24, 26, 28)) -> Volume:
    """HU is linear in LPS: 3 x - 2 y + 5 z, so that every pixel reveals its position."""
    volume = Volume(hu=np.zeros(shape, np.int16), lps_from_ijk=affine)
    k, j, i = np.meshgrid(*[np.arange(size) for size in shape], indexing="ij")
    hu = expected(volume.lps_from_index(np.stack([i, j, k], axis=-1)))
    return Volume(hu=np.rint(hu).astype(np.int16), lps_from_ijk=affine)


def expected(points: np.ndarray) -> np.ndarray:
    return points @ [3.0, -2.0, 5.0]


def placed(linear: np.ndarray, middle: tuple[float, float, float] = (5.0, -8.0, 60.0)) -> np.ndarray:
    affine = np.eye(4)
    affine[:3, :3] = linear
    affine[:3, 3] = np.array(middle) - linear @ [13.5, 12.5, 11.5]
    return affine


def image_context_of(one: Slice) -> np.ndarray:
    columns, rows = one.size_wh_px
    u, v = np.meshgrid(np.arange(columns), np.arange(rows))
    return one.lps_from_pixel(np.stack([u, v], axis=-1))


TILT = np.tan(np.radians(15.0))
VOLUMES = {
    "head-first": np.diag([1.0, 1.0, 2.0]),
    "feet-first-and-face-down": np.diag([-0.7, -0.9, -1.5]),
    "mirrored": np.diag([1.0, -1.0, 2.0]),
    "sagittal-slices": np.array([[0, 0, 2.0], [1.0, 0, 0], [0, -1.0, 0]]),
    "coronal-slices": np.array([[1.0, 0, 0], [0, 0, -2.0], [0, -1.0, 0]]),
    "tilted-gantry": np.array([[1.0, 0, 0], [0, 1.0, -2.0 * TILT], [0, 0, 2.0]]),
    "oblique": rotation_from_vector(np.array([0.3, -0.2, 0.4])) @ np.diag([1.0, 1.0, 2.0]),
}


@pytest.mark.parametrize("plane", PLANES)
@pytest.mark.parametrize("linear", VOLUMES.values(), ids=VOLUMES.keys())
def test_every_pixel_shows_the_content_at_its_stated_position(linear: np.ndarray, plane: Plane) -> None:
    volume = mountains(placed(linear))
    low, high, step = reach_mm(volume, plane)
    for at_mm in (low + 0.5 * (high - low), low + 0.371 * (high - low), low + 2.0 * step):
        one = patient_slice(volume, plane, at_mm)
        points = image_context_of(one)
        inside = volume.contains(points)
        assert inside.sum() > 10
        assert np.abs(one.hu - expected(points))[inside].max() <= 1.0 + 1e-6
        assert (one.hu[~inside] == -1024).all()
        axis = {"axial": 2, "sagittal": 0, "coronal": 1}[plane]
        assert np.abs(points[..., axis] - at_mm).max() < 0.002 * step


@pytest.mark.parametrize("plane", PLANES)
@pytest.mark.parametrize("linear", VOLUMES.values(), ids=VOLUMES.keys())
def test_the_patients_right_is_on_the_images_left(linear: np.ndarray, plane: Plane) -> None:
    volume = mountains(placed(linear))
    edges = patient_slice(volume, plane, sum(reach_mm(volume, plane)[:2]) / 2.0).edges
    assert edges.left + edges.right + edges.top + edges.bottom == EDGES[plane]


@pytest.mark.parametrize("name", [name for name in VOLUMES if name not in {"tilted-gantry", "oblique"}])
@pytest.mark.parametrize("plane", PLANES)
def test_the_scanners_own_pixels_are_not_touched(name: str, plane: Plane) -> None:
    volume = mountains(placed(VOLUMES[name]))
    noise = np.random.default_rng(3).integers(-1000, 2000, volume.hu.shape).astype(np.int16)
    volume = Volume(hu=noise, lps_from_ijk=volume.lps_from_ijk)
    low, _, step = reach_mm(volume, plane)
    one = patient_slice(volume, plane, low + 3.0 * step)
    index = np.rint(volume.index_from_lps(image_context_of(one))).astype(int)
    assert np.array_equal(one.hu, noise[index[..., 2], index[..., 1], index[..., 0]])


def test_an_axial_slice_of_a_tilted_gantry_is_the_scanners_own() -> None:
    volume = mountains(placed(VOLUMES["tilted-gantry"]))
    one = patient_slice(volume, "axial", reach_mm(volume, "axial")[0] + 4.0)
    assert np.array_equal(one.hu, volume.hu[2])
    assert one.lps_from_pixel([0.0, 0.0]) == pytest.approx(volume.lps_from_index([0, 0, 2]))


def test_a_marked_voxel_is_seen_in_all_three_planes() -> None:
    affine = placed(VOLUMES["oblique"])
    hu = np.zeros((24, 26, 28), np.int16)
    hu[9:12, 11:14, 17:20] = 1000
    volume = Volume(hu=hu, lps_from_ijk=affine)
    point = volume.lps_from_index([18, 12, 10])
    for plane, axis in zip(PLANES, (2, 0, 1), strict=True):
        one = patient_slice(volume, plane, point[axis])
        u, v = np.rint(one.pixel_from_lps(point)).astype(int)
        assert one.hu[v, u] > 700
        assert one.beyond_mm(point) == pytest.approx(0.0, abs=1e-9)


@given(
    pixel=st.tuples(st.floats(-50, 600), st.floats(-50, 600)),
    turn=st.floats(-400.0, 400.0),
    aim=st.tuples(st.floats(-1, 1), st.floats(-1, 1), st.floats(-1, 1)).filter(
        lambda one: np.linalg.norm(one) > 0.1
    ),
)
@settings(max_examples=60, deadline=None)
def test_a_slice_along_a_channel_holds_its_axis_at_any_turn(
    pixel: tuple[float, float], turn: float, aim: tuple[float, float, float]
) -> None:
    volume = mountains(placed(VOLUMES["oblique"]))
    entry = np.array([5.0, -4.0, 61.0])
    target = entry + 12.0 * np.array(aim) / np.linalg.norm(aim)
    channel = Channel(name="L3", entry_in_vertebra_mm=entry, target_in_vertebra_mm=target, radius_mm=3.0)
    one = along_channel(volume, channel, rotation_deg=turn, size_mm=(20.0, 20.0), pixel_mm=1.0)
    assert np.abs(one.beyond_mm(np.array([entry, target]))).max() < 1e-9
    # Entry below, target above, both in the middle column.
    assert one.pixel_from_lps(entry) == pytest.approx([10.0, 16.0])
    assert one.pixel_from_lps(target) == pytest.approx([10.0, 4.0])
    assert one.pixel_from_lps(one.lps_from_pixel(pixel)) == pytest.approx(pixel, abs=1e-6)
    across = across_channel(volume, channel, depth_mm=5.0, size_mm=(20.0, 20.0), pixel_mm=1.0)
    assert across.normal_lps == pytest.approx(channel.axis_in_vertebra)
    assert across.lps_from_pixel([10.0, 10.0]) == pytest.approx(entry + 5.0 * channel.axis_in_vertebra)
    points = image_context_of(one)
    inside = volume.contains(points)
    assert np.abs(one.hu - expected(points))[inside].max(initial=0.0) <= 1.0 + 1e-6


def test_a_channel_forwards_is_shown_as_in_an_axial_slice() -> None:
    volume = mountains(placed(VOLUMES["head-first"]))
    channel = Channel(
        name="L3",
        entry_in_vertebra_mm=np.array([5.0, 0.0, 60.0]),
        target_in_vertebra_mm=np.array([5.0, -12.0, 60.0]),
        radius_mm=3.0,
    )
    flat, turned = (along_channel(volume, channel, rotation_deg=turn).edges for turn in (0.0, 90.0))
    across = across_channel(volume, channel, depth_mm=3.0).edges
    assert flat.left + flat.right + flat.top + flat.bottom == "RLAP"
    assert turned.left + turned.right + turned.top + turned.bottom == "FHAP"
    # Seen from behind, as the surgeon does with the patient face down.
    assert across.left + across.right + across.top + across.bottom == "LRHF"


def test_a_slanted_edge_has_two_letters() -> None:
    volume = mountains(placed(VOLUMES["head-first"]))
    one = oblique_slice(
        volume, centre_lps_mm=[5, -8, 60], right_lps=[2, 1.2, 0], down_lps=[0, 0, -1], size_mm=(10, 10)
    )
    assert (one.edges.left, one.edges.right, one.edges.top) == ("RA", "LP", "H")


def test_a_slab_shows_the_highest_value_in_its_thickness() -> None:
    hu = np.zeros((20, 20, 20), np.int16)
    hu[13, 7, 5] = 900
    volume = Volume(hu=hu, lps_from_ijk=np.eye(4))
    assert patient_slice(volume, "axial", 10.0, slab_mm=4.0).hu.max() == 0
    one = patient_slice(volume, "axial", 10.0, slab_mm=6.0)
    assert one.hu.max() == 900
    assert np.argwhere(one.hu == 900).tolist() == [[7, 5]]
    assert one.lps_from_pixel([5, 7]) == pytest.approx([5.0, 7.0, 10.0])


@pytest.mark.parametrize(
    ("hu", "window", "grey"),
    [
        pytest.param(400, "bone", 128, id="level-is-grey"),
        pytest.param(-500, "bone", 0, id="half-a-width-below-is-black"),
        pytest.param(1300, "bone", 255, id="half-a-width-above-is-white"),
        pytest.param(-501, "bone", 0, id="below-is-black"),
        pytest.param(1301, "bone", 255, id="above-is-white"),
        pytest.param(850, "bone", 191, id="three-quarters"),
        pytest.param(-32768, "soft tissue", 0, id="least-number"),
        pytest.param(32767, "soft tissue", 255, id="greatest-number"),
    ],
)
def test_window_and_level(hu: int, window: str, grey: int) -> None:
    assert shown(np.array([[hu]], np.int16), WINDOWS[window]).tolist() == [[grey]]


@pytest.mark.parametrize(
    ("code", "ask"),
    [
        pytest.param("SLICE_OUTSIDE", lambda one: patient_slice(one, "axial", 1e4), id="outside"),
        pytest.param("SLICE_OUTSIDE", lambda one: patient_slice(one, "axial", np.nan), id="nowhere"),
        pytest.param(
            "SLICE_TOO_LARGE", lambda one: patient_slice(one, "axial", 60.0, pixel_mm=1e-4), id="tiny-pixels"
        ),
        pytest.param(
            "SLICE_TOO_LARGE", lambda one: patient_slice(one, "axial", 60.0, pixel_mm=0.0), id="no-pixels"
        ),
        pytest.param("SLAB_INVALID", lambda one: patient_slice(one, "axial", 60.0, slab_mm=-1.0), id="slab"),
        pytest.param("WINDOW_INVALID", lambda _: Window(centre_hu=0.0, width_hu=0.0), id="no-window"),
        pytest.param(
            "PLANE_INVALID",
            lambda one: oblique_slice(
                one, centre_lps_mm=[0, 0, 0], right_lps=[1, 0, 0], down_lps=[2, 0, 0], size_mm=(5, 5)
            ),
            id="no-plane",
        ),
    ],
)
def test_what_cannot_be_shown_is_rejected(code: str, ask: object) -> None:
    with pytest.raises(PlanError) as caught:
        ask(mountains(placed(VOLUMES["head-first"])))  # pyrefly: ignore[not-callable]  # the table holds functions
    assert caught.value.code == code
