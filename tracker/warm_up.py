"""Compile all kernels ahead, so that nothing compiles in theatre: `python -m tracker.warm_up`.

Chaining, matching and fitting are loops that NumPy cannot express, and 30 Hz on two cores leaves no time for
Python in them. Numba costs 190 MB of packages and a minute at the first start; an extension in C++ would need
a build step on every machine.
"""

from enum import StrEnum

import numpy as np
import numpy.typing as npt

from tracker.camera import CameraModel
from tracker.edges import GreyImage
from tracker.geometry import Array, Camera, Marker, Rigid, Tool, Vertebra
from tracker.marker import MarkerModel, photometric_fit_of
from tracker.navigation.clearance import bone_distance_field
from tracker.navigation.uncertainty import Drill, PedicleTolerance, UncertainPose, analyse_drill
from tracker.photometric import focal_length_error, refine_poses, textures_of
from tracker.pipeline import Tracker
from tracker.pipeline.image import WarmUpImage, warm_up_image
from tracker.plan import Channel, Surface
from tracker.plan.pedicle import tube_model
from tracker.plan.pedicle.wall_kernels import smooth_curves, walls_around
from tracker.rehearsal.layer_kernels import Axis, Portrait, composite, draw_body

# Start of the occluded corner, from the marker's centre to its top right corner, in sides.
OCCLUDED_FROM_RATIO = 0.3


class Part(StrEnum):
    """Groups of kernels that can be compiled separately; together they contain all kernels."""

    SEARCH = "search"  # search and tracking of a marker
    FIT = "fit"  # photometric refinement of a pose, the last step of tracking
    REST = "rest"  # verification under uneven illumination, distances, CT sections, the rehearsal's drill


def warm_up(*parts: Part) -> None:
    """Run every kernel of the given parts once; of all parts where none is named."""
    camera = CameraModel(
        matrix=np.array([[400.0, 0.0, 159.5], [0.0, 400.0, 119.5], [0.0, 0.0, 1.0]]),
        distortion=np.zeros(5),
        size_wh_px=(320, 240),
    )
    marker = np.zeros((64, 64), np.uint8)
    marker[16:48, 16:32] = 255
    marker[32:48, 16:48] = 255
    model = MarkerModel.from_image(marker, side_mm=25.0, name="warm-up")
    picture = warm_up_image(model.square, size_wh_px=camera.size_wh_px)
    half_shadowed = _half_in_shadow(picture)
    for part in parts or Part:
        match part:
            case Part.SEARCH:
                _search(model, picture, camera)
            case Part.FIT:
                _fit(model, picture, half_shadowed, camera)
            case Part.REST:
                _verify(model, picture, half_shadowed)
                _judge()
                _outline()
                _pedicle()
                _draw()


def _search(model: MarkerModel, picture: WarmUpImage, camera: CameraModel) -> None:
    """Track a marker in a synthetic image, after the tracker's own warm-up."""
    tracker = Tracker(camera=camera, models=[model])
    for at_s in (0.0, 0.03, 0.06):
        tracker.step(picture.image, captured_at_s=at_s)


def _outline() -> None:
    """Compute the outline of a section through a block without bone."""
    block = np.zeros((2, 2, 2), np.float32)
    radius = np.empty((1, 1))
    walls_around(block, np.zeros((1, 3)), np.ones((1, 1, 3)), 2, 1.0, 1, radius)
    smooth_curves(radius, np.ones((1, 1)), np.ones(1), 1, 1.0, np.empty((1, 1)), np.empty((1, 1), np.bool_))


def _pedicle() -> None:
    """Compare one voxel with a round pedicle."""
    one = tube_model.Samples(rows=np.ones((1, 7)), offsets=np.zeros((1, 3)), hu=np.zeros(1))
    tube_model.model_hu(np.zeros(tube_model.COUNT), one)
    tube_model.wall_distance_mm(np.zeros(tube_model.COUNT), np.zeros(1), np.zeros((1, 2)))


def _draw() -> None:
    """Draw a rehearsal's drill without a pixel, and lay it over an image."""
    layer, places = np.zeros((8, 8, 4), np.uint8), np.zeros((1, 2), np.int64)
    portrait = Portrait(
        picture=layer,
        bulge_mm=np.zeros((8, 8), np.float32),
        first_row=0,
        last_row=7,
        near_columns=8,
        start_mm=0.0,
        half_mm=4.0,
        per_mm=1.0,
    )
    pose: Rigid[Camera, Tool] = Rigid.identity()
    axis = Axis(pose.translation_mm, -pose.rotation[:, 2])
    rays, still_mm = np.zeros((8, 8, 3), np.float32), np.zeros((8, 8), np.float32)
    draw_body(layer, places, rays, portrait, axis, still_mm)
    bank = np.zeros((9, 9, 3), np.int16)
    light = (np.ones((8, 8), np.float32), 1.0)
    composite(layer[..., :3].copy(), places, layer, 0, light, (np.zeros(256, np.int16), bank[1:, 1:], 1.0))


def _judge() -> None:
    """Evaluate a drill against the wall of a block of bone: distance field, lookup, breach probability."""
    corners = np.array([[x, y, z] for x in (-9.0, 9.0) for y in (-9.0, 9.0) for z in (-9.0, 9.0)])
    faces = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    halves = np.array([half for a, b, c, d in faces for half in ((a, b, c), (a, c, d))])
    channel = Channel(
        name="warm-up",
        entry_in_vertebra_mm=np.array([0.0, 9.0, 0.0]),
        target_in_vertebra_mm=np.array([0.0, -5.0, 0.0]),
        radius_mm=3.0,
    )
    wall = bone_distance_field(
        Surface(vertices_mm=corners, faces=halves), channel, step_mm=1.0, margin_mm=8.0
    )
    pose: Rigid[Vertebra, Tool] = Rigid(
        rotation=np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]]), translation_mm=np.zeros(3)
    )
    analyse_drill(
        UncertainPose(pose=pose, covariance=np.diag([9.0] * 3 + [0.01] * 3)),
        channel,
        wall,
        PedicleTolerance(tolerance_mm=1.0, lever_mm=10.0),
        Drill(radius_mm=2.0, length_mm=50.0),
    )
    wall.distances_mm(np.zeros((1, 3)))


def _half_in_shadow(picture: WarmUpImage) -> GreyImage:
    """Return the image with half of the marker behind a soft shadow edge."""
    columns = np.arange(picture.image.shape[1]) - float(picture.corners_px[:, 0].mean())
    light = 1.0 - 0.6 / (1.0 + np.exp(-columns / (0.06 * picture.side_px)))
    return np.asarray(np.rint(picture.image * light), dtype=np.uint8)


def _verify(model: MarkerModel, picture: WarmUpImage, half_shadowed: GreyImage) -> None:
    """Verify a square without a simple illumination model: half in shadow, with a saturated spot."""
    side = picture.side_px
    left, top = np.ceil(picture.corners_px[0]).astype(int).tolist()
    spotted = half_shadowed.copy()
    spotted[top + 2 : top + side // 4, left + side // 3 : left + 2 * side // 3] = 255
    photometric_fit_of(spotted, model.square, picture.corners_px, side_px=float(side))


def _fit(model: MarkerModel, picture: WarmUpImage, half_shadowed: GreyImage, camera: CameraModel) -> None:
    """Measure the focal length; refine a pose under spline illumination, with one corner occluded."""

    def is_occluded(points_ratio: Array) -> npt.NDArray[np.bool_]:
        return np.asarray(points_ratio.min(axis=1) > OCCLUDED_FROM_RATIO)

    away_mm = model.side_mm * camera.matrix[0, 0] / picture.side_px
    beside_px = picture.corners_px.mean(axis=0) - camera.matrix[:2, 2]
    pose: Rigid[Camera, Marker] = Rigid(
        rotation=np.diag([1.0, -1.0, -1.0]),
        translation_mm=np.array([*(beside_px * model.side_mm / picture.side_px), away_mm]),
    )
    textures, side_px = textures_of(model.square), float(picture.side_px)
    focal_length_error(picture.image, camera.lens, textures, pose, side_mm=model.side_mm, side_px=side_px)
    refine_poses(
        half_shadowed,
        camera.lens,
        textures,
        [pose],
        side_mm=model.side_mm,
        side_px=side_px,
        noise_grey=1.0,
        occluded_at=is_occluded,
    )


if __name__ == "__main__":
    warm_up()
