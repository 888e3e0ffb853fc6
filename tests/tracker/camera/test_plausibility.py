"""Implausible lenses are rejected, real ones are not, and no accepted lens folds the image."""

from collections.abc import Callable, Sequence

import numpy as np
import pytest
from hypothesis import given, reject, settings
from hypothesis import strategies as st
from scipy.optimize import least_squares

from tests.real_data import real_data_file
from tracker import CameraModel, InvalidInput
from tracker.geometry import Array

SIZE = (1920, 1080)
NAMES = ("k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6", "s1", "s2", "s3", "s4", "tx", "ty")
MAX_ROUND_TRIP_PX = 0.1


def camera(
    focal_px: float | tuple[float, float] = 1400.0,
    distortion: Sequence[float] | Array = (),
    size_wh_px: tuple[int, int] = SIZE,
    centre_px: tuple[float, float] | None = None,
) -> CameraModel:
    width, height = size_wh_px
    fx, fy = focal_px if isinstance(focal_px, tuple) else (focal_px, focal_px)
    cx, cy = centre_px or ((width - 1) / 2, (height - 1) / 2)
    matrix = np.array([[fx, 0.0, cx], [0.0, fy, cy], [0.0, 0.0, 1.0]])
    return CameraModel(matrix=matrix, distortion=np.array(distortion), size_wh_px=size_wh_px)


def coefficients(**values: float) -> list[float]:
    """Return OpenCV's 14 coefficients from those that are not zero."""
    return [values.get(name, 0.0) for name in NAMES]


@pytest.mark.parametrize(
    ("make", "message", "remedy"),
    [
        pytest.param(
            lambda: camera(1e9),
            r"1e\+09 and 1e\+09 px an image of 1920x1080 px shows 0.00013 deg .* needed 0.5 deg",
            "in pixels",
            id="a-telescope",
        ),
        pytest.param(
            lambda: camera(110.0, size_wh_px=(1000, 1000)),
            r"farther than 80 deg from its axis, .* that is \(58, 58\) px, inside of 1000x1000 px",
            "in pixels",
            id="a-pinhole-of-162-deg",
        ),
        pytest.param(
            lambda: camera((1400.0, 700.0)),
            "1400 and 700 px, a ratio of 2, allowed 1.5",
            "fx and fy",
            id="fx-twice-fy",
        ),
        pytest.param(
            lambda: camera((1400.0, 2800.0)),
            "1400 and 2800 px, a ratio of 2, allowed 1.5",
            "fx and fy",
            id="fy-twice",
        ),
        pytest.param(
            lambda: camera(centre_px=(1920.0, 540.0)),
            "1920, 540.* outside",
            "cx and cy",
            id="axis-beside-image",
        ),
        pytest.param(
            lambda: camera(distortion=coefficients(k1=1e6)),
            "stretches the image .* times, allowed 5, at 0.* deg",
            "k1 k2 p1 p2 k3",
            id="k1-of-a-million",
        ),
        *(
            pytest.param(
                lambda name=name, value=value: camera(distortion=coefficients(**{name: value})),
                "its distortion|its sensor tilts",
                "k1 k2 p1 p2 k3",
                id=f"{name}={value:g}",
            )
            for name in NAMES
            for value in (1e6, -1e6, 1e300)
        ),
        # 1 + 3 k1 r^2 is 0 at r = 0.72 or 35.7 deg; the corner of the image is 38.2 deg away without a lens.
        pytest.param(
            lambda: camera(distortion=[-0.65, 0.0, 0.0, 0.0]),
            "its distortion (folds the image|leaves .*, needed 0.02), at 3[567].* deg",
            "corners",
            id="folds-before-the-corner",
        ),
        # The rational model's denominator is 0 at r = 0.5.
        pytest.param(
            lambda: camera(distortion=coefficients(k4=-4.0)),
            "its distortion stretches",
            "corners",
            id="a-pole",
        ),
        # In mm, as in a data sheet.
        pytest.param(lambda: camera(3.6), "at least 192 px", "OpenCV", id="focal-length-in-mm"),
    ],
)
def test_what_no_lens_can_be_is_rejected_with_its_numbers(
    make: Callable[[], CameraModel], message: str, remedy: str
) -> None:
    with pytest.raises(InvalidInput, match=message) as caught:
        make()
    assert caught.value.code == "CAMERA_MODEL_INVALID"
    assert remedy in caught.value.remedy


@pytest.mark.parametrize("size", [(1920.5, 1080), (1920, np.nan), (np.inf, 1080), (1920,), (1920, 1080, 3)])
def test_an_image_has_two_whole_numbers_of_pixels(size: tuple[float, ...]) -> None:
    with pytest.raises(InvalidInput, match="needed two whole numbers") as caught:
        CameraModel(matrix=camera().matrix, distortion=np.zeros(5), size_wh_px=size)  # pyrefly: ignore[bad-argument-type]
    assert caught.value.code == "CAMERA_MODEL_INVALID"


def test_a_file_with_half_a_pixel_is_rejected_and_one_with_1920_0_is_not() -> None:
    values = {"matrix": camera().matrix.tolist(), "distortion": [0.0] * 5}
    with pytest.raises(InvalidInput, match=r"1920.5x1080.0 px"):
        CameraModel.from_mapping({**values, "size_wh_px": [1920.5, 1080]})
    read = CameraModel.from_mapping({**values, "size_wh_px": [1920.0, 1080]})
    assert read.size_wh_px == SIZE
    assert all(isinstance(one, int) for one in read.size_wh_px)


@pytest.mark.parametrize(
    "make",
    [
        pytest.param(lambda: camera(1.0e5), id="microscope-1.3-deg"),
        pytest.param(
            lambda: camera(3.0e4, [-0.3, 40.0, 0.0, 0.0, -2000.0]), id="telephoto-with-large-coefficients"
        ),
        pytest.param(lambda: camera(500.0), id="rectilinear-131-deg"),
        pytest.param(lambda: camera((1050.0, 1145.0), size_wh_px=(720, 576)), id="pal-pixels-1.09"),
        pytest.param(lambda: camera((1050.0, 1527.0), size_wh_px=(720, 576)), id="wide-pal-pixels-1.45"),
        pytest.param(lambda: camera((1400.0, 1050.0), size_wh_px=(1440, 1080)), id="hdv-pixels-4:3"),
        # The webcam of OpenCV's documentation.
        pytest.param(lambda: camera(536.0, [-0.265, -0.047, 0.002, -0.0003, 0.252], (640, 480)), id="webcam"),
        pytest.param(lambda: camera(distortion=coefficients(k1=-0.1, tx=0.2, ty=-0.15)), id="tilted-sensor"),
        pytest.param(lambda: camera(distortion=coefficients(k1=0.2, k2=0.05)), id="pincushion"),
        pytest.param(lambda: camera(centre_px=(1500.0, 200.0)), id="a-region-beside-the-axis"),
    ],
)
def test_a_real_lens_is_accepted_and_its_distortion_inverted(make: Callable[[], CameraModel]) -> None:
    assert_one_to_one(make())


def test_the_published_calibration_of_a_laparoscope_is_accepted() -> None:
    folder = "calibration", "metal-dot-grid"
    matrix = np.loadtxt(real_data_file(*folder, "calib.left.intrinsics.txt"))
    distortion = np.loadtxt(real_data_file(*folder, "calib.left.distortion.txt"))
    assert_one_to_one(CameraModel(matrix=matrix, distortion=distortion, size_wh_px=SIZE))


FISHEYES = {
    "equidistant": lambda angle: angle,
    "equisolid": lambda angle: 2.0 * np.sin(angle / 2.0),
    "stereographic": lambda angle: 2.0 * np.tan(angle / 2.0),
}


@pytest.mark.parametrize("corner_deg", [45.0, 60.0, 70.0])
@pytest.mark.parametrize("kind", FISHEYES)
def test_wide_lenses_in_the_rational_model_are_accepted(kind: str, corner_deg: float) -> None:
    """OpenCV's 8 coefficients, fitted to a fisheye lens that sees up to 140 deg between opposite corners."""
    angle = np.linspace(0.0, np.radians(corner_deg + 1.0), 200)
    r, wanted = np.tan(angle), FISHEYES[kind](angle)
    r2 = r * r

    def bent(k: Array) -> Array:
        above = 1 + r2 * (k[0] + r2 * (k[1] + r2 * k[2]))
        return np.asarray(r * above / (1 + r2 * (k[3] + r2 * (k[4] + r2 * k[5]))) - wanted)

    k = least_squares(bent, np.zeros(6), x_scale="jac", max_nfev=2000).x
    focal = float(np.hypot(*SIZE) / 2 / FISHEYES[kind](np.radians(corner_deg)))
    fitted = camera(focal, [k[0], k[1], 0.0, 0.0, *k[2:]])
    assert_one_to_one(fitted)
    corner = fitted.normalised_from_px([[-0.5, -0.5]])[0]
    assert np.degrees(np.arctan(np.linalg.norm(corner))) == pytest.approx(corner_deg, abs=0.2)


lens_sizes = st.sampled_from([(640, 480), (720, 576), (1280, 720), (1920, 1080), (1080, 1920), (4096, 3000)])


@settings(max_examples=40, deadline=None)
@given(
    size=lens_sizes,
    corner_deg=st.floats(1.0, 60.0),
    aspect=st.floats(0.75, 1.33),
    shift=st.tuples(st.floats(-0.08, 0.08), st.floats(-0.08, 0.08)),
    barrel=st.floats(-0.1, 0.12),
    second=st.floats(-0.005, 0.03),
    decentring=st.tuples(st.floats(-0.005, 0.005), st.floats(-0.005, 0.005)),
    tilt_rad=st.floats(-0.05, 0.05),
)
def test_every_usual_lens_is_accepted_and_its_distortion_inverted(
    size: tuple[int, int],
    corner_deg: float,
    aspect: float,
    shift: tuple[float, float],
    barrel: float,
    second: float,
    decentring: tuple[float, float],
    tilt_rad: float,
) -> None:
    """Drawn by their effect at the corner: up to 10 % of barrel, 12 % of pincushion, other terms less."""
    width, height = size
    focal = float(np.hypot(width, height) / 2 / np.tan(np.radians(corner_deg)))
    centre = (width * (0.5 + shift[0]), height * (0.5 + shift[1]))
    far = np.maximum(centre, np.array(size) - centre) / [focal, focal * aspect]
    corner = float(np.linalg.norm(far))
    lens = coefficients(
        k1=barrel / corner**2,
        k2=second / corner**4,
        p1=decentring[0] / corner,
        p2=decentring[1] / corner,
        tx=tilt_rad,
    )
    assert_one_to_one(camera((focal, focal * aspect), lens, size, centre))


@settings(max_examples=60, deadline=None)
@given(
    size=lens_sizes,
    corner_deg=st.floats(0.5, 79.0),
    centre=st.tuples(st.floats(0.05, 0.95), st.floats(0.05, 0.95)),
    strength=st.floats(0.02, 1.0),
    radial=st.lists(st.floats(-1.0, 1.0), min_size=6, max_size=6),
    others=st.lists(st.floats(-0.15, 0.15), min_size=6, max_size=6),
    tilt_rad=st.tuples(st.floats(-0.6, 0.6), st.floats(-0.6, 0.6)),
    used=st.sampled_from([4, 5, 8, 12, 14]),
)
def test_no_accepted_camera_folds_the_image(
    size: tuple[int, int],
    corner_deg: float,
    centre: tuple[float, float],
    strength: float,
    radial: list[float],
    others: list[float],
    tilt_rad: tuple[float, float],
    used: int,
) -> None:
    """Coefficients that move the corner by up to its distance: most fold, and are rejected."""
    corner = np.tan(np.radians(corner_deg))
    k1, k2, k3, k4, k5, k6 = strength * np.array(radial) / corner ** np.array([2, 4, 6, 2, 4, 6])
    p1, p2, s1, s2, s3, s4 = strength * np.array(others) / corner ** np.array([1, 1, 1, 3, 1, 3])
    lens = [k1, k2, p1, p2, k3, k4, k5, k6, s1, s2, s3, s4, *tilt_rad][:used]
    focal = float(np.hypot(*size) / 2 / corner)
    try:
        accepted = camera(focal, lens, size, (size[0] * centre[0], size[1] * centre[1]))
    except InvalidInput:
        reject()
    assert_one_to_one(accepted)


def assert_one_to_one(model: CameraModel) -> None:
    """Each pixel has a direction that projects onto it, and neighbours keep their order.

    With the Jacobian of finite differences between pixels, independent of the check under test.
    """
    width, height = model.size_wh_px
    u, v = np.meshgrid(np.linspace(0.0, width - 1.0, 43), np.linspace(0.0, height - 1.0, 31))
    px = np.stack([u, v], axis=-1)
    seen = model.normalised_from_px(px.reshape(-1, 2))
    back = model.px_from_camera(np.column_stack([seen, np.ones(len(seen))]))
    np.testing.assert_allclose(back.reshape(px.shape), px, rtol=0.0, atol=MAX_ROUND_TRIP_PX)
    grid = seen.reshape(px.shape)
    right, down = np.diff(grid, axis=1)[:-1], np.diff(grid, axis=0)[:, :-1]
    assert (right[..., 0] * down[..., 1] - right[..., 1] * down[..., 0] > 0.0).all()


def test_a_fit_that_no_lens_can_be_is_reported_but_not_taken_into_use() -> None:
    width, height = SIZE
    matrix = np.array([[1400.0, 0.0, width / 2], [0.0, 1400.0, height / 2], [0.0, 0.0, 1.0]])
    fit = CameraModel(matrix=matrix, distortion=np.array([-0.65, 0, 0, 0]), size_wh_px=SIZE, is_fit=True)
    with pytest.raises(InvalidInput, match="its distortion"):
        fit.require_plausible()
