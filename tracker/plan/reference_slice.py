"""The paper's reference image: one axial slice, three registration lines, the ideal paths."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tracker.errors import PlanError
from tracker.geometry import Array
from tracker.plan.channel import Channel
from tracker.plan.pedicle import PedicleMeasure
from tracker.plan.volume import Volume

AHEAD_MM, MAX_BEHIND_ENTRY_MM = 50.0, 60.0
MIN_APART_MM = 1.0


@dataclass(frozen=True, slots=True, kw_only=True)
class SliceLine:
    """A straight line on a slice.

    Attributes:
        name: `middle`, `left` or `right` for the lines to register by; the channel's name for a path.
        ends_lps_mm: (2, 3), in the plane of the slice.
        ends_px: (2, 2), the same as column and row of the slice.
    """

    name: str
    ends_lps_mm: Array
    ends_px: Array

    def __post_init__(self) -> None:
        for name in ("ends_lps_mm", "ends_px"):
            array = np.array(getattr(self, name), dtype=np.float64)
            array.setflags(write=False)
            object.__setattr__(self, name, array)


@dataclass(frozen=True, slots=True, kw_only=True)
class ReferenceSlice:
    """The reference slice of a vertebra with its lines (paper, 2.1 and figure 1).

    Attributes:
        slice_index: number of the slice, from 0.
        apart_mm: distance of each outer line from the middle one.
        lines: middle, left and right (of the patient).
        paths: the ideal path through each pedicle, from entry to target, laid onto the slice.
    """

    slice_index: int
    apart_mm: float
    lines: tuple[SliceLine, ...]
    paths: tuple[SliceLine, ...]


def propose_slice(volume: Volume, measures: Sequence[PedicleMeasure]) -> int:
    """Return the index of the slice nearest to the isthmuses of all these pedicles.

    Raises:
        PlanError: NO_PEDICLE_MEASURED.
    """
    if not measures:
        raise PlanError(
            "NO_PEDICLE_MEASURED",
            "0 pedicles are measured, a slice is proposed from 1 or 2",
            "Click into a pedicle first, or choose the slice by hand.",
        )
    depth = [float(volume.index_from_lps(measure.isthmus_lps_mm)[2]) for measure in measures]
    return int(np.clip(round(float(np.mean(depth))), 0, volume.shape_ijk[2] - 1))


def propose_middle(measures: Sequence[PedicleMeasure]) -> Array:
    """Return the midpoint (3,) of the two isthmuses; the user moves it if the processes lie elsewhere.

    Raises:
        PlanError: MIDDLE_UNKNOWN.
    """
    by_side = {measure.side: measure.isthmus_lps_mm for measure in measures}
    if len(by_side) < 2:
        raise PlanError(
            "MIDDLE_UNKNOWN",
            f"{len(by_side)} pedicle is measured, the middle lies between 2",
            "Measure the other pedicle too, or give the middle by hand.",
            {"pedicles": len(by_side)},
        )
    return np.asarray(0.5 * (by_side["left"] + by_side["right"]))


def draw_reference(
    volume: Volume,
    *,
    slice_index: int,
    middle_lps_mm: npt.ArrayLike,
    apart_mm: float,
    channels: Sequence[Channel] = (),
) -> ReferenceSlice:
    """Return the three vertical registration lines and the paths of the channels.

    Raises:
        PlanError: SLICE_OUTSIDE_CT, LINES_INVALID, MIDDLE_OUTSIDE_CT.
    """
    slices = volume.shape_ijk[2]
    if not 0 <= slice_index < slices:
        raise PlanError(
            "SLICE_OUTSIDE_CT",
            f"slice {slice_index} was requested, the CT has {slices} (0 to {slices - 1})",
            "Choose a slice of this CT.",
            {"slice_index": slice_index, "slices": slices, "last": slices - 1},
        )
    middle = np.asarray(middle_lps_mm, dtype=np.float64).reshape(3)
    if not (np.isfinite(middle).all() and MIN_APART_MM <= apart_mm <= 100.0):
        raise PlanError(
            "LINES_INVALID",
            f"the outer lines stand {apart_mm} mm from the middle, allowed are {MIN_APART_MM:.0f} to 100 mm",
            "Give the middle in LPS mm and the measured distance of the lines.",
            {"apart_mm": apart_mm, "min_mm": MIN_APART_MM},
        )
    plane = _Plane(volume, slice_index)
    down = plane.along_rows
    across = np.cross(down, plane.normal)
    # The left line lies on the patient's left, whatever way the slice is stored.
    across *= 1.0 if across[0] > 0.0 else -1.0
    start = plane.project(middle)
    if not volume.contains(plane.on_slice(start)):
        formatted = ", ".join(f"{value:.1f}" for value in middle)
        raise PlanError(
            "MIDDLE_OUTSIDE_CT",
            f"the middle line was set through ({formatted}) mm, not on slice {slice_index} of the CT",
            "Set it through a point of this slice, in LPS mm.",
            {"middle_lps_mm": middle.tolist(), "slice_index": slice_index, "middle": formatted},
        )
    lines = tuple(
        plane.line(
            name,
            start + shift * across - AHEAD_MM * down,
            start + shift * across + MAX_BEHIND_ENTRY_MM * down,
        )
        for name, shift in (("middle", 0.0), ("left", apart_mm), ("right", -apart_mm))
    )
    paths = tuple(
        plane.line(
            one.name, plane.project(one.entry_in_vertebra_mm), plane.project(one.target_in_vertebra_mm)
        )
        for one in channels
    )
    return ReferenceSlice(slice_index=slice_index, apart_mm=float(apart_mm), lines=lines, paths=paths)


class _Plane:
    """One slice as a plane in the patient."""

    def __init__(self, volume: Volume, slice_index: int) -> None:
        self._volume = volume
        affine = volume.lps_from_ijk
        self._origin = volume.lps_from_index(np.array([0.0, 0.0, float(slice_index)]))
        normal = np.cross(affine[:3, 0], affine[:3, 1])
        self.normal: Array = normal / np.linalg.norm(normal)
        rows = affine[:3, 1] / np.linalg.norm(affine[:3, 1])
        # Backwards in the patient: down in a slice as it is looked at.
        self.along_rows: Array = rows if rows[1] > 0.0 else -rows

    def project(self, point: Array) -> Array:
        return np.asarray(point - ((point - self._origin) @ self.normal) * self.normal)

    def on_slice(self, point: Array) -> Array:
        """Return the same point, snapped to the slice to remove rounding errors."""
        index = self._volume.index_from_lps(point)
        return self._volume.lps_from_index([index[0], index[1], round(float(index[2]))])

    def line(self, name: str, start: Array, end: Array) -> SliceLine:
        ends = np.stack([start, end])
        return SliceLine(name=name, ends_lps_mm=ends, ends_px=self._volume.index_from_lps(ends)[:, :2])
