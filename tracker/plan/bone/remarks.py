"""Warnings about an extracted bone surface."""

import numpy as np
import numpy.typing as npt

from tracker.errors import Remark
from tracker.geometry import Array
from tracker.plan.bone.threshold import ThresholdProposal

ENDS = ("first column", "first row", "first slice", "last column", "last row", "last slice")
# A threshold that differs from the proposal by more moves the wall of a pedicle by a large part of a voxel.
FAR_FROM_PROPOSAL_HU = 150.0


def remarks_of(
    at_end: npt.NDArray[np.bool_],
    averaged_ijk: tuple[int, int, int],
    voxel_mm: Array,
    threshold_hu: float,
    proposal: ThresholdProposal,
    *,
    given: float | None,
) -> tuple[tuple[str, ...], tuple[Remark, ...]]:
    """Return the CT ends at which the bone is cut, and the warnings; at_end is (n, 6) as `ENDS`."""
    ends = tuple(name for name, cut in zip(ENDS, np.ravel(at_end.any(axis=0)), strict=True) if cut)
    remarks = []
    if cut := ", ".join(ends):
        remarks.append(
            Remark(
                code="BONE_CUT_BY_CT",
                message=f"the bone continues beyond the CT: it is cut at the {cut}",
                remedy="Plan only on complete bone, or scan a larger part of the patient.",
                context={"cut_at": list(ends), "cut_ends": cut},
            )
        )
    if max(averaged_ijk) > 1:
        size = " x ".join(f"{value:.2f}" for value in voxel_mm)
        averaged = " x ".join(map(str, averaged_ijk))
        remarks.append(
            Remark(
                code="BONE_AVERAGED",
                message="there are too many voxels for full resolution, so "
                f"{averaged} of them were averaged to one of {size} mm",
                remedy="Give a region around one vertebra: its voxels are few enough.",
                context={
                    "averaged_ijk": list(averaged_ijk),
                    "voxel_mm": np.asarray(voxel_mm).tolist(),
                    "averaged": averaged,
                    "size": size,
                },
            )
        )
    if given is not None and abs(threshold_hu - proposal.threshold_hu) > FAR_FROM_PROPOSAL_HU:
        remarks.append(
            Remark(
                code="BONE_THRESHOLD_UNUSUAL",
                message=f"the threshold of {threshold_hu:.0f} HU is far from the "
                f"{proposal.threshold_hu:.0f} HU that the histogram proposes",
                remedy="Compare the surface with the slices before planning on it.",
                context={"threshold_hu": threshold_hu, "proposed_hu": proposal.threshold_hu},
            )
        )
    return ends, tuple(remarks)
