"""Start points for the measurement of both pedicles, from the label of a vertebra.

Between the body and the posterior arch of a vertebra lies the canal; beside it, only the pedicles connect the
two. Along the direction from the body to the arch, the cross-section of the label on one side is therefore
smallest at the isthmus of the pedicle. The method needs no HU and no shape of a vertebra:

1. The centre of the body is the voxel that is deepest inside of the label.
2. The posterior direction is that from there to the centroid of the label, in the axial plane.
3. Above and below, what lies beyond the body is ignored: processes reach to the neighbours.
4. In the middle, the label has a gap from the posterior wall of the body to the lamina: the canal. The wall
   gives the tilt of the vertebra in the sagittal plane, and with it the posterior direction again.
5. On each side of it, the section of the label across that direction is smallest at the isthmus. The start
   point is the deepest voxel in the middle of the sections that are nearly as small.

The measurement of the pedicle then finds the isthmus in the CT; the start point only has to lie in it.
"""

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt
import scipy

from tracker.errors import PlanError
from tracker.geometry import Array
from tracker.plan.labels.label_volume import LabelVolume
from tracker.plan.pedicle import SIDES, Side

# Half width of the strip in the middle in which the canal is looked for; a canal is 12 mm wide or more.
MIDDLE_MM = 2.5
# The canal is 10 to 30 mm deep; a shorter gap is a hole in the label.
MIN_CANAL_MM = 6.0
BIN_MM = 1.0
# Sections are averaged over this length, so that no single row of voxels is the smallest.
SECTION_MM = 3.0
MIN_SECTION_MM2 = 15.0
# Sections up to this ratio of the smallest count as narrow; the start lies in the middle of them.
NARROW_RATIO = 1.15
# Part of the height of the body in which its posterior wall is straight.
STRAIGHT_RATIO = 0.8
MAX_TILT_DEG = 50.0
BY_CLICK = "Click into the pedicle on the CT."


@dataclass(frozen=True, slots=True, kw_only=True)
class StartPoint:
    """Start of the measurement of one pedicle.

    Attributes:
        side: of the patient.
        point_lps_mm: (3,), inside of the label.
        section_mm2: area of the label's section there, across the posterior direction.
    """

    side: Side
    point_lps_mm: Array
    section_mm2: float


@dataclass(frozen=True, slots=True, kw_only=True)
class _LabelVoxels:
    """Voxels (n) of a label: coordinates from the centre of the body, and depth inside of it, in mm."""

    points_mm: Array
    left_mm: Array
    back_mm: Array
    up_mm: Array
    depth_mm: Array
    voxel_mm3: float

    @property
    def body_mm(self) -> float:
        """Radius of the largest ball in the label, which lies in the body."""
        return float(self.depth_mm.max())

    @property
    def is_at_body(self) -> npt.NDArray[np.bool_]:
        """Which voxels lie at the height of the body."""
        return np.asarray(np.abs(self.up_mm) <= 1.5 * self.body_mm)

    def tilted(self, slope: float) -> "_LabelVoxels":
        """Return the coordinates with the direction upwards leaning backwards by `slope` mm a mm."""
        length = float(np.hypot(1.0, slope))
        return replace(
            self,
            up_mm=(self.up_mm + slope * self.back_mm) / length,
            back_mm=(self.back_mm - slope * self.up_mm) / length,
        )


def pedicle_start_points(labels: LabelVolume, level: str) -> tuple[StartPoint, ...]:
    """Return a start point in the left and in the right pedicle.

    Args:
        labels: labels in the CT.
        level: `L3`.

    Raises:
        PlanError: LEVEL_WITHOUT_LABEL; LABEL_WITHOUT_PEDICLES, it has no canal between
            a body and an arch, or no connection beside it.
    """
    voxels = _voxels_of(labels, level)
    slope = _wall_slope(voxels)
    voxels = voxels.tilted(slope)
    canal = _canal(voxels)
    if canal is None:
        raise _without(level, "no canal lies between a body and an arch")
    found = []
    for side in SIDES:
        sign = 1.0 if side == "left" else -1.0
        start = _narrowest(voxels, voxels.is_at_body & (sign * voxels.left_mm > MIDDLE_MM), canal)
        if start is None:
            raise _without(level, f"nothing connects body and arch on the {side} side")
        found.append(StartPoint(side=side, point_lps_mm=start[0], section_mm2=start[1]))
    return tuple(found)


def _voxels_of(labels: LabelVolume, level: str) -> _LabelVoxels:
    try:
        part = labels.cropped_to(level)
    except KeyError:
        listed = ", ".join(labels.levels)
        raise PlanError(
            "LEVEL_WITHOUT_LABEL",
            f"the segmentation has no label {level[:20]}, only {listed}",
            BY_CLICK,
            {"level": level[:20], "listed": listed},
        ) from None
    depth = np.asarray(
        scipy.ndimage.distance_transform_edt(part.labels > 0, sampling=part.spacing_mm[::-1]),
        dtype=np.float64,
    )
    index = np.argwhere(part.labels > 0)
    points = part.lps_from_index(index[:, ::-1])
    depth_mm = depth[tuple(index.T)]
    body = points[int(depth_mm.argmax())]
    back = (points.mean(axis=0) - body) * [1.0, 1.0, 0.0]
    length = float(np.linalg.norm(back))
    if length < BIN_MM or back[1] <= 0.0:
        raise _without(level, "it does not reach from a body backwards")
    back /= length
    left = np.array([back[1], -back[0], 0.0])
    from_body = points - body
    return _LabelVoxels(
        points_mm=points,
        left_mm=from_body @ left,
        back_mm=from_body @ back,
        up_mm=from_body[:, 2],
        depth_mm=depth_mm,
        voxel_mm3=abs(float(np.linalg.det(part.lps_from_ijk[:3, :3]))),
    )


def _wall_slope(voxels: _LabelVoxels) -> float:
    """Return how far the posterior wall of the body leans backwards, in mm a mm upwards; 0 if unknown."""
    reach_mm = STRAIGHT_RATIO * voxels.body_mm
    is_middle = (np.abs(voxels.left_mm) <= MIDDLE_MM) & (voxels.back_mm >= 0.0)
    heights, walls = [], []
    for height_mm in np.arange(-reach_mm, reach_mm, BIN_MM):
        backs = np.sort(voxels.back_mm[is_middle & (np.abs(voxels.up_mm - height_mm) <= BIN_MM)])
        gaps = np.flatnonzero(np.diff(backs) >= MIN_CANAL_MM / 2)
        if len(backs):
            heights.append(height_mm)
            walls.append(backs[gaps[0]] if len(gaps) else backs[-1])
    if len(heights) < 3:
        return 0.0
    # The median of the slopes between all pairs of heights (Theil-Sen): a lamina is not a part of the wall.
    first, second = np.triu_indices(len(heights), 1)
    rises = (np.array(walls)[second] - np.array(walls)[first]) / (
        np.array(heights)[second] - np.array(heights)[first]
    )
    slope = float(np.median(rises))
    limit = float(np.tan(np.radians(MAX_TILT_DEG)))
    return min(max(slope, -limit), limit)


def _canal(voxels: _LabelVoxels) -> tuple[float, float] | None:
    """Return where the canal begins and ends behind the centre of the body; None without one."""
    is_middle = voxels.is_at_body & (np.abs(voxels.left_mm) <= MIDDLE_MM) & (voxels.back_mm >= 0.0)
    backs = np.sort(voxels.back_mm[is_middle])
    if len(backs) < 2:
        return None
    gaps = np.diff(backs)
    widest = int(gaps.argmax())
    if gaps[widest] < MIN_CANAL_MM:
        return None
    return float(backs[widest]), float(backs[widest + 1])


def _narrowest(
    voxels: _LabelVoxels, is_side: npt.NDArray[np.bool_], canal: tuple[float, float]
) -> tuple[Array, float] | None:
    """Return deepest point and area of the smallest section beside the canal; None if one is empty."""
    centres = np.arange(canal[0], canal[1] + BIN_MM, BIN_MM)
    backs = np.sort(voxels.back_mm[is_side])
    ends = np.searchsorted(backs, np.stack([centres - SECTION_MM / 2, centres + SECTION_MM / 2]))
    areas = (ends[1] - ends[0]) * voxels.voxel_mm3 / SECTION_MM
    if areas.min() < MIN_SECTION_MM2:
        return None
    narrow = np.flatnonzero(areas <= NARROW_RATIO * areas.min())
    narrowest = int(narrow[len(narrow) // 2])
    is_section = is_side & (np.abs(voxels.back_mm - centres[narrowest]) <= SECTION_MM / 2)
    deepest = int(np.where(is_section, voxels.depth_mm, -1.0).argmax())
    return voxels.points_mm[deepest], float(areas[narrowest])


def _without(level: str, why: str) -> PlanError:
    return PlanError(
        "LABEL_WITHOUT_PEDICLES",
        f"the pedicles cannot be found in the label {level}: {why}",
        BY_CLICK,
        {"level": level, "label_problem": why},
    )
