"""Ordering of CT slices and their common affine, or an error if there is none.

Uneven, missing or contradictory slices are rejected and neither resampled nor interpolated, because a pedicle
would otherwise be measured where nothing was scanned. Deviations up to a tenth of the spacing, at most 0.2
mm, are accepted and reported.
"""

from dataclasses import dataclass

import numpy as np

from tracker.errors import InvalidInput
from tracker.geometry import Array

# Two slices nearer than this lie at the same place.
SAME_PLACE_MM = 0.01
# Maximum distance of a voxel from its position by the affine: in mm, and as a ratio of the spacing.
MAX_JITTER_MM = 0.2
MAX_JITTER_RATIO = 0.1
MAX_TILT_DEG = 45.0
EXPORT_AGAIN = "Export the whole series again as original axial slices, and give that folder alone."


@dataclass(frozen=True, slots=True, kw_only=True)
class Stack:
    """Geometry of the ordered slices of a series.

    Attributes:
        lps_from_ijk: (4, 4), takes column, row and slice to LPS in mm; slices run along rows x columns.
        slices: for each slice of the volume the indexes of the given ones; more than one are duplicates.
        spacing_mm: between neighbouring slices, along their normal.
        tilt_deg: angle between the normal and the direction from slice to slice; above 0 for a tilted gantry.
        jitter_mm: maximum distance of a slice corner from its position by the affine.
    """

    lps_from_ijk: Array
    slices: tuple[tuple[int, ...], ...]
    spacing_mm: float
    tilt_deg: float
    jitter_mm: float


def stack_slices(
    *, positions_lps_mm: Array, directions: Array, pixels_mm: Array, size_wh_px: tuple[int, int]
) -> Stack:
    """Return one affine for all slices of a series, given in any order.

    Args:
        positions_lps_mm: (n, 3), the centre of the first pixel of each slice.
        directions: (n, 2, 3), unit directions in which columns (first) and rows (second) are counted.
        pixels_mm: (n, 2), distance between neighbouring columns (first) and rows (second).
        size_wh_px: columns and rows of each slice.

    Raises:
        InvalidInput: CT_DIRECTIONS_INVALID, CT_DIRECTIONS_DIFFER, CT_PIXELS_DIFFER, CT_TOO_FEW_SLICES,
            CT_SLICES_MISSING, CT_SPACING_UNEVEN, CT_SLICES_SHIFTED or CT_TILT_TOO_LARGE.
    """
    positions = np.asarray(positions_lps_mm, dtype=np.float64)
    axes = _checked_axes(np.asarray(directions, dtype=np.float64), np.asarray(pixels_mm, dtype=np.float64))
    extent = np.array(size_wh_px, dtype=np.float64) - 1.0
    _check_same_geometry(axes, extent)
    normal = np.cross(axes[0, 0], axes[0, 1])
    normal /= np.linalg.norm(normal)
    slices = _grouped(positions, positions @ normal)
    if len(slices) < 2:
        raise InvalidInput(
            "CT_TOO_FEW_SLICES",
            f"the series has slices at {len(slices)} place, needed at least 2",
            EXPORT_AGAIN,
            {"places": len(slices), "slices": int(positions.shape[0])},
        )
    starts = positions[[members[0] for members in slices]]
    gaps = np.diff(starts @ normal)
    _check_gaps(gaps)
    step = (starts[-1] - starts[0]) / (len(slices) - 1)
    affine = np.eye(4)
    affine[:3, :3] = np.column_stack([axes[0, 0], axes[0, 1], step])
    affine[:3, 3] = starts[0]
    jitter = _jitter_mm(affine, starts, axes[[members[0] for members in slices]], extent)
    spacing = float(step @ normal)
    _check_jitter(jitter, gaps, spacing)
    tilt = float(np.degrees(np.arctan2(np.linalg.norm(step - spacing * normal), spacing)))
    if tilt > MAX_TILT_DEG:
        raise InvalidInput(
            "CT_TILT_TOO_LARGE",
            f"the slices are tilted by {tilt:.1f} deg against the stacking direction, allowed "
            f"{MAX_TILT_DEG:.0f} deg",
            EXPORT_AGAIN,
            {"tilt_deg": tilt, "max_tilt_deg": MAX_TILT_DEG},
        )
    affine.setflags(write=False)
    return Stack(lps_from_ijk=affine, slices=slices, spacing_mm=spacing, tilt_deg=tilt, jitter_mm=jitter)


def _checked_axes(directions: Array, pixels_mm: Array) -> Array:
    """Return the steps (n, 2, 3) in mm between columns and between rows of each slice."""
    finite = np.isfinite(directions).all() and np.isfinite(pixels_mm).all()
    lengths = np.linalg.norm(directions, axis=2)
    across = np.einsum("ni,ni->n", directions[:, 0], directions[:, 1])
    bad = ~((np.abs(lengths - 1.0) < 1e-3).all(axis=1) & (np.abs(across) < 1e-3))
    if not finite or bad.any():
        raise InvalidInput(
            "CT_DIRECTIONS_INVALID",
            f"{int(bad.sum())} of {len(bad)} slices have directions that are not at right angles, or not of "
            "length 1",
            EXPORT_AGAIN,
            {"slices": int(bad.sum()), "of": len(bad)},
        )
    return np.asarray(directions / lengths[:, :, None] * pixels_mm[:, :, None])


def _check_same_geometry(axes: Array, extent: Array) -> None:
    """Reject slices whose orientation or pixel size differs from the others."""
    usual = np.median(axes, axis=0)
    lengths = np.linalg.norm(axes, axis=2)
    usual_lengths = np.median(lengths, axis=0)
    stretched = (np.abs(lengths - usual_lengths) * extent).max(axis=1) > MAX_JITTER_MM
    if stretched.any():
        low, high = float(lengths.min()), float(lengths.max())
        raise InvalidInput(
            "CT_PIXELS_DIFFER",
            f"{int(stretched.sum())} of {len(axes)} slices have pixels of another size: they go from "
            f"{low:.4f} to {high:.4f} mm",
            EXPORT_AGAIN,
            {"slices": int(stretched.sum()), "of": len(axes), "min_mm": low, "max_mm": high},
        )
    turned = (np.linalg.norm(axes - usual, axis=2) * extent).max(axis=1) > MAX_JITTER_MM
    if turned.any():
        normals = np.cross(axes[:, 0], axes[:, 1])
        normals /= np.linalg.norm(normals, axis=1)[:, None]
        worst = float(np.degrees(np.arccos(np.clip((normals @ normals[0]).min(), -1.0, 1.0))))
        raise InvalidInput(
            "CT_DIRECTIONS_DIFFER",
            f"{int(turned.sum())} of {len(axes)} slices lie in another direction (planes up to {worst:.2f} "
            "deg apart)",
            EXPORT_AGAIN,
            {"slices": int(turned.sum()), "of": len(axes), "worst_deg": worst},
        )


def _grouped(positions: Array, heights: Array) -> tuple[tuple[int, ...], ...]:
    """Return the slices in ascending position; slices at the same position form one group."""
    groups: list[list[int]] = []
    for index in np.argsort(heights, kind="stable").tolist():
        if groups and heights[index] - heights[groups[-1][0]] <= SAME_PLACE_MM:
            shift = float(np.linalg.norm(positions[index] - positions[groups[-1][0]]))
            if shift > MAX_JITTER_MM:
                raise InvalidInput(
                    "CT_SLICES_SHIFTED",
                    f"two slices lie in one plane, {shift:.2f} mm apart, allowed {MAX_JITTER_MM:.2f} mm",
                    EXPORT_AGAIN,
                    {"shift_mm": shift, "max_shift_mm": MAX_JITTER_MM},
                )
            groups[-1].append(index)
        else:
            groups.append([index])
    return tuple(tuple(group) for group in groups)


def _check_gaps(gaps: Array) -> None:
    """Reject a series with uneven slice spacing."""
    usual = float(np.sort(gaps)[(len(gaps) - 1) // 2])
    steps = gaps / usual
    if np.abs(steps - 1.0).max() <= 2.0 * MAX_JITTER_RATIO:
        return
    first = int(np.argmax(np.abs(steps - 1.0) > 2.0 * MAX_JITTER_RATIO))
    gap_mm, slices = float(gaps[first]), len(gaps) + 1
    missing = int((np.rint(steps) - 1.0).sum())
    if missing > 0 and np.abs(steps - np.rint(steps)).max() <= 2.0 * MAX_JITTER_RATIO:
        raise InvalidInput(
            "CT_SLICES_MISSING",
            f"{missing} of {slices + missing} slices are missing: after slice {first + 1} of {slices}, in "
            f"the order of their positions, the next is {gap_mm:.3f} mm away, the others lie {usual:.3f} mm "
            "apart",
            EXPORT_AGAIN,
            {
                "missing": missing,
                "needed": slices + missing,
                "after": first + 1,
                "slices": slices,
                "gap_mm": gap_mm,
                "spacing_mm": usual,
            },
        )
    raise InvalidInput(
        "CT_SPACING_UNEVEN",
        f"the slices lie between {gaps.min():.3f} and {gaps.max():.3f} mm apart, mostly {usual:.3f} mm: "
        f"after slice {first + 1} of {slices}, in the order of their positions, the next is {gap_mm:.3f} mm "
        "away",
        EXPORT_AGAIN,
        {
            "min_mm": float(gaps.min()),
            "max_mm": float(gaps.max()),
            "spacing_mm": usual,
            "after": first + 1,
            "slices": slices,
            "gap_mm": gap_mm,
        },
    )


def _jitter_mm(affine: Array, starts: Array, axes: Array, extent: Array) -> float:
    """Return the maximum distance of any slice corner from its place by the affine."""
    count = len(starts)
    worst = 0.0
    for column in (0.0, extent[0]):
        for row in (0.0, extent[1]):
            corners = starts + axes[:, 0] * column + axes[:, 1] * row
            index = np.column_stack([np.full(count, column), np.full(count, row), np.arange(count)])
            worst = max(
                worst,
                float(np.linalg.norm(corners - index @ affine[:3, :3].T - affine[:3, 3], axis=1).max()),
            )
    return worst


def _check_jitter(jitter: float, gaps: Array, spacing: float) -> None:
    """Reject slices too far from their place by the affine."""
    allowed = min(MAX_JITTER_MM, MAX_JITTER_RATIO * spacing)
    if jitter <= allowed:
        return
    uneven = float(np.abs(gaps - spacing).max()) > 0.1 * allowed
    how = (
        f"the slices lie between {gaps.min():.3f} and {gaps.max():.3f} mm apart"
        if uneven
        else "the slices are shifted against each other within their planes"
    )
    raise InvalidInput(
        "CT_SPACING_UNEVEN" if uneven else "CT_SLICES_SHIFTED",
        f"{how}: one lies {jitter:.3f} mm from its regular position, allowed {allowed:.3f} mm",
        EXPORT_AGAIN,
        {
            "off_mm": jitter,
            "allowed_mm": allowed,
            "min_mm": float(gaps.min()),
            "max_mm": float(gaps.max()),
            "gap_problem": how,
        },
    )
