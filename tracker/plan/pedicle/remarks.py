"""Warnings about a measured pedicle: what reduces its accuracy, and what to check."""

import numpy as np

from tracker.errors import Remark
from tracker.plan.pedicle.fit import FittedBar, voxel_across_mm
from tracker.plan.pedicle.length import WallAhead
from tracker.plan.pedicle.neighbourhood import Neighbourhood
from tracker.plan.pedicle.search import Bar
from tracker.plan.pedicle.section import Isthmus
from tracker.plan.pedicle.solid import Solid

FEW_VOXELS = 5.0
# Above this influence of the anatomical prior on the angle, a warning is given.
USUAL_RATIO = 0.1
MIN_FACED, ENDPLATE_RATIO = 0.5, 0.7
BODY_WITHIN_MM, BODY_GROWTH = 36.0, 1.4
TOUCHED_MM, PROCESS_MM = 4.0, 4.0
CHECK_LENGTH = "Check the length on the slices."


def canal_remarks(beyond_mm: float, usual_mm: float) -> list[Remark]:
    """Return the warning if bone continues beyond the medial wall, so that the canal begins late."""
    if beyond_mm <= usual_mm:
        return []
    return [
        Remark(
            code="PEDICLE_CANAL_LATE",
            message=f"bone seems to extend {beyond_mm:.0f} mm beyond the medial wall ({usual_mm:.0f} mm are "
            "usual in such voxels); the isthmus may lie too far in front",
            remedy="Check the isthmus on the slices.",
            context={"beyond_mm": beyond_mm, "usual_mm": usual_mm},
        )
    ]


def fit_remarks(
    near: Neighbourhood, solid: Solid, bar: Bar, fitted: FittedBar, isthmus: Isthmus
) -> list[Remark]:
    """Return the warnings that concern section and axis."""
    out = []
    voxels = isthmus.width_mm / voxel_across_mm(near, fitted)[0]
    if voxels < FEW_VOXELS:
        out.append(
            Remark(
                code="PEDICLE_FEW_VOXELS",
                message=f"the pedicle is only {voxels:.1f} voxels wide, a reliable width needs "
                f"{FEW_VOXELS:.0f} or more",
                remedy="Use finer slices if available.",
                context={"voxels": voxels, "needed": FEW_VOXELS},
            )
        )
    if isthmus.is_oblique:
        out.append(
            Remark(
                code="PEDICLE_SECTION_OBLIQUE",
                message=f"its section is oblique, {isthmus.width_mm:.1f} x {isthmus.height_mm:.1f} mm across "
                "its own axes; the smaller extent is given as its width",
                context={"width_mm": isthmus.width_mm, "height_mm": isthmus.height_mm},
            )
        )
    if isthmus.usual_ratio >= USUAL_RATIO:
        change_deg = 10.0 * isthmus.usual_ratio
        out.append(
            Remark(
                code="PEDICLE_ANGLE_UNSURE",
                message="its walls hardly determine its transverse angle: 10 deg of difference in the usual "
                f"angle there would change it by {change_deg:.0f} deg",
                remedy="Check the axis on the slices.",
                context={"change_deg": change_deg},
            )
        )
    if not fitted.fitted:
        out.append(
            Remark(
                code="PEDICLE_WALLS_NOT_FITTED",
                message="too few voxels to fit its walls; the values are those of coarse sections",
            )
        )
    if not bar.opens_ahead and not _widens(solid, isthmus):
        out.append(
            Remark(
                code="PEDICLE_WITHOUT_BODY",
                message=f"it does not widen within {BODY_WITHIN_MM:.0f} mm in front",
                remedy="Check that the click lies in a pedicle.",
                context={"within_mm": BODY_WITHIN_MM},
            )
        )
    if fitted.half_mm <= 3.0 and bar.length_mm < 4.0:
        out.append(
            Remark(
                code="PEDICLE_SHORT",
                message=f"its narrow part is only {bar.length_mm:.1f} mm long; its direction is less certain",
                context={"length_mm": bar.length_mm},
            )
        )
    return out


def _widens(solid: Solid, isthmus: Isthmus) -> bool:
    """Return whether more bone surrounds the axis anteriorly than at the isthmus: the vertebral body."""
    line = isthmus.centre_mm + np.arange(0.0, BODY_WITHIN_MM, 1.0)[:, None] * isthmus.axis
    depth = solid.depth_at(line)
    return bool(depth.max() > BODY_GROWTH * max(float(depth[0]), 1.0))


def front_remarks(front: WallAhead) -> list[Remark]:
    """Return the warning if the axis does not exit through the anterior wall."""
    if not front.found or front.faced_ratio >= MIN_FACED:
        return []
    up = float(front.outwards[2])
    where = "side" if abs(up) < ENDPLATE_RATIO else ("upper endplate" if up > 0.0 else "lower endplate")
    slant_deg = float(np.degrees(np.arccos(np.clip(front.faced_ratio, -1.0, 1.0))))
    return [
        Remark(
            code="PEDICLE_AXIS_LEAVES_ASIDE",
            message=f"the axis leaves the body through its {where} (at {slant_deg:.0f} deg to its normal), "
            "not the front wall; the length ends there",
            remedy=CHECK_LENGTH,
            context={"body_wall": where, "slant_deg": slant_deg},
        )
    ]


def length_remarks(front: WallAhead, back: WallAhead) -> list[Remark]:
    """Return the warnings that concern the length."""
    out = []
    if front.found and front.beyond_mm > TOUCHED_MM:
        out.append(
            Remark(
                code="PEDICLE_FRONT_TOUCHED",
                message="something as dense as bone touches the front wall, perhaps a vessel with contrast; "
                "the length ends at the outline of the body",
                remedy=CHECK_LENGTH,
            )
        )
    if back.found and back.beyond_mm > PROCESS_MM:
        out.append(
            Remark(
                code="PEDICLE_BEHIND_PROCESS",
                message=f"behind the entry the axis runs on through a process for {back.beyond_mm:.0f} mm; "
                "the length begins where the arch around it ends",
                context={"beyond_mm": back.beyond_mm},
            )
        )
    if not front.found:
        out.append(
            Remark(
                code="PEDICLE_FRONT_UNSURE",
                message="no front wall was found with certainty; the length ends where bone may end",
                remedy=CHECK_LENGTH,
            )
        )
    if not back.found:
        out.append(
            Remark(
                code="PEDICLE_BACK_NOT_FOUND",
                message="no bone surface was found behind; entry and length extend to the end of the visible "
                "part",
            )
        )
    return out
