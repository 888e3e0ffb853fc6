"""Position of the bone's outer wall, by a fit of a blurred cortex model to the voxels along each normal.

Every threshold is biased: an isosurface below the half-way HU lies outside the bone, and because a cortex
thinner than the scanner's blur does not reach its true HU, the half-way level of its peak lies outside too.
If the HU of the cortex and the blur are known, the wall is observable for any thickness. These two are
estimated once, where the cortex is thick; wall, thickness and the HU of both sides are then fitted at each
vertex. If the cortex is nowhere thick, the usual HU of compact bone is assumed, and the standard deviation of
the wall increases.

Source: G. Treece, A. Gee, P. Mayhew, K. Poole, High resolution cortical bone thickness measurement from
clinical CT data, Medical Image Analysis 14, 2010. For the HU of the cortex: G. Treece, K. Poole, A. Gee,
Imaging the femoral cortex: thickness, density and mass from clinical CT, CUED/F-INFENG/TR665, 2011.
"""

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt
import scipy

from tracker.geometry import Array

# Order of the parameters: wall in mm, logarithms of thickness and of the whole blur's sigma in mm, then HU.
WALL, THICKNESS, BLUR, CORTEX, OUTSIDE, MARROW = range(6)
COUNT = 6
# Half length of a profile in mm, and its sampling step in units of the smallest voxel side.
REACH_MM, STEP_VOXELS = 3.5, 0.5
# A profile ends where it rises again by this ratio of its contrast, because the next wall begins there.
RISE_RATIO, RISE_NOISE = 0.12, 3.0
# Metal is far above any bone.
MAX_HU, AIR_HU = 1600.0, -900.0
# Standard deviation of a wall by threshold, and the largest correction.
WALL_SD_MM, MAX_MOVE_MM = 0.6, 1.5
USUAL_THICKNESS_MM, THICKNESS_SD_LOG = 1.0, 0.8
# The scanner's own blur in voxels of the slice, as for a pedicle.
BLUR_VOXELS, BLUR_SD_LOG = 0.35, 0.4
# Compact bone at usual tube voltages, used where no cortex is thick enough to measure its HU.
USUAL_CORTEX_HU, CORTEX_SD_HU = 1000.0, 250.0
OUTSIDE_SD_HU, MARROW_SD_HU, MARROW_RATIO = 300.0, 200.0, 0.2
# HU and blur are observable for a cortex this many times thicker than the sigma of the blur.
THICK_SIGMAS, MIN_THICK_RATIO = 2.5, 0.05
# Second start of the fit for thick cortex: bone without marrow; and the required decrease of its loss.
SOLID_MM, SOLID_GAIN = 4.0, 0.5
# Local deviation (sd): of the cortex as a ratio of the contrast, of the blur as a logarithm.
LOCAL_CORTEX_RATIO, LOCAL_BLUR_LOG = 0.12, 0.12
# Scale of the robust loss, as for a pedicle; MIN_SPREAD is the lower bound of the residuals in units of it.
MIN_SCALE_HU, SCALE_RATIO, MIN_SPREAD = 12.0, 0.06, 0.2
ROUNDS, CHUNK, SAMPLED = 12, 4000, 3000
# Maximum change of each parameter in one step of the fit.
MAX_STEP: Array = np.array([0.4, 0.5, 0.3, np.inf, np.inf, np.inf])


@dataclass(frozen=True, slots=True, kw_only=True)
class Profiles:
    """HU along the outward normals at points of a surface.

    Attributes:
        along_mm: (s,), outwards from the surface.
        hu: (n, s), trilinear.
        weight: (n, s), 0 beyond the next wall and outside of the block.
        voxel_mm: (n,), standard deviation of the blur by voxel and interpolation along each normal.
        step_voxels: (n,), distance of the samples in voxels along each normal.
    """

    along_mm: Array
    hu: Array
    weight: Array
    voxel_mm: Array
    step_voxels: Array


@dataclass(frozen=True, slots=True, kw_only=True)
class Imaging:
    """Imaging parameters common to all points of a scan.

    Attributes:
        cortex_hu: HU of the cortex, not blurred.
        cortex_sd_hu: standard deviation between points.
        blur_mm: standard deviation of the scanner's own blur.
        blur_sd_log: standard deviation between points of the logarithm of the total blur.
        tissue_hu: usual HU around the bone.
        noise_hu: standard deviation of a voxel's noise.
    """

    cortex_hu: float
    cortex_sd_hu: float
    blur_mm: float
    blur_sd_log: float
    tissue_hu: float
    noise_hu: float


@dataclass(frozen=True, slots=True, kw_only=True)
class EdgeFit:
    """Fitted walls.

    Attributes:
        wall_mm: (n,), offset of the wall from the surface along the normal, positive outwards.
        sd_mm: (n,), its standard deviation; `WALL_SD_MM` where no wall was fitted.
        imaging: the imaging parameters of the fit.
    """

    wall_mm: Array
    sd_mm: Array
    imaging: Imaging


def fit_walls(
    hu: npt.NDArray[np.float32], lps_from_ijk: Array, points_mm: Array, normals: Array, *, tissue_hu: float
) -> EdgeFit:
    """Fit the outer wall of the bone at each point of a surface.

    Args:
        hu: (slices, rows, columns), the voxels.
        lps_from_ijk: (4, 4), affine of the voxels, mm.
        points_mm: (n, 3), the places, LPS.
        normals: (n, 3), unit, outwards.
        tissue_hu: usual HU around the bone.
    """
    clipped = np.minimum(hu, MAX_HU)
    rows = np.random.default_rng(1).permutation(len(points_mm))[:SAMPLED]
    imaging = imaging_of(clipped, lps_from_ijk, points_mm[rows], normals[rows], tissue_hu=tissue_hu)
    wall, sd = np.empty(len(points_mm)), np.empty(len(points_mm))
    for start in range(0, len(points_mm), CHUNK):
        part = slice(start, start + CHUNK)
        profiles = profiles_of(clipped, lps_from_ijk, points_mm[part], normals[part], imaging.noise_hu)
        parameters, spread, _ = solve(profiles, imaging)
        wall[part], sd[part] = parameters[:, WALL], spread[:, WALL]
    return EdgeFit(wall_mm=wall, sd_mm=sd, imaging=imaging)


def imaging_of(
    hu: npt.NDArray[np.float32], lps_from_ijk: Array, points_mm: Array, normals: Array, *, tissue_hu: float
) -> Imaging:
    """Estimate the HU of the cortex and the blur from the points (n, 3) with thick cortex.

    If there are few, the usual values of compact bone and scanners are returned with their larger spread.
    """
    in_slice_mm = float(np.median(np.linalg.norm(lps_from_ijk[:3, :3], axis=0)))
    usual = Imaging(
        cortex_hu=USUAL_CORTEX_HU,
        cortex_sd_hu=CORTEX_SD_HU,
        blur_mm=BLUR_VOXELS * in_slice_mm,
        blur_sd_log=BLUR_SD_LOG,
        tissue_hu=tissue_hu,
        noise_hu=_noise_hu(hu),
    )
    profiles = profiles_of(hu, lps_from_ijk, points_mm, normals, usual.noise_hu)
    parameters, sd, loss = solve(profiles, usual)
    # Bone without marrow is also fitted by softer bone with a thin shell. If there is marrow, both starts
    # converge to the same fit.
    solid, solid_sd, solid_loss = solve(profiles, usual, thickness_mm=SOLID_MM)
    if np.median(loss - solid_loss) > SOLID_GAIN:
        parameters, sd = solid, solid_sd
    sigma = np.exp(parameters[:, BLUR])
    thick = (parameters[:, THICKNESS] > np.log(THICK_SIGMAS * sigma)) & (sd[:, CORTEX] < 0.5 * CORTEX_SD_HU)
    if np.mean(thick) < MIN_THICK_RATIO:
        return usual
    cortex_hu = float(np.median(parameters[thick, CORTEX]))
    squared = float(np.median(sigma[thick] ** 2 - profiles.voxel_mm[thick] ** 2))
    return replace(
        usual,
        cortex_hu=cortex_hu,
        cortex_sd_hu=LOCAL_CORTEX_RATIO * abs(cortex_hu - tissue_hu),
        blur_mm=float(np.sqrt(max(squared, 0.0))),
        blur_sd_log=LOCAL_BLUR_LOG,
    )


def profiles_of(
    hu: npt.NDArray[np.float32], lps_from_ijk: Array, points_mm: Array, normals: Array, noise_hu: float
) -> Profiles:
    """Sample the voxels along the normals of places (n, 3)."""
    axes = lps_from_ijk[:3, :3]
    step_mm = STEP_VOXELS * float(np.linalg.norm(axes, axis=0).min())
    count = int(np.ceil(REACH_MM / step_mm))
    along = np.asarray(step_mm * np.arange(-count, count + 1), dtype=np.float64)
    points = points_mm[:, None, :] + along[:, None] * normals[:, None, :]
    index = (points - lps_from_ijk[:3, 3]) @ np.linalg.inv(axes).T
    last = np.array(hu.shape[::-1]) - 1.0
    known = ((index >= -1e-6) & (index <= last + 1e-6)).all(axis=-1)
    values = scipy.ndimage.map_coordinates(
        hu, index.reshape(-1, 3)[:, ::-1].T, output=np.float64, order=1, mode="nearest"
    ).reshape(known.shape)
    # A box of width h has the variance h^2 / 12; trilinear interpolation adds h^2 / 6 on average.
    squared = np.maximum(((normals @ axes) ** 2).sum(axis=1), 1e-12)
    return Profiles(
        along_mm=along,
        hu=values,
        weight=(known & _own_wall(values, count, noise_hu)).astype(np.float64),
        voxel_mm=0.5 * np.sqrt(squared),
        step_voxels=step_mm / np.sqrt(squared),
    )


def _own_wall(hu: Array, middle: int, noise_hu: float) -> npt.NDArray[np.bool_]:
    """Return the samples (n, s) up to where a profile rises again, outside of the wall or behind it."""
    near = hu[:, middle // 2 : middle + middle // 2 + 1]
    peak_at = middle // 2 + near.argmax(axis=1)
    n = np.arange(hu.shape[1])
    outwards = n >= peak_at[:, None]
    peak = near.max(axis=1, keepdims=True)
    allowed = np.maximum(RISE_NOISE * noise_hu, RISE_RATIO * (peak - hu.min(axis=1, keepdims=True)))
    lowest_out = np.minimum.accumulate(np.where(outwards, hu, np.inf), axis=1)
    lowest_in = np.minimum.accumulate(np.where(outwards, np.inf, hu)[:, ::-1], axis=1)[:, ::-1]
    rises_out = np.logical_or.accumulate(outwards & (hu > lowest_out + allowed), axis=1)
    rises_in = np.logical_or.accumulate((~outwards & (hu > lowest_in + allowed))[:, ::-1], axis=1)[:, ::-1]
    return np.asarray(~rises_out & ~rises_in)


def solve(
    profiles: Profiles, imaging: Imaging, *, thickness_mm: float = USUAL_THICKNESS_MM
) -> tuple[Array, Array, Array]:
    """Fit the model to each profile: parameters and standard deviations (n, 6), and the loss (n,).

    Gauss-Newton steps with a soft L1 loss and Gaussian priors. `thickness_mm` is the initial thickness.
    """
    mean, sd = _expected(profiles, imaging)
    parameters, precision = mean.copy(), 1.0 / sd**2
    low, high = mean - 4.0 * sd, mean + 4.0 * sd
    low[:, WALL], high[:, WALL] = -MAX_MOVE_MM, MAX_MOVE_MM
    parameters[:, THICKNESS] = np.log(thickness_mm)
    scale_hu = max(MIN_SCALE_HU, imaging.noise_hu, SCALE_RATIO * (imaging.cortex_hu - imaging.tissue_hu))
    diagonal = range(COUNT)
    for _ in range(ROUNDS):
        value, slopes = model(parameters, profiles.along_mm)
        residual, slopes = (profiles.hu - value) / scale_hu, slopes / scale_hu
        weight = profiles.weight / np.sqrt(1.0 + residual**2)
        weighted = (slopes * weight[:, :, None]).transpose(0, 2, 1)
        of_data = weighted @ slopes
        information = of_data.copy()
        information[:, diagonal, diagonal] += precision
        gradient = (weighted @ residual[:, :, None])[:, :, 0] + precision * (mean - parameters)
        step = np.clip(np.linalg.solve(information, gradient[:, :, None])[:, :, 0], -MAX_STEP, MAX_STEP)
        parameters = np.clip(parameters + step, low, high)
    loss = 2.0 * (profiles.weight * (np.sqrt(1.0 + residual**2) - 1.0)).sum(axis=1)
    # Without the prior of the cortex's HU, because it is common to all points.
    loss += (np.delete(precision * (parameters - mean) ** 2, CORTEX, axis=1)).sum(axis=1)
    # Samples closer than a voxel are correlated, and residuals contain model errors besides noise.
    squared = (weight * residual**2).sum(axis=1) / np.maximum(weight.sum(axis=1), 1.0)
    inflation = np.maximum(squared, MIN_SPREAD**2) / np.minimum(profiles.step_voxels, 1.0)
    information = of_data / inflation[:, None, None]
    information[:, diagonal, diagonal] += precision
    covariance = np.linalg.inv(information)
    return parameters, np.sqrt(np.diagonal(covariance, axis1=1, axis2=2)), loss


def _expected(profiles: Profiles, imaging: Imaging) -> tuple[Array, Array]:
    """Return mean and standard deviation (n, 6) of each parameter before the fit."""
    tissue, cortex = imaging.tissue_hu, imaging.cortex_hu
    mean, sd = np.zeros((2, len(profiles.hu), COUNT))
    sd[:, WALL] = WALL_SD_MM
    mean[:, THICKNESS], sd[:, THICKNESS] = np.log(USUAL_THICKNESS_MM), THICKNESS_SD_LOG
    mean[:, BLUR] = 0.5 * np.log(profiles.voxel_mm**2 + imaging.blur_mm**2)
    sd[:, BLUR] = imaging.blur_sd_log
    mean[:, CORTEX], sd[:, CORTEX] = cortex, imaging.cortex_sd_hu
    mean[:, OUTSIDE], sd[:, OUTSIDE] = tissue, OUTSIDE_SD_HU
    mean[:, MARROW], sd[:, MARROW] = tissue + MARROW_RATIO * (cortex - tissue), MARROW_SD_HU
    return mean, sd


def model(parameters: Array, along_mm: Array) -> tuple[Array, Array]:
    """Return the modelled HU (n, s) at places along the normal, and their derivatives (n, s, 6)."""
    wall, cortex, outside, marrow = (parameters[:, n, None] for n in (WALL, CORTEX, OUTSIDE, MARROW))
    thickness, sigma = np.exp(parameters[:, THICKNESS, None]), np.exp(parameters[:, BLUR, None])
    outer = (wall - along_mm) / sigma
    inner = (wall - thickness - along_mm) / sigma
    in_bone, in_core = scipy.special.ndtr(outer), scipy.special.ndtr(inner)
    outer_slope = (cortex - outside) * np.exp(-0.5 * outer**2) / np.sqrt(2.0 * np.pi)
    inner_slope = (marrow - cortex) * np.exp(-0.5 * inner**2) / np.sqrt(2.0 * np.pi)
    jacobian = np.empty((*in_bone.shape, COUNT))
    jacobian[..., WALL] = (outer_slope + inner_slope) / sigma
    jacobian[..., THICKNESS] = -inner_slope * thickness / sigma
    jacobian[..., BLUR] = -outer_slope * outer - inner_slope * inner
    jacobian[..., CORTEX] = in_bone - in_core
    jacobian[..., OUTSIDE] = 1.0 - in_bone
    jacobian[..., MARROW] = in_core
    return outside + (cortex - outside) * in_bone + (marrow - cortex) * in_core, jacobian


def _noise_hu(hu: npt.NDArray[np.float32]) -> float:
    """Estimate noise from second differences along rows; the median is robust to edges and flat padding."""
    second = np.abs(np.diff(hu[::2, ::2, :], n=2, axis=2))
    second = second[hu[::2, ::2, 1:-1] > AIR_HU]
    return float(np.median(second) / (0.6745 * np.sqrt(6.0))) if second.size else 0.0
