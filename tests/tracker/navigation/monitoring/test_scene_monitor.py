"""Camera motion from images: shifts, rotations, hands, illumination, darkness."""

import cv2
import numpy as np
import numpy.typing as npt
import pytest

from tracker.navigation.monitoring import SceneMonitor, SceneSettings, SceneState

Picture = npt.NDArray[np.uint8]
SIZE = (1280, 720)
SETTINGS = SceneSettings(confirm_images=1)


def _scene(seed: int = 4) -> Picture:
    """Drapes, instruments and wounds: blobs of all sizes on uneven light."""
    rng = np.random.default_rng(seed)
    image = np.full((SIZE[1] + 200, SIZE[0] + 200), 110, np.uint8)
    for _ in range(160):
        centre = rng.integers(0, [SIZE[0] + 200, SIZE[1] + 200]).tolist()
        axes = rng.integers(8, 90, 2).tolist()
        cv2.ellipse(image, centre, axes, float(rng.uniform(0, 180)), 0, 360, int(rng.integers(30, 220)), -1)
    return np.asarray(cv2.GaussianBlur(image, (0, 0), 1.2), dtype=np.uint8)


WIDE = _scene()


def _seen(
    *,
    shift_px: tuple[float, float] = (0.0, 0.0),
    rotation_deg: float = 0.0,
    gain: float = 1.0,
    noise: int = 0,
) -> Picture:
    centre = (0.5 * SIZE[0], 0.5 * SIZE[1])
    move = np.asarray(cv2.getRotationMatrix2D(centre, rotation_deg, 1.0), dtype=np.float64)
    move[:, 2] += np.array(shift_px) - move[:, :2] @ [100.0, 100.0]
    image = cv2.warpAffine(WIDE, move, SIZE, flags=cv2.INTER_LINEAR, borderMode=cv2.BORDER_REFLECT)
    rough = image.astype(np.float64) * gain + np.random.default_rng(noise).normal(0.0, 2.0, image.shape)
    return np.asarray(np.clip(np.rint(rough), 0, 255), dtype=np.uint8)


@pytest.fixture
def watch() -> SceneMonitor:
    return SceneMonitor(_seen(), settings=SETTINGS)


def test_a_resting_camera_is_reported_at_rest(watch: SceneMonitor) -> None:
    for noise in range(1, 6):
        check = watch.check(_seen(noise=noise))
        assert check.state is SceneState.STILL
        assert check.moved_px < 0.3
        assert check.visible > 0.9 * check.patches


@pytest.mark.parametrize(
    ("shift_px", "rotation_deg", "moved_px"),
    [
        pytest.param((3.0, 0.0), 0.0, 3.0, id="three-pixels"),
        pytest.param((0.0, -2.0), 0.0, 2.0, id="two-pixels-up"),
        pytest.param((20.0, 9.0), 0.0, 21.9, id="a-knock"),
        pytest.param((150.0, -60.0), 0.0, 161.6, id="further-than-a-patch-is-followed"),
        pytest.param((0.0, 0.0), 1.5, 8.0, id="rolled"),
    ],
)
def test_a_camera_that_moved_is_noticed(
    watch: SceneMonitor, shift_px: tuple[float, float], rotation_deg: float, moved_px: float
) -> None:
    check = watch.check(_seen(shift_px=shift_px, rotation_deg=rotation_deg, noise=1))
    assert check.state is SceneState.MOVED
    assert check.moved_px == pytest.approx(moved_px, rel=0.35)


@pytest.mark.parametrize("gain", [0.45, 0.8, 1.15])
def test_a_lamp_that_is_turned_is_no_motion(watch: SceneMonitor, gain: float) -> None:
    assert watch.check(_seen(gain=gain, noise=1)).state is SceneState.STILL


def test_a_shadow_over_half_of_it_is_no_motion(watch: SceneMonitor) -> None:
    shade = np.where(np.arange(SIZE[0]) < 600, 0.5, 1.0)
    image = np.asarray(_seen(noise=1) * shade, dtype=np.uint8)
    assert watch.check(image).state is SceneState.STILL


def _with_hand(image: Picture, at_px: tuple[int, int]) -> Picture:
    out = image.copy()
    cv2.ellipse(out, at_px, (330, 250), 20.0, 0.0, 360.0, 175, -1)
    for n in range(6):
        cv2.line(
            out, (at_px[0] - 240, at_px[1] - 150 + 60 * n), (at_px[0] + 240, at_px[1] - 130 + 55 * n), 60, 5
        )
    return out


@pytest.mark.parametrize("at_px", [(300, 300), (640, 400), (1000, 500)])
def test_a_hand_that_moves_before_the_scene_is_no_motion(watch: SceneMonitor, at_px: tuple[int, int]) -> None:
    assert watch.check(_with_hand(_seen(noise=1), at_px)).state is SceneState.STILL


def test_behind_a_hand_a_motion_is_still_noticed(watch: SceneMonitor) -> None:
    moved = _with_hand(_seen(shift_px=(6.0, 2.0), noise=1), (300, 300))
    assert watch.check(moved).state is SceneState.MOVED


@pytest.mark.parametrize(
    "image",
    [
        pytest.param(np.zeros((720, 1280), np.uint8), id="dark"),
        pytest.param(np.full((720, 1280), 250, np.uint8), id="covered"),
        pytest.param(_scene(99)[:720, :1280], id="another-scene"),
        pytest.param(np.zeros((480, 640), np.uint8), id="another-size"),
    ],
)
def test_where_the_scene_is_gone_nothing_is_claimed(watch: SceneMonitor, image: Picture) -> None:
    assert watch.check(np.ascontiguousarray(image)).state is SceneState.UNSURE


def test_a_scene_without_texture_is_reported() -> None:
    bare = SceneMonitor(np.full((720, 1280), 120, np.uint8))
    assert bare.check(np.full((720, 1280), 120, np.uint8)).state is SceneState.NO_TEXTURE


def test_what_is_left_out_holds_no_patch() -> None:
    everything = np.array([[0.0, 0.0], [1280.0, 0.0], [1280.0, 720.0], [0.0, 720.0]])
    assert SceneMonitor(_seen(), exclude_px=(everything,)).check(_seen()).state is SceneState.NO_TEXTURE


def test_one_odd_look_is_no_motion_yet() -> None:
    watch = SceneMonitor(_seen(), settings=SceneSettings(confirm_images=2))
    states = [
        watch.check(_seen(shift_px=(x, 0.0), noise=n)).state for n, x in enumerate((5.0, 0.0, 5.0, 5.0))
    ]
    assert states == [SceneState.UNSURE, SceneState.STILL, SceneState.UNSURE, SceneState.MOVED]
