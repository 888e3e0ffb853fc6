"""The sentences that belong to a pedicle's numbers: what makes them less sure, and what to look at."""

import numpy as np

from tracker.plan.pedicle.fit import FittedBar, voxel_across_mm
from tracker.plan.pedicle.length import WallAhead
from tracker.plan.pedicle.neighbourhood import Neighbourhood
from tracker.plan.pedicle.search import Bar
from tracker.plan.pedicle.section import Isthmus
from tracker.plan.pedicle.solid import Solid

USUAL_LENGTH_MM = (25.0, 75.0)
FEW_VOXELS = 5.0
# From here on it is said that the angle follows what is usual: a degree for ten.
USUAL_RATIO = 0.1
MIN_FACED, ENDPLATE_RATIO = 0.5, 0.7
BODY_WITHIN_MM, BODY_GROWTH = 36.0, 1.4
TOUCHED_MM, PROCESS_MM = 4.0, 4.0


def canal_remarks(beyond_mm: float, usual_mm: float) -> list[str]:
    """What is said where bone seems to go on beside the medial wall, and the canal begins late."""
    if beyond_mm <= usual_mm:
        return []
    return [
        f"bone seems to go on for {beyond_mm:.0f} mm beyond the medial wall ({usual_mm:.0f} mm are usual in "
        "such voxels); the isthmus may lie too far in front, check it on the slices"
    ]


def fit_remarks(
    near: Neighbourhood, solid: Solid, bar: Bar, fitted: FittedBar, isthmus: Isthmus
) -> list[str]:
    """What makes the section and its axis less sure."""
    out = []
    voxels = isthmus.width_mm / voxel_across_mm(near, fitted)
    if voxels < FEW_VOXELS:
        out.append(
            f"the pedicle is only {voxels:.1f} voxels wide, {FEW_VOXELS:.0f} or more tell its width surely; "
            "use finer slices if there are any"
        )
    if isthmus.is_aslant:
        out.append(
            f"its section stands aslant, {isthmus.width_mm:.1f} x {isthmus.height_mm:.1f} mm across its own "
            "axes; the lesser is given as its width"
        )
    if isthmus.usual_ratio >= USUAL_RATIO:
        out.append(
            "its own walls tell little of its transverse angle: were what is usual there another by 10 deg, "
            f"it would be another by {10.0 * isthmus.usual_ratio:.0f} deg; look at the axis on the slices"
        )
    if not fitted.fitted:
        out.append("too few voxels to fit its walls; the numbers are those of coarse sections")
    if not bar.opens_ahead and not _widens(solid, isthmus):
        out.append(
            f"it does not widen within {BODY_WITHIN_MM:.0f} mm in front; "
            "check that the click lies in a pedicle"
        )
    if fitted.half_mm <= 3.0 and bar.length_mm < 4.0:
        out.append(f"its narrow part is only {bar.length_mm:.1f} mm long; its direction is less sure")
    return out


def _widens(solid: Solid, isthmus: Isthmus) -> bool:
    """Whether more bone stands around the axis in front than at the isthmus: the body, though far ahead."""
    line = isthmus.centre_mm + np.arange(0.0, BODY_WITHIN_MM, 1.0)[:, None] * isthmus.axis
    depth = solid.depth_at(line)
    return bool(depth.max() > BODY_GROWTH * max(float(depth[0]), 1.0))


def front_remarks(front: WallAhead) -> list[str]:
    """Where the axis does not leave through the front wall."""
    if not front.found or front.faced_ratio >= MIN_FACED:
        return []
    up = float(front.outwards[2])
    where = "side" if abs(up) < ENDPLATE_RATIO else ("upper endplate" if up > 0.0 else "lower endplate")
    slant_deg = float(np.degrees(np.arccos(np.clip(front.faced_ratio, -1.0, 1.0))))
    return [
        f"the axis leaves the body through its {where} ({slant_deg:.0f} deg aslant), not through the front "
        "wall; the length ends there, check it"
    ]


def length_remarks(front: WallAhead, back: WallAhead) -> list[str]:
    """What makes the length less sure."""
    out = []
    if front.found and front.beyond_mm > TOUCHED_MM:
        out.append(
            "something as dense as bone touches the front wall, perhaps a vessel with contrast; "
            "the length ends at the outline of the body, check it"
        )
    if back.found and back.beyond_mm > PROCESS_MM:
        out.append(
            f"behind the entry the axis runs on through a process for {back.beyond_mm:.0f} mm; "
            "the length begins where the arch around it ends"
        )
    if not front.found:
        out.append("no front wall was met surely; the length ends where bone may end, check it")
    if not back.found:
        out.append("no bone surface was met behind; entry and length reach to the end of what can be seen")
    length = front.distance_mm + back.distance_mm
    if front.found and back.found and not USUAL_LENGTH_MM[0] <= length <= USUAL_LENGTH_MM[1]:
        out.append(
            f"a length of {length:.1f} mm is unusual "
            f"({USUAL_LENGTH_MM[0]:.0f} to {USUAL_LENGTH_MM[1]:.0f} mm are usual); check entry and front wall"
        )
    return out
