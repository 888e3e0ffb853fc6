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
from tracker.pose.refinement import DECIDED_COST, difference, surprise, turned_over
from tracker.pose.sighting import Seen

# Edges place a pose to a fraction of a pixel: a whole-shape fit that ends farther away fitted something else.
MOST_APART_PX, MOST_APART_SIDE_RATIO = 1.2, 0.04
# Uneven light (a shadow's edge, glare) leaves more than noise and a twenty-eighth of the contrast
# unexplained; edges, which bring their own contrast, are the better judge of the pose then.
MOST_LEFT_NOISES, MOST_LEFT_CONTRAST_RATIO = 1.8, 0.035
LEAST_EXPLAINED_RATIO = 0.6
# True markers leave up to 0.05 of their contrast (two blurs, shadow and noise together), others from 0.065.
TOLD_NOISES, TOLD_CONTRAST_RATIO, TOLD_EXPLAINED_RATIO = 1.2, 0.055, 0.55
LEAST_CONTRAST_GREY = 4.0
# White noise is not all: in shadow, blur and bent response the errors of neighbours are alike. Too wide in
# plain light, where one and a half would do; too narrow would be worse.
COVARIANCE_FACTOR = 4.0
# Costs count each pixel as if it erred alone; half of that is left when the model's own errors are in.
COST_SHARE = 0.5


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
    told = any(_is_told(one, pixels.noise_grey) and _near(camera, model, one, here, reach) for one in fits)
    good = [
        one for one in fits if _explains(one, pixels.noise_grey) and _near(camera, model, one, here, reach)
    ]
    if not good:
        return seen, told
    costs = [COST_SHARE * one.cost_sd2 + surprise(one.camera_from_marker, expected) for one in good]
    order = np.argsort(costs, kind="stable")
    best = good[order[0]]
    pose, covariance = best.camera_from_marker, COVARIANCE_FACTOR * best.covariance
    if len(good) > 1:
        other = good[order[1]].camera_from_marker
        gap = float(costs[order[1]] - costs[order[0]])
        apart = difference(pose, other)
        turned = float(np.linalg.norm(apart[3:]))
        if expected is not None and turned_over(pose, other, expected):
            gap = min(gap, 2.0)
        if gap < DECIDED_COST and turned > 1e-3:
            doubt = 1.0 / (1.0 + float(np.exp(gap / 2.0)))
            covariance = covariance + doubt * np.outer(apart, apart)
    return replace(seen, camera_from_marker=pose, pose_covariance=covariance), told


def _explains(one: WholeFit, noise_grey: float) -> bool:
    left = max(MOST_LEFT_NOISES * noise_grey, MOST_LEFT_CONTRAST_RATIO * one.contrast_grey)
    return (
        one.contrast_grey > LEAST_CONTRAST_GREY
        and one.scale_grey < left
        and one.explained_ratio > LEAST_EXPLAINED_RATIO
    )


def _is_told(one: WholeFit, noise_grey: float) -> bool:
    """Whether what is seen is this shape and no other."""
    left = max(TOLD_NOISES * noise_grey, TOLD_CONTRAST_RATIO * one.contrast_grey)
    return (
        one.contrast_grey > LEAST_CONTRAST_GREY
        and one.scale_grey < left
        and one.explained_ratio > TOLD_EXPLAINED_RATIO
    )


def _near(camera: CameraModel, model: MarkerModel, one: WholeFit, here: Array, reach: float) -> bool:
    there = camera.px_from_camera(one.camera_from_marker.move_points(model.corners_mm))
    return float(np.abs(there - here).max()) < reach
