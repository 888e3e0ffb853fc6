"""A pose from edges, made as exact as the pixels allow by fitting the whole shape to them.

Edges use the position of a gradient peak, pixels its whole profile: so the pose by edges is then fitted to
all pixels, with blur, response and light. What that fit cannot explain keeps its pose by edges. Cost: 1 to
3 ms.

The pixels choose among all fits. Edges of a motion-blurred marker stand at either end of the motion and
often fit the wrong planar solution; a reach that does not allow half of the motion more would reject the
right one unseen, and state half a degree for a tip that is off by decimetres (7 of 41 hard scenes of camera
B). Where the best fit ends elsewhere and leaves something unexplained, the pose by edges stays and the
covariance spans both: with a cover along one side the edges are wrong and the pixels right.
`tests/tracker/test_limits.py` holds that no error exceeds ten stated standard deviations.

Covered pixels have no weight: a round finger passes for a shadow, and with a third of the marker under it
(cover30, camera A) tips would be off by 1.37 mm instead of 0.37.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from tracker.appearance import MIN_SAY_RATIO, CoveredAt, Textures, WholeFit, whole_fits
from tracker.camera import CameraModel
from tracker.edges import GreyImage
from tracker.geometry import Array, Camera, Marker, Rigid
from tracker.marker import MarkerModel
from tracker.pose.arc import beyond_first_order
from tracker.pose.occurrence import corners_px_at, side_px_of
from tracker.pose.planar import other_solution
from tracker.pose.rivals import (
    DECIDED_COST,
    Expected,
    doubt_between,
    doubt_over,
    is_nearer,
    lead_between,
    surprise,
)
from tracker.pose.sighting import Seen

# Edges place a pose to a fraction of a pixel: a whole-shape fit that ends farther away fitted something else.
MAX_APART_PX, MAX_APART_SIDE_RATIO = 1.2, 0.04
MIN_CONTRAST_GREY = 4.0
# Where more is left unexplained, in units of the noise and of the contrast, or less of the pixels has a say,
# edges, which bring their own contrast, are the better judge of the pose.
# With 0.6 of the pixels a wrong tilt passes in interlaced images, half of whose lines are elsewhere.
MAX_LEFT_NOISES, MAX_LEFT_CONTRAST_RATIO, MIN_EXPLAINED_RATIO = 2.2, 0.055, 0.72
# What the model of the marker leaves out follows the pose: residuals tell it in part. So many times their
# variance is added, by how much of it is no noise: what is more than the image's noise, as of compressed
# pictures, and at least a share of the contrast. Measured on rendered scenes, where the truth is known.
UNTOLD_FACTOR, UNTOLD_CONTRAST_RATIO = 0.6, 0.02
# Costs count each pixel as if it erred alone; half of that is left when the model's own errors are in.
COST_SHARE = 0.5
# The noise is known to a fifth. What is left beyond that is no noise.
NOISE_AT_MOST = 1.2
# Where edges and the images before speak so clearly for one of the two solutions, pixels need not be asked of
# the other. Edges alone may be wrong: smear moves them.
CLEAR_LEAD_SD2 = 100.0


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
    covered_at: CoveredAt | None = None,
) -> Seen:
    """The same by all pixels of the marker where they can be explained, else by its edges as it was.

    `expected` is the pose that the images before let expect; `covered_at` tells what has no say.
    """
    side_px = side_px_of(seen.corners_px)
    starts = [seen.camera_from_marker]
    other = other_solution(seen.camera_from_marker)
    if not _is_clear(seen, other, expected):
        starts.append(other)
    fits = whole_fits(
        pixels.image,
        camera.lens,
        pixels.textures[model.name],
        starts,
        side_mm=model.side_mm,
        side_px=side_px,
        noise_grey=pixels.noise_grey,
        covered_at=covered_at,
        known=expected.light if isinstance(expected, Expected) else None,
    )
    if not fits:
        return seen
    # Where neighbours err alike, as under smear that is not quite the model's, squares count so much less.
    share = COST_SHARE / max(one.alike_ratio for one in fits)
    costs = [share * one.cost_sd2 + surprise(one.camera_from_marker, expected) for one in fits]
    first, *others = np.argsort(costs, kind="stable")
    # The best one must be near and exact by itself: where it just is not, a worse one would be left alone.
    if not _is_exact(fits[first], pixels.noise_grey):
        return seen
    if not _is_near(camera, model, fits[first], seen.camera_from_marker):
        return _either(seen, fits[first])
    pose, covariance = fits[first].camera_from_marker, _beyond_residuals(fits[first], pixels.noise_grey)
    covariance = covariance + beyond_first_order(covariance)
    for k in others:
        gap = float(costs[k] - costs[first])
        covariance = covariance + doubt_between(pose, fits[k].camera_from_marker, gap=gap, expected=expected)
    lead = seen.lead_sd2
    if len(starts) > 1:
        lead = lead_between(costs, [one.camera_from_marker for one in fits], int(first))
    if (other := fits[first].other) is not None:
        gap = COST_SHARE * fits[first].other_gap_sd2
        covariance = covariance + doubt_over(pose, other, gap=gap)
        lead = min(lead, max(gap, 0.0))
    return replace(
        seen,
        camera_from_marker=pose,
        pose_covariance=covariance,
        lead_sd2=lead,
        unexplained_ratio=_unexplained(fits[first], pixels.noise_grey),
        light=fits[first].light,
    )


def _is_clear(seen: Seen, other: Rigid[Camera, Marker], expected: Rigid[Camera, Marker] | None) -> bool:
    """Whether edges and the images before speak so clearly that pixels need not be asked of the other."""
    # Where no other solution fits the edges, both may have ended at one: an infinite lead is not clear.
    if not isinstance(expected, Expected) or not CLEAR_LEAD_SD2 <= seen.lead_sd2 < np.inf:
        return False
    was_sure = expected.lead_sd2 >= DECIDED_COST
    return was_sure and not is_nearer(expected, other, seen.camera_from_marker)


def _either(seen: Seen, by_pixels: WholeFit) -> Seen:
    """Where pixels contradict edges both stay possible: what covers a side may lead either astray."""
    doubt = doubt_over(seen.camera_from_marker, by_pixels.camera_from_marker, gap=0.0)
    if by_pixels.explained_ratio < MIN_SAY_RATIO:
        return replace(seen, pose_covariance=seen.pose_covariance + doubt, lead_sd2=0.0)
    return replace(
        seen,
        camera_from_marker=by_pixels.camera_from_marker,
        pose_covariance=by_pixels.covariance + doubt,
        lead_sd2=0.0,
        light=by_pixels.light,
    )


def _is_exact(one: WholeFit, noise_grey: float) -> bool:
    left = max(MAX_LEFT_NOISES * noise_grey, MAX_LEFT_CONTRAST_RATIO * one.contrast_grey)
    return (
        one.contrast_grey > MIN_CONTRAST_GREY
        and one.scale_grey < left
        and one.explained_ratio > MIN_EXPLAINED_RATIO
    )


def _unexplained(one: WholeFit, noise_grey: float) -> float:
    """The share (of the variance) of what a fit leaves that is no noise, 0..1."""
    left, noise = one.scale_grey**2, (NOISE_AT_MOST * noise_grey) ** 2
    return (left - noise) / left if left > noise else 0.0


def _beyond_residuals(one: WholeFit, noise_grey: float) -> Array:
    """The covariance (6, 6) with what the residuals do not tell."""
    left = one.scale_grey**2
    untold = max((UNTOLD_CONTRAST_RATIO * one.contrast_grey) ** 2, left - noise_grey**2)
    return (1.0 + UNTOLD_FACTOR * untold / max(left, untold)) * one.covariance


def _is_near(camera: CameraModel, model: MarkerModel, one: WholeFit, found: Rigid[Camera, Marker]) -> bool:
    """Whether a fit ended where edges are. Those of a smeared marker stand at either end of the smear."""
    here, there = (corners_px_at(camera, model, pose) for pose in (found, one.camera_from_marker))
    reach = max(MAX_APART_PX, MAX_APART_SIDE_RATIO * side_px_of(here)) + 0.5 * one.smear_px
    return float(np.abs(there - here).max()) < reach
