"""Photometric pose refinement: pose, blur, camera response and illumination fitted to all pixels of a marker.

The fit runs coarse to fine: first on a subset of the pixels, then on all. The covariance is a cluster-robust
(sandwich) estimate from the residuals, clustered in blocks of the marker, because in shadow and in compressed
images errors of neighbouring pixels are correlated: a covariance under white noise is too small, and a
constant inflation factor that is large enough is four times too large under plain illumination. There are
seven blocks per side, and five where blur is wide or the marker is partly occluded, because neighbouring
blocks of seven are still correlated there. Further factors account for errors of the marker model under
spline illumination and out of focus. Errors common to the whole marker are not detected.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from tracker.camera.blur_kernels import motion_blur_of
from tracker.edges import GreyImage
from tracker.geometry import Array, Camera, Marker, Rigid, nearest_rotation
from tracker.geometry.geometry_kernels import mean_generalised_eigenvalue, pose_rows
from tracker.photometric.equation_kernels import PLANAR_COUNT
from tracker.photometric.fit import (
    CUTOFF_SDS,
    PIXEL_PX2,
    FitResult,
    fit_pose,
    plausible_fits,
    refit_all,
    robust_chi2_of,
    with_mirror_solution,
)
from tracker.photometric.illumination import (
    KnownIllumination,
    fit_in_known_illumination,
    has_illumination_pattern,
    has_large_residuals,
    known_illumination_from,
    select_illumination,
)
from tracker.photometric.illumination_kernels import (
    PLANAR,
    bandwidth_of,
    illumination_first,
    typical_contrast,
)
from tracker.photometric.inner_region import fit_inner_region
from tracker.photometric.refinement_kernels import clustered_covariance
from tracker.photometric.response_kernels import BLUR, RESPONSE
from tracker.photometric.samples import OccludedAt, Samples, sample_pixels, subsample
from tracker.photometric.texture import Textures

# Wider markers are averaged first: their edges are sharper than the sharpest texture level.
WIDEST_PX = 110.0
# sd 0.6 px: a camera in focus.
FOCUS_PX2 = 0.36
# Above this ratio to the blur of a camera in focus, the pixels are selected again.
WIDE_BLUR_RATIO = 4.0
# Numbers of pixels of the coarse and of the medium fit, before the fit on all pixels.
COARSE_PIXELS, MEDIUM_PIXELS = 200, 800
# The mirrored solution is dropped above this delta chi-square in the coarse fit.
MAX_DELTA_CHI2 = 60.0
# Blocks per side within which errors are assumed correlated; larger blocks for wide blur and partial
# occlusion.
BLOCKS, LARGE_BLOCKS = 7, 5
# Factor on the covariance for illumination that the spline cannot represent, measured on rendered scenes.
NONUNIFORM_FACTOR = 1.4
# Factor for background mixed in by wide defocus; motion blur keeps sharp edges along its direction.
OUT_OF_FOCUS_FACTOR = 1.5


@dataclass(frozen=True, slots=True, kw_only=True)
class RefinedPose:
    """A refined pose with its covariance and the quality of its fit.

    Attributes:
        camera_from_marker: the pose.
        covariance: (6, 6) [mm, rad] from the residuals: translation, then rotation, left-multiplied.
        variance_inflation: variance over that of independent pixel errors, at least 1.
        residual_sd_grey: sd of the residuals in grey levels.
        contrast_grey: bright minus dark level at the marker's centre.
        inlier_ratio: mean robust weight of the pixels, 0..1; occluded pixels have none.
        response: parameter of the camera response, 0 where grey levels are proportional to irradiance.
        robust_chi2: robust chi-square in units of the smaller residual sd of all fits; 0 for a single fit.
        motion_blur_px: length of motion blur during the exposure; 0 where there is none.
        illumination: the spline illumination of the fit; None where it is planar.
        alternative: another possible pose where the outline is not reliable; else None.
        alternative_delta_chi2: chi-square difference by which the inner region disfavours it.
    """

    camera_from_marker: Rigid[Camera, Marker]
    covariance: Array
    variance_inflation: float
    residual_sd_grey: float
    contrast_grey: float
    inlier_ratio: float
    response: float
    robust_chi2: float
    motion_blur_px: float
    illumination: KnownIllumination | None = None
    alternative: Rigid[Camera, Marker] | None = None
    alternative_delta_chi2: float = 0.0


def refine_poses(
    image: GreyImage,
    lens: Array,
    textures: Textures,
    starts: list[Rigid[Camera, Marker]],
    *,
    side_mm: float,
    side_px: float,
    noise_grey: float,
    occluded_at: OccludedAt | None = None,
    known: KnownIllumination | None = None,
) -> list[RefinedPose]:
    """Refine each start by a photometric fit; fits that fail are left out.

    A start must be within about half a pixel. All starts are fitted to the same pixels, so their chi-squares
    are comparable.

    Args:
        image: the whole grey image (h, w).
        lens: `CameraModel.lens`.
        textures: the prerendered textures of the marker.
        starts: start poses, the most likely first; it determines the selected pixels.
        side_mm: side of the marker.
        side_px: approximate side of the marker in the image.
        noise_grey: sd of the image noise.
        occluded_at: tests which points of the marker are occluded; None for no occlusion.
        known: spline illumination of the previous image, if known.
    """

    def chosen(blur_px2: Array) -> Samples:
        return sample_pixels(
            image,
            lens,
            textures,
            starts[0],
            side_mm=side_mm,
            step=step,
            blur_px2=blur_px2,
            occluded_at=occluded_at,
        )

    step = averaging_step(side_px)
    focus = focus_blur_px2(step)
    before = _fit_in_previous_illumination(chosen, starts, focus, known)
    samples, done = before or _fit_from_scratch(chosen, starts, focus, noise_grey)
    if not done:
        return []
    rotations = [start.rotation for start in starts]
    inside = fit_inner_region(samples, done, rotations, side_px=side_px, noise_grey=noise_grey)
    if inside is not None:
        samples, done = inside.samples, inside.fits
    scale = min(one.residual_sd_grey for one in done)
    costs = [robust_chi2_of(samples, one, scale) for one in done] if len(done) > 1 else [0.0]
    is_wide = wide_blur_px2(done[0].parameters, focus) is not None
    common = (is_wide, occluded_at is not None, None if before is None else known)
    records = (_refined_pose(samples, one, cost, *common) for one, cost in zip(done, costs, strict=True))
    fits = [one for one in records if one is not None]
    if inside is None:
        return fits
    alternative = _pose_of(inside.alternative)
    return [replace(one, alternative=alternative, alternative_delta_chi2=inside.delta_chi2) for one in fits]


def averaging_step(side_px: float) -> int:
    """Return how many pixels are averaged along each axis."""
    return max(1, int(np.ceil(side_px / WIDEST_PX)))


def focus_blur_px2(step: int) -> Array:
    """Return the blur (3,) of a camera in focus, with that of averaging."""
    return np.array([1.0, 1.0, 0.0]) * (FOCUS_PX2 + step * step * PIXEL_PX2)


def _fit_in_previous_illumination(
    chosen: Callable[[Array], Samples],
    starts: list[Rigid[Camera, Marker]],
    focus_px2: Array,
    known: KnownIllumination | None,
) -> tuple[Samples, list[FitResult]] | None:
    """Fit in the spline illumination of the previous image; None where it does not apply."""
    # A fitted illumination belongs to one pose and would favour it over the other.
    if known is None or len(starts) != 1:
        return None
    wide = wide_blur_px2(known.parameters, focus_px2)
    samples = chosen(focus_px2 if wide is None else wide)
    one = fit_in_known_illumination(samples, starts[0].rotation, starts[0].translation_mm, known)
    return None if one is None else (samples, [one])


def _fit_from_scratch(
    chosen: Callable[[Array], Samples],
    starts: list[Rigid[Camera, Marker]],
    focus_px2: Array,
    noise_grey: float,
) -> tuple[Samples, list[FitResult]]:
    """Select pixels and fit from each start with unknown illumination."""
    rotations = [start.rotation for start in starts]
    samples = chosen(focus_px2)
    few = subsample(samples, COARSE_PIXELS)
    near = [one for one in (_coarse_fit(few, start, focus_px2) for start in starts) if one is not None]
    if not near:
        return samples, []
    sharp = min(near, key=lambda one: one.residual_sd_grey)
    if (blur := wide_blur_px2(sharp.parameters, focus_px2)) is not None:
        samples = chosen(blur)
        few = subsample(samples, COARSE_PIXELS)
        near = refit_all(few, near)
        if not near:
            return samples, []
    # With large residuals, the chi-squares of the two solutions cannot be compared yet.
    if not (much := has_large_residuals(near, noise_grey)):
        near = plausible_fits(few, with_mirror_solution(few, near, rotations), MAX_DELTA_CHI2)
    done = _fit_all_pixels(samples, near, noise_grey, much)
    if done and done[0].illumination[0] != PLANAR:
        done = with_mirror_solution(samples, done, rotations)
    elif done and blur is not None:
        # The coarse fits may have diverged while the blur was unknown, so compare the solutions on more
        # pixels.
        subset = subsample(samples, MEDIUM_PIXELS)
        plausible = plausible_fits(subset, with_mirror_solution(subset, done, rotations), MAX_DELTA_CHI2)
        known = {id(one) for one in done}
        done += refit_all(samples, [one for one in plausible if id(one) not in known])
    return samples, done


def wide_blur_px2(parameters: Array, focus_px2: Array) -> Array | None:
    """Return the blur (3,) of a fit, in px^2, if it is wider than that of a camera in focus; else None."""
    blur = parameters[BLUR : BLUR + 3]
    return blur if float(blur[:2].sum()) > WIDE_BLUR_RATIO * float(focus_px2[:2].sum()) else None


def _coarse_fit(few: Samples, start: Rigid[Camera, Marker], blur_px2: Array) -> FitResult | None:
    """Fit the pose near a start to a subset of the pixels under planar illumination."""
    parameters = np.zeros(PLANAR_COUNT)
    parameters[BLUR : BLUR + 3] = blur_px2
    return fit_pose(few, start.rotation, start.translation_mm, parameters, illumination=(PLANAR, 0))


def _fit_all_pixels(
    samples: Samples, near: list[FitResult], noise_grey: float, much: bool
) -> list[FitResult]:
    """Continue the fits on all pixels; with large residuals (`much`), select the illumination model."""
    subset = subsample(samples, MEDIUM_PIXELS)
    done = refit_all(subset, near)
    if not (much and done and has_illumination_pattern(subset, done)):
        done = done if subset is samples else refit_all(samples, done)
        if not done or not has_illumination_pattern(samples, done):
            return done
    return select_illumination(samples, done, noise_grey)


def _refined_pose(
    samples: Samples,
    one: FitResult,
    robust_chi2: float,
    is_wide: bool,
    is_covered: bool,
    known: KnownIllumination | None,
) -> RefinedPose | None:
    """Return the refined pose of a fit; None where the normal matrix does not determine the pose.

    `is_wide`: whether blur is wide; `known`: the illumination that the fit started from.
    """
    # The priors already regularise the matrix: it needs no ridge.
    rows, is_determined = pose_rows(
        one.matrix, illumination_first(one.illumination), bandwidth_of(one.illumination), 0.0
    )
    if not is_determined:
        return None
    alone = np.ascontiguousarray(rows[:, :6]) * one.residual_sd_grey**2
    together = clustered_covariance(
        samples.values,
        one.prediction,
        one.parameters,
        one.illumination,
        one.residual_sd_grey,
        CUTOFF_SDS,
        rows,
        LARGE_BLOCKS if is_wide or is_covered else BLOCKS,
    )
    inflation = max(float(mean_generalised_eigenvalue(alone, together)), 1.0)
    illumination_factor = 1.0 if one.illumination[0] == PLANAR else NONUNIFORM_FACTOR
    motion_blur_px = float(np.sqrt(12.0 * motion_blur_of(one.parameters[BLUR : BLUR + 3])[0]))
    blur_factor = OUT_OF_FOCUS_FACTOR if is_wide and motion_blur_px == 0.0 else 1.0
    return RefinedPose(
        camera_from_marker=_pose_of(one),
        covariance=alone * inflation * illumination_factor * blur_factor,
        variance_inflation=inflation,
        residual_sd_grey=one.residual_sd_grey,
        contrast_grey=float(typical_contrast(one.parameters, one.illumination)),
        inlier_ratio=one.inlier_ratio,
        response=float(one.parameters[RESPONSE]),
        robust_chi2=robust_chi2,
        motion_blur_px=motion_blur_px,
        illumination=known_illumination_from(one, known),
    )


def _pose_of(one: FitResult) -> Rigid[Camera, Marker]:
    return Rigid(rotation=nearest_rotation(one.rotation), translation_mm=one.translation_mm)
