"""Affine of a NIfTI file in LPS mm: choice of sform or qform, and unit."""

from dataclasses import dataclass

import nibabel as nib
import numpy as np

from tracker.errors import InvalidInput, Remark
from tracker.geometry import Array

LPS_FROM_RAS = np.diag([-1.0, -1.0, 1.0, 1.0])
UNITS = {0: ("unknown", 1.0), 1: ("metres", 1000.0), 2: ("mm", 1.0), 3: ("micrometres", 0.001)}
MIN_VOXEL_MM, MAX_VOXEL_MM = 0.02, 20.0
# Talairach and MNI: deformed to an atlas, so that lengths are not those of the patient.
ATLAS_CODES = {3, 4, 5}
CONVERT = "Convert the CT again with its geometry (dcm2niix does), or give its DICOM slices."


@dataclass(frozen=True, slots=True, kw_only=True)
class NiftiPlacement:
    """Geometry of the voxels.

    Attributes:
        lps_from_ijk: (4, 4), in mm.
        warnings: Warnings about it.
    """

    lps_from_ijk: Array
    warnings: tuple[Remark, ...]


def placement_from_header(header: nib.Nifti1Header, shape_ijk: tuple[int, ...]) -> NiftiPlacement:
    """Return the affine of a NIfTI header in LPS mm.

    Raises:
        InvalidInput: CT_AFFINE_MISSING, CT_AFFINES_CONTRADICT, CT_AFFINE_INVALID, CT_ATLAS_SPACE or
            CT_VOXEL_SIZE_ODD.
    """
    ras, warnings = _ras(header, shape_ijk)
    # Read here, because nibabel fails on an unknown time unit in the same byte.
    unit, scale = UNITS.get(int(header["xyzt_units"]) % 8, ("unknown", 1.0))
    if scale != 1.0:
        warnings.append(
            Remark(
                code="CT_UNIT_CONVERTED",
                message=f"the file states its geometry in {unit}; it was multiplied by {scale:g} to mm",
                context={"length_unit": unit, "scale": scale},
            )
        )
    affine = LPS_FROM_RAS @ ras
    affine[:3] *= scale
    _check_size(affine, unit)
    return NiftiPlacement(lps_from_ijk=affine, warnings=tuple(warnings))


def _ras(header: nib.Nifti1Header, shape_ijk: tuple[int, ...]) -> tuple[Array, list[Remark]]:
    """Return the affine to use, as stored, with warnings about it."""
    s_code, q_code = int(header["sform_code"]), int(header["qform_code"])
    if s_code == 0 and q_code == 0:
        raise InvalidInput(
            "CT_AFFINE_MISSING",
            "the NIfTI does not state the positions of its voxels (sform and qform code are both 0), so that "
            "left, right and sizes are unknown",
            CONVERT,
            {"sform_code": 0, "qform_code": 0},
        )
    candidates = _candidates(header, s_code, q_code)
    usable = [(name, affine) for name, code, affine in candidates if code not in ATLAS_CODES]
    if not usable:
        raise InvalidInput(
            "CT_ATLAS_SPACE",
            f"the NIfTI is deformed to an atlas (code {candidates[0][1]}), so that lengths are not those of "
            "the patient",
            "Give the original CT.",
            {"code": candidates[0][1]},
        )
    for name, affine in usable:
        if not np.isfinite(affine).all() or abs(_determinant(affine)) < 1e-3:
            raise InvalidInput(
                "CT_AFFINE_INVALID",
                f"the {name} of the NIfTI is singular or not finite",
                CONVERT,
                {"affine": name},
            )
    if len(usable) == 1:
        return usable[0][1], []
    return usable[0][1], _compared(usable[0][1], usable[1][1], shape_ijk)


def _candidates(header: nib.Nifti1Header, s_code: int, q_code: int) -> list[tuple[str, int, Array]]:
    """Return the affines of the file, the one that programs prefer first."""
    found = []
    if s_code > 0:
        found.append(("sform", s_code, np.array(header.get_sform(), dtype=np.float64)))
    if q_code > 0:
        try:
            found.append(("qform", q_code, np.array(header.get_qform(), dtype=np.float64)))
        except (nib.spatialimages.HeaderDataError, ValueError):
            found.append(("qform", q_code, np.full((4, 4), np.nan)))
    return found


def _determinant(affine: Array) -> float:
    lengths = np.linalg.norm(affine[:3, :3], axis=0)
    return float(np.linalg.det(affine[:3, :3] / np.maximum(lengths, 1e-12))) if lengths.min() > 0.0 else 0.0


def _compared(sform: Array, qform: Array, shape_ijk: tuple[int, ...]) -> list[Remark]:
    """Return warnings about two affines of a file; they may differ in position, not in size or mirroring."""
    sizes = [np.linalg.norm(affine[:3, :3], axis=0) for affine in (sform, qform)]
    mirrored = _determinant(sform) * _determinant(qform) < 0.0
    context: dict[str, object] = {"sform_mm": sizes[0].tolist(), "qform_mm": sizes[1].tolist()}
    if mirrored:
        raise InvalidInput(
            "CT_AFFINES_CONTRADICT",
            "the NIfTI's sform and qform contradict each other: one is the mirror image of the other",
            CONVERT,
            context,
        )
    if np.abs(sizes[0] / sizes[1] - 1.0).max() > 0.005:
        sform_size, qform_size = ("x".join(f"{mm:.3f}" for mm in size) for size in sizes)
        raise InvalidInput(
            "CT_AFFINES_CONTRADICT",
            f"the NIfTI's sform and qform contradict each other: voxels of {sform_size} and {qform_size} mm",
            CONVERT,
            {**context, "sform_size": sform_size, "qform_size": qform_size},
        )
    corners = np.array(np.meshgrid(*[[0.0, size - 1.0] for size in shape_ijk], [1.0])).reshape(4, -1)
    difference_mm = float(np.linalg.norm(((sform - qform) @ corners)[:3], axis=0).max())
    if difference_mm <= 0.1:
        return []
    return [
        Remark(
            code="CT_AFFINES_DIFFER",
            message=f"the sform and qform of the NIfTI differ by up to {difference_mm:.1f} mm; the sform is "
            "used",
            context={"difference_mm": difference_mm},
        )
    ]


def _check_size(affine: Array, unit: str) -> None:
    sizes = np.linalg.norm(affine[:3, :3], axis=0)
    if sizes.min() >= MIN_VOXEL_MM and sizes.max() <= MAX_VOXEL_MM:
        return
    size_text = " x ".join(f"{size:g}" for size in sizes)
    guess = ""
    for name, factor in (("metres", 1000.0), ("micrometres", 0.001)):
        if sizes.min() * factor >= MIN_VOXEL_MM and sizes.max() * factor <= MAX_VOXEL_MM:
            guess = f"; they would be plausible in {name}"
    raise InvalidInput(
        "CT_VOXEL_SIZE_ODD",
        f"the voxels have {size_text} mm (unit in the file: {unit}), allowed: {MIN_VOXEL_MM} to "
        f"{MAX_VOXEL_MM:.0f} mm{guess}",
        CONVERT,
        {
            "voxel_mm": sizes.tolist(),
            "size": size_text,
            "unit": unit,
            "min_mm": MIN_VOXEL_MM,
            "max_mm": MAX_VOXEL_MM,
            "voxel_unit_guess": guess,
        },
    )
