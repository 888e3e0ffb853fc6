"""A pose from edges, made as exact as the pixels allow by fitting the whole shape to them."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from tracker.appearance import Textures, WholeFit, whole_fits
from tracker.camera import CameraModel
from tracker.edges import GreyImage
from tracker.geometry import Array, Camera, Marker, Rigid
from tracker.marker import MarkerModel
from tracker.pose.occurrence import side_px_of
from tracker.pose.planar import other_solution
from tracker.pose.refinement import doubt_between, surprise
from tracker.pose.sighting import Seen

# Edges place a pose to a fraction of a pixel: a whole-shape fit that ends farther away fitted something else.
MOST_APART_PX, MOST_APART_SIDE_RATIO = 1.2, 0.04
LEAST_CONTRAST_GREY = 4.0
# Beyond what the residuals themselves tell: measured on rendered scenes, where the truth is known.
COVARIANCE_FACTOR = 1.6
# Costs count each pixel as if it erred alone; half of that is left when the model's own errors are in.
COST_SHARE = 0.5


@dataclass(frozen=True, slots=True, kw_only=True)
class Limits:
    """What a fit may leave unexplained.

    Attributes:
        noises: sd of what is left, in units of the image's noise; or else
        contrast_ratio: the same in units of the contrast.
        explained_ratio: least mean weight of the pixels.
    """

    noises: float
    contrast_ratio: float
    explained_ratio: float

    def allow(self, one: WholeFit, noise_grey: float) -> bool:
        """Whether so much is explained in an image of this noise."""
        left = max(self.noises * noise_grey, self.contrast_ratio * one.contrast_grey)
        return (
            one.contrast_grey > LEAST_CONTRAST_GREY
            and one.scale_grey < left
            and one.explained_ratio > self.explained_ratio
        )


# Where more is left, edges, which bring their own contrast, are the better judge of the pose.
EXACT = Limits(noises=1.8, contrast_ratio=0.055, explained_ratio=0.6)
# True markers leave up to 0.05 of their contrast (two blurs, shadow and noise together), others from 0.065.
TOLD = Limits(noises=1.2, contrast_ratio=0.055, explained_ratio=0.55)


@dataclass(frozen=True, slots=True, kw_only=True)
class Pixels:
    """The whole image, for a fit to its grey levels.

    Attributes:
        image: grey (h, w).
        noise_grey: sd of its noise.
        textures: of each marker, by name.
    """

    image: GreyImage
    noise_grey: float
    textures: Mapping[str, Textures]


def with_whole_shape(
    camera: CameraModel,
    model: MarkerModel,
    pixels: Pixels,
    seen: Seen,
    *,
    expected: Rigid[Camera, Marker] | None = None,
) -> tuple[Seen, bool]:
    """The same by all pixels of the marker where they can be explained, else by its edges as it was.

    And whether the marker's shape explains the pixels at all: another shape whose edges happen to lie where
    the marker's would leaves twice as much unexplained as any true one.

    `expected` is the pose that the images before let expect.
    """
    side_px = side_px_of(seen.corners_px)
    starts = [seen.camera_from_marker, other_solution(seen.camera_from_marker)]
    fits = whole_fits(
        pixels.image,
        camera.lens,
        pixels.textures[model.name],
        starts,
        side_mm=model.side_mm,
        side_px=side_px,
        noise_grey=pixels.noise_grey,
    )
    here = camera.px_from_camera(starts[0].move_points(model.corners_mm))
    reach = max(MOST_APART_PX, MOST_APART_SIDE_RATIO * side_px)
    near = [one for one in fits if _is_near(camera, model, one, here, reach)]
    told = any(TOLD.allow(one, pixels.noise_grey) for one in near)
    if not near:
        return seen, told
    # The better one must be exact by itself: where it just is not, the worse one would be left alone.
    costs = [COST_SHARE * one.cost_sd2 + surprise(one.camera_from_marker, expected) for one in near]
    first, *others = np.argsort(costs, kind="stable")
    if not EXACT.allow(near[first], pixels.noise_grey):
        return seen, told
    pose, covariance = near[first].camera_from_marker, COVARIANCE_FACTOR * near[first].covariance
    for k in others:
        gap = float(costs[k] - costs[first])
        covariance = (
            covariance + doubt_between(pose, near[k].camera_from_marker, gap=gap, expected=expected)[1]
        )
    return replace(seen, camera_from_marker=pose, pose_covariance=covariance), told


def _is_near(camera: CameraModel, model: MarkerModel, one: WholeFit, here: Array, reach: float) -> bool:
    there = camera.px_from_camera(one.camera_from_marker.move_points(model.corners_mm))
    return float(np.abs(there - here).max()) < reach
