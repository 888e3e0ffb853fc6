"""Isosurface of the bone in a CT (marching cubes), with a record of how it was computed."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
import skimage

from tracker.errors import PlanError, Remark
from tracker.geometry import Array
from tracker.plan.bone.block import MAX_VOXELS, Block, block_of
from tracker.plan.bone.region import Region
from tracker.plan.bone.remarks import remarks_of
from tracker.plan.bone.threshold import ThresholdProposal, proposed_threshold
from tracker.plan.edge_model import fit_walls
from tracker.plan.surface import Surface
from tracker.plan.triangles import (
    connectivity_of,
    decimated,
    largest_part,
    referenced,
    smoothed,
    smoothed_values,
    vertex_normals,
)
from tracker.plan.triangles.connectivity import Faces, parts_of
from tracker.plan.volume import Volume

# Marching cubes creates two triangles per vertex; 3 million vertices need about 1 GB during extraction.
MAX_VERTICES = 3_000_000

MIN_FITTED_FACES = 60_000
# Sd of the difference of wall offsets between neighbouring vertices.
NEIGHBOUR_SD_MM = 0.03
# Model error of a wall in voxels, because real cortex is porous and its blur uneven. On phantoms the
# covariance of the fit is sufficient; on cadavers the thickness had errors of 0.6 mm at single points (Treece
# 2010).
MODEL_VOXELS = 0.25
OTHER_REGION = "Give a region in which there is bone, or another threshold."


@dataclass(frozen=True, slots=True, kw_only=True)
class BoneSettings:
    """Parameters of the surface extraction.

    Attributes:
        threshold_hu: minimum HU of bone; None takes the proposal from the histogram.
        region: region of interest; None is the whole CT.
        largest_part_only: keep only the largest connected component.
        smoothing_rounds: of Taubin's smoothing, before and after the walls are fitted; 0 for none.
        max_faces: triangles of the result; None leaves all.
        max_voxels: a larger volume is downsampled.

    Raises:
        PlanError: BONE_SETTINGS_INVALID.
    """

    threshold_hu: float | None = None
    region: Region | None = None
    largest_part_only: bool = True
    smoothing_rounds: int = 10
    max_faces: int | None = 60_000
    max_voxels: int = MAX_VOXELS

    def __post_init__(self) -> None:
        problem = ""
        if self.threshold_hu is not None and not np.isfinite(self.threshold_hu):
            problem = f"its threshold is {self.threshold_hu} HU"
        elif not 0 <= self.smoothing_rounds <= 200:
            problem = f"{self.smoothing_rounds} rounds of smoothing, allowed 0 to 200"
        elif self.max_faces is not None and self.max_faces < 100:
            problem = f"at most {self.max_faces} triangles, allowed 100 or more"
        elif self.max_voxels < 1000:
            problem = f"at most {self.max_voxels} voxels, allowed 1000 or more"
        if problem:
            raise PlanError(
                "BONE_SETTINGS_INVALID",
                f"the bone surface cannot be extracted: {problem}",
                "Give a threshold in HU, 0 to 200 rounds of smoothing, and 100 triangles or more.",
                {"bone_problem": problem},
            )


@dataclass(frozen=True, slots=True, kw_only=True)
class BoneSurface:
    """The bone surface and the processing that produced it.

    Attributes:
        surface: in the vertebra's frame, wound outwards.
        threshold_hu: minimum HU of bone that was used.
        proposal: the proposal from the histogram, used or not.
        region: region of interest; None is the whole CT.
        averaged_ijk: downsampling factors along i, j, k; all 1 without downsampling.
        voxel_mm: (3,) spacing of the voxels after downsampling.
        smoothing_rounds: of Taubin's smoothing.
        sd_mm: standard deviation of the wall's position in this CT.
        moved_mm: median offset of the wall from the threshold's surface; negative is inwards.
        parts: number of connected components.
        faces_before: number of triangles before decimation.
        closed: whether the surface is closed.
        cut_at: which ends of the CT the bone reaches, as "first slice", "last column" and so on.
        remarks: warnings for the user.
    """

    surface: Surface
    threshold_hu: float
    proposal: ThresholdProposal
    region: Region | None
    averaged_ijk: tuple[int, int, int]
    voxel_mm: Array
    smoothing_rounds: int
    sd_mm: float
    moved_mm: float
    parts: int
    faces_before: int
    closed: bool
    cut_at: tuple[str, ...]
    remarks: tuple[Remark, ...]


def bone_surface(volume: Volume, settings: BoneSettings | None = None) -> BoneSurface:
    """Extract the bone in a region: segmented by a threshold, with walls located by an edge fit.

    The threshold only segments the bone; its wall is fitted (see `edge_model`), because the isosurface of a
    threshold that detects thin cortex lies outside the bone.

    The surface is open where the region or the CT ends.

    Raises:
        PlanError: REGION_OUTSIDE; BONE_THRESHOLD_OUTSIDE, no voxel is brighter, or none is darker;
            BONE_NOT_FOUND; BONE_TOO_LARGE.
    """
    settings = settings or BoneSettings()
    block = block_of(volume, settings.region, max_voxels=settings.max_voxels)
    proposal = proposed_threshold(_as_int16(block.hu))
    threshold = proposal.threshold_hu if settings.threshold_hu is None else settings.threshold_hu
    vertices_kji, faces = _triangles(block.hu, threshold)
    vertices, faces, cut_at = _placed(vertices_kji, faces, block, volume, settings.region)
    if settings.largest_part_only:
        parts, faces = largest_part(vertices, faces)
    else:
        parts, _ = parts_of(faces, vertices.shape[0])
    cut_at = cut_at[np.isin(np.arange(vertices.shape[0]), faces)]
    vertices, faces = referenced(vertices, faces)
    faces_before = int(faces.shape[0])
    vertices = smoothed(vertices, faces, rounds=settings.smoothing_rounds)
    # Walls are fitted on a finer mesh than the result, because the chords of coarse triangles leave the wall.
    if settings.max_faces is not None:
        vertices, faces = decimated(vertices, faces, max_faces=max(settings.max_faces, MIN_FITTED_FACES))
    vertices, sd_mm, moved_mm = _on_edges(vertices, faces, block, volume, proposal.surroundings_hu)
    vertices = smoothed(vertices, faces, rounds=settings.smoothing_rounds)
    if settings.max_faces is not None:
        vertices, faces = decimated(vertices, faces, max_faces=settings.max_faces)
    averaged = (int(block.averaged_ijk[0]), int(block.averaged_ijk[1]), int(block.averaged_ijk[2]))
    voxel_mm = volume.spacing_mm * block.averaged_ijk
    ends, remarks = remarks_of(cut_at, averaged, voxel_mm, threshold, proposal, given=settings.threshold_hu)
    return BoneSurface(
        surface=Surface(vertices_mm=vertices, faces=faces),
        threshold_hu=float(threshold),
        proposal=proposal,
        region=settings.region,
        averaged_ijk=averaged,
        voxel_mm=voxel_mm,
        smoothing_rounds=settings.smoothing_rounds,
        sd_mm=sd_mm,
        moved_mm=moved_mm,
        parts=parts,
        faces_before=faces_before,
        closed=connectivity_of(faces).closed,
        cut_at=ends,
        remarks=remarks,
    )


def _on_edges(
    vertices_mm: Array, faces: Faces, block: Block, volume: Volume, tissue_hu: float
) -> tuple[Array, float, float]:
    """Return vertices on the fitted wall, its standard deviation and the median offset."""
    normals = vertex_normals(vertices_mm, faces)
    affine = volume.lps_from_ijk.copy()
    affine[:3, :3] = affine[:3, :3] * block.averaged_ijk
    affine[:3, 3] = volume.lps_from_index(block.index_in_volume(np.zeros((1, 3)))[0])
    fitted = fit_walls(block.hu, affine, vertices_mm, normals, tissue_hu=tissue_hu)
    offset_mm = smoothed_values(fitted.wall_mm, fitted.sd_mm, faces, step_sd=NEIGHBOUR_SD_MM)
    model_mm = MODEL_VOXELS * float(np.cbrt(abs(np.linalg.det(affine[:3, :3]))))
    sd_mm = float(np.hypot(np.sqrt(np.mean(fitted.sd_mm**2)), model_mm))
    return vertices_mm + offset_mm[:, None] * normals, sd_mm, float(np.median(offset_mm))


def _as_int16(hu: npt.NDArray[np.float32]) -> npt.NDArray[np.int16]:
    return np.asarray(np.rint(hu), dtype=np.int16)


def _triangles(hu: npt.NDArray[np.float32], threshold_hu: float) -> tuple[Array, Faces]:
    """Run marching cubes: vertices (n, 3) as k, j, i and faces (m, 3), outward as i, j, k."""
    low, high = float(hu.min()), float(hu.max())
    if not low < threshold_hu <= high:
        raise PlanError(
            "BONE_THRESHOLD_OUTSIDE",
            f"a threshold of {threshold_hu:.0f} HU separates no voxels, which range from {low:.0f} to "
            f"{high:.0f} HU",
            "Give a threshold between them, or a region in which there is bone.",
            {"threshold_hu": threshold_hu, "lowest_hu": low, "highest_hu": high},
        )
    # Many voxels have exactly an integer HU, which would create degenerate triangles. Half a unit less
    # segments the same voxels.
    level = float(np.ceil(threshold_hu)) - 0.5
    bone = hu >= level
    crossings = sum(int(np.count_nonzero(np.diff(bone, axis=axis))) for axis in range(3))
    if crossings > MAX_VERTICES:
        raise PlanError(
            "BONE_TOO_LARGE",
            f"at {threshold_hu:.0f} HU the surface has {crossings} vertices, allowed {MAX_VERTICES}",
            "Give a region around one vertebra, or a higher threshold above the noise.",
            {"vertices": crossings, "threshold_hu": threshold_hu, "max_vertices": MAX_VERTICES},
        )
    if crossings == 0:
        raise _not_found(threshold_hu)
    vertices, faces, _, _ = skimage.measure.marching_cubes(
        hu, level, gradient_direction="descent", allow_degenerate=False
    )
    return np.asarray(vertices, dtype=np.float64), np.asarray(faces, dtype=np.int64)


def _placed(
    vertices_kji: Array, faces: Faces, block: Block, volume: Volume, region: Region | None
) -> tuple[Array, Faces, npt.NDArray[np.bool_]]:
    """Return vertices in mm, clipped to the region, and which (n, 6) lie at which end of the CT."""
    last = np.array(block.hu.shape)[::-1] - 1
    own = vertices_kji[:, ::-1]
    at_end = np.stack([own < 1e-3, own > last - 1e-3], axis=1) & block.cut_ijk
    vertices = volume.lps_from_index(block.index_in_volume(vertices_kji))
    if np.linalg.det(volume.lps_from_ijk[:3, :3]) < 0.0:
        faces = faces[:, ::-1]
    if region is not None:
        inside = region.contains(vertices)
        faces = faces[inside[faces].all(axis=1)]
        if faces.shape[0] == 0:
            raise _not_found(None)
    return vertices, faces, at_end.reshape(-1, 6)


def _not_found(threshold_hu: float | None) -> PlanError:
    if threshold_hu is None:
        return PlanError("BONE_NOT_FOUND", "there is no bone surface in this region", OTHER_REGION)
    return PlanError(
        "BONE_NOT_FOUND",
        f"there is no bone surface in this region at {threshold_hu:.0f} HU",
        OTHER_REGION,
        {"threshold_hu": threshold_hu},
    )
