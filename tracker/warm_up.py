"""Compile all hot loops ahead, so that nothing compiles in theatre: `python -m tracker.warm_up`.

Chains, matching and fits are loops that NumPy cannot express, and 30 Hz on two cores leaves no time for
Python in them. Numba costs 190 MB of packages and a minute at the first start; an extension in C++ would
need a build step on every machine.
"""

from enum import StrEnum

import numpy as np
import numpy.typing as npt

from tracker.appearance import textures_of, whole_fits
from tracker.camera import CameraModel
from tracker.edges import GreyImage
from tracker.geometry import Array, Camera, Marker, Rigid, Tool, Vertebra
from tracker.marker import MarkerModel, explanation_of
from tracker.navigation.certainty import Drill, Placed, Room, judge
from tracker.navigation.clearance import field_of_bone
from tracker.pipeline import Tracker
from tracker.pipeline.practice import PracticePicture, practice_picture
from tracker.plan import Channel, Surface
from tracker.plan.pedicle.kernels import walls_around

# From the marker's centre towards its right top corner, in sides.
COVERED_FROM_RATIO = 0.3


class Part(StrEnum):
    """What can be compiled by itself; together the parts compile everything."""

    SEARCH = "search"  # finds a marker and follows it
    FIT = "fit"  # what `SEARCH` does at last: the photometric fit of a pose
    REST = "rest"  # verification in uneven light, distances to bone, sections of a CT


def warm_up(*parts: Part) -> None:
    """Run every loop of these parts once; of all parts where none is named."""
    camera = CameraModel(
        matrix=np.array([[400.0, 0.0, 159.5], [0.0, 400.0, 119.5], [0.0, 0.0, 1.0]]),
        distortion=np.zeros(5),
        size_wh_px=(320, 240),
    )
    marker = np.zeros((64, 64), np.uint8)
    marker[16:48, 16:32] = 255
    marker[32:48, 16:48] = 255
    model = MarkerModel.from_image(marker, side_mm=25.0, name="warm-up")
    picture = practice_picture(model.square, size_wh_px=camera.size_wh_px)
    shaded = _half_in_shadow(picture)
    for part in parts or Part:
        match part:
            case Part.SEARCH:
                _search(model, picture, camera)
            case Part.FIT:
                _fit(model, picture, shaded, camera)
            case Part.REST:
                _explain(model, picture, shaded)
                _judge()
                _outline()


def _search(model: MarkerModel, picture: PracticePicture, camera: CameraModel) -> None:
    """Track a marker in a practice picture, after the tracker itself has practised."""
    tracker = Tracker(camera=camera, models=[model])
    for at_s in (0.0, 0.03, 0.06):
        tracker.step(picture.image, captured_at_s=at_s)


def _outline() -> None:
    """Outline a section through a block without bone."""
    block = np.zeros((2, 2, 2), np.float32)
    walls_around(block, np.zeros((1, 3)), np.ones((1, 1, 3)), 2, 1.0, 1, np.empty((1, 1)))


def _judge() -> None:
    """Hold a drill against the wall of a block of bone: distances made, looked up, and weighed."""
    corners = np.array([[x, y, z] for x in (-9.0, 9.0) for y in (-9.0, 9.0) for z in (-9.0, 9.0)])
    faces = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    halves = np.array([half for a, b, c, d in faces for half in ((a, b, c), (a, c, d))])
    channel = Channel(
        name="warm-up",
        entry_in_vertebra_mm=np.array([0.0, 9.0, 0.0]),
        target_in_vertebra_mm=np.array([0.0, -5.0, 0.0]),
        radius_mm=3.0,
    )
    wall = field_of_bone(Surface(vertices_mm=corners, faces=halves), channel, step_mm=1.0, margin_mm=8.0)
    pose: Rigid[Vertebra, Tool] = Rigid(
        rotation=np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]]), translation_mm=np.zeros(3)
    )
    judge(
        Placed(pose=pose, covariance=np.diag([9.0] * 3 + [0.01] * 3)),
        channel,
        wall,
        Room(room_mm=1.0, lever_mm=10.0),
        Drill(radius_mm=2.0, length_mm=50.0),
    )
    wall.distances_mm(np.zeros((1, 3)))


def _half_in_shadow(picture: PracticePicture) -> GreyImage:
    """The same picture, the marker half in the shadow of something with a soft edge."""
    columns = np.arange(picture.image.shape[1]) - float(picture.corners_px[:, 0].mean())
    light = 1.0 - 0.6 / (1.0 + np.exp(-columns / (0.06 * picture.side_px)))
    return np.asarray(np.rint(picture.image * light), dtype=np.uint8)


def _explain(model: MarkerModel, picture: PracticePicture, shaded: GreyImage) -> None:
    """Ask what explains a square that no light explains: half in shadow, with a spot of full brightness."""
    side = picture.side_px
    left, top = np.ceil(picture.corners_px[0]).astype(int).tolist()
    spotted = shaded.copy()
    spotted[top + 2 : top + side // 4, left + side // 3 : left + 2 * side // 3] = 255
    explanation_of(spotted, model.square, picture.corners_px, side_px=float(side))


def _fit(model: MarkerModel, picture: PracticePicture, shaded: GreyImage, camera: CameraModel) -> None:
    """Fit the whole shape in light that varies, one corner of it covered."""

    def is_covered(points_ratio: Array) -> npt.NDArray[np.bool_]:
        return np.asarray(points_ratio.min(axis=1) > COVERED_FROM_RATIO)

    away_mm = model.side_mm * camera.matrix[0, 0] / picture.side_px
    beside_px = picture.corners_px.mean(axis=0) - camera.matrix[:2, 2]
    pose: Rigid[Camera, Marker] = Rigid(
        rotation=np.diag([1.0, -1.0, -1.0]),
        translation_mm=np.array([*(beside_px * model.side_mm / picture.side_px), away_mm]),
    )
    whole_fits(
        shaded,
        camera.lens,
        textures_of(model.square),
        [pose],
        side_mm=model.side_mm,
        side_px=float(picture.side_px),
        noise_grey=1.0,
        covered_at=is_covered,
    )


if __name__ == "__main__":
    warm_up()
