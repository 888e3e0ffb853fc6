"""Consistency checks of the slices of a series, and warnings for the planning."""

from collections import Counter

import numpy as np

from server.imaging.dicom.frame import Frame
from server.imaging.dicom.pixels import check_readable
from server.imaging.dicom.series import check_one_patient, in_words
from server.imaging.plausibility import OF_THIS_PATIENT, clipped_warning
from server.imaging.voxels import check_voxels
from tracker.errors import InvalidInput, Remark
from tracker.plan.stack import EXPORT_AGAIN, MAX_JITTER_MM, Stack

MAX_SIDE_PX = 8192
MIN_PIXEL_MM, MAX_PIXEL_MM = 0.02, 10.0
THICK_MM = 3.0
REPORTED_JITTER_MM = 0.02
IS_HU = {"", "HU", "HU_MOD", "US"}


def check_consistency(frames: list[Frame]) -> None:
    """Reject a series whose slices lack required attributes, or contradict each other.

    Raises:
        InvalidInput: CT_PATIENTS_MIXED, CT_GEOMETRY_MISSING, CT_SIZES_DIFFER, CT_PIXELS_INVALID,
            CT_SPACES_DIFFER, CT_RESCALE_MISSING, CT_NOT_HU, CT_COMPRESSION_UNKNOWN, CT_PIXELS_UNKNOWN or
            CT_TOO_LARGE.
    """
    check_one_patient(frames, what="the series")
    _check_geometry(frames)
    _check_values(frames)
    for shared in {id(frame.shared): frame.shared for frame in frames}.values():
        check_readable(shared)


def _check_geometry(frames: list[Frame]) -> None:
    for attribute, missing in (
        ("position (Image Position)", [not frame.position_lps_mm for frame in frames]),
        ("direction (Image Orientation)", [not frame.directions for frame in frames]),
        ("pixel size (Pixel Spacing)", [not frame.pixel_mm for frame in frames]),
    ):
        if any(missing):
            raise InvalidInput(
                "CT_GEOMETRY_MISSING",
                f"{sum(missing)} of {len(frames)} slices do not state their {attribute}",
                "Export the series again with its geometry; pictures of slices are not usable for planning.",
                {"slices": sum(missing), "of": len(frames), "attribute": attribute},
            )
    sizes = Counter(f"{frame.shared.size_wh_px[0]} x {frame.shared.size_wh_px[1]}" for frame in frames)
    if len(sizes) > 1:
        raise InvalidInput(
            "CT_SIZES_DIFFER",
            f"the slices have different sizes in pixels: {in_words(sizes)}",
            EXPORT_AGAIN,
            {"sizes": {str(size): count for size, count in sizes.items()}, "counted": in_words(sizes)},
        )
    columns, rows = frames[0].shared.size_wh_px
    spacings = np.array([frame.pixel_mm for frame in frames])
    minimum, maximum = float(spacings.min()), float(spacings.max())
    if not (
        np.isfinite(spacings).all()
        and np.isfinite([frame.position_lps_mm for frame in frames]).all()
        and min(columns, rows) >= 2
        and max(columns, rows) <= MAX_SIDE_PX
        and minimum >= MIN_PIXEL_MM
        and maximum <= MAX_PIXEL_MM
    ):
        raise InvalidInput(
            "CT_PIXELS_INVALID",
            f"the slices are declared as {columns} x {rows} pixels of {minimum:g} to {maximum:g} mm, "
            f"allowed: 2 to {MAX_SIDE_PX} pixels per side of {MIN_PIXEL_MM} to {MAX_PIXEL_MM:.0f} mm",
            EXPORT_AGAIN,
            {
                "columns": columns,
                "rows": rows,
                "min_mm": minimum,
                "max_mm": maximum,
                "max_side_px": MAX_SIDE_PX,
                "min_pixel_mm": MIN_PIXEL_MM,
                "max_pixel_mm": MAX_PIXEL_MM,
            },
        )
    check_voxels((len(frames), rows, columns))
    spaces = {frame.shared.frame_of_reference for frame in frames} - {""}
    if len(spaces) > 1:
        raise InvalidInput(
            "CT_SPACES_DIFFER",
            f"the slices have {len(spaces)} frames of reference, expected 1: the patient may have moved",
            EXPORT_AGAIN,
            {"spaces": len(spaces)},
        )


def _check_values(frames: list[Frame]) -> None:
    unscaled = sum(
        not (frame.slope and frame.intercept)
        or not np.isfinite([*frame.slope, *frame.intercept]).all()
        or frame.slope[0] == 0.0
        for frame in frames
    )
    if unscaled:
        has_table = any(frame.shared.has_table for frame in frames)
        table_hint = ", but a lookup table" if has_table else ""
        raise InvalidInput(
            "CT_RESCALE_MISSING",
            f"{unscaled} of {len(frames)} slices do not state their conversion to Hounsfield units "
            f"(Rescale Slope and Intercept){table_hint}",
            "Export the original CT series again.",
            {"slices": unscaled, "of": len(frames), "table_hint": table_hint},
        )
    kinds = Counter(frame.rescale_type for frame in frames if frame.rescale_type not in IS_HU)
    if kinds:
        raise InvalidInput(
            "CT_NOT_HU",
            f"the values of {sum(kinds.values())} of {len(frames)} slices are not Hounsfield units, but "
            f"{in_words(kinds)}",
            "Export the CT series in Hounsfield units (not iodine, density or effective atomic number).",
            {"slices": sum(kinds.values()), "of": len(frames), "counted": in_words(kinds)},
        )


def series_warnings(frames: list[Frame], stack: Stack, beyond: int) -> list[Remark]:
    """Return warnings about a usable series."""
    first = frames[0].shared
    warnings = _position_warnings(frames, stack)
    if any(frame.shared.is_lossy for frame in frames):
        warnings.append(
            Remark(
                code="CT_COMPRESSED_LOSSILY",
                message="the pixels were compressed lossily; thin walls of bone may be altered",
            )
        )
    if any(frame.rescale_type in {"US", "HU_MOD"} for frame in frames):
        warnings.append(
            Remark(
                code="CT_HU_NOT_DECLARED",
                message="the scanner does not declare its values as plain Hounsfield units; they are used as "
                "such",
            )
        )
    if beyond:
        warnings.append(clipped_warning(beyond))
    if not first.patient_identity.identifier and not first.patient_identity.name:
        warnings.append(
            Remark(
                code="CT_PATIENT_NOT_NAMED",
                message="the files do not identify the patient",
                remedy=OF_THIS_PATIENT,
            )
        )
    return warnings


def _position_warnings(frames: list[Frame], stack: Stack) -> list[Remark]:
    first = frames[0].shared
    warnings = []
    doubles = len(frames) - len(stack.slices)
    if doubles:
        warnings.append(
            Remark(
                code="CT_SLICES_DUPLICATE",
                message=f"{doubles} slices are duplicates with equal pixels, and are used once",
                context={"doubles": doubles},
            )
        )
    if stack.jitter_mm > REPORTED_JITTER_MM:
        warnings.append(
            Remark(
                code="CT_SPACING_VARIES",
                message=f"slice positions deviate by up to {stack.jitter_mm:.2f} mm from even spacing; up to "
                f"{MAX_JITTER_MM:.1f} mm are accepted",
                context={"jitter_mm": stack.jitter_mm, "max_mm": MAX_JITTER_MM},
            )
        )
    if stack.tilt_deg > 0.05:
        warnings.append(
            Remark(
                code="CT_GANTRY_TILTED",
                message=f"the gantry was tilted by {stack.tilt_deg:.1f} deg; the tilted slices are used "
                "unchanged",
                context={"tilt_deg": stack.tilt_deg},
            )
        )
    if abs(abs(first.tilt_deg) - stack.tilt_deg) > 1.0 and first.tilt_deg:
        warnings.append(
            Remark(
                code="CT_TILT_CONTRADICTS",
                message=f"the scanner states a gantry tilt of {first.tilt_deg:.1f} deg, but the slice "
                f"positions give {stack.tilt_deg:.1f} deg; the positions are used",
                context={"stated_deg": first.tilt_deg, "tilt_deg": stack.tilt_deg},
            )
        )
    if max(stack.spacing_mm, first.thickness_mm) > THICK_MM:
        warnings.append(
            Remark(
                code="CT_SLICES_THICK",
                message=f"the slices are {first.thickness_mm:.1f} mm thick and {stack.spacing_mm:.1f} mm "
                f"apart; above {THICK_MM:.0f} mm heights and tilts of a pedicle are uncertain",
                context={
                    "thickness_mm": first.thickness_mm,
                    "spacing_mm": stack.spacing_mm,
                    "max_mm": THICK_MM,
                },
            )
        )
    gap_mm = stack.spacing_mm - first.thickness_mm
    if first.thickness_mm > 0.0 and gap_mm > 0.05:
        warnings.append(
            Remark(
                code="CT_SLICES_APART",
                message=f"between two slices {gap_mm:.2f} mm were not scanned ({first.thickness_mm:.2f} mm "
                f"thick, {stack.spacing_mm:.2f} mm apart)",
                context={
                    "gap_mm": gap_mm,
                    "thickness_mm": first.thickness_mm,
                    "spacing_mm": stack.spacing_mm,
                },
            )
        )
    return warnings
