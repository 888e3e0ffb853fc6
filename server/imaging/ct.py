"""Records of a CT: voxels, description, warnings, and excluded files."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from tracker.errors import Remark
from tracker.geometry import Array
from tracker.plan import Volume
from tracker.plan.slices import Slice

# Progress callback: number done, and total.
Progress: TypeAlias = Callable[[int, int], None]


# Called once with a slice from the middle of the CT, before the other slices are read.
FirstSlice: TypeAlias = Callable[[Slice], None]


def no_progress(_done: int, _of: int) -> None:
    """Ignore progress."""


def no_preview(_slice: Slice) -> None:
    """Ignore the preview slice."""


def slice_as_scanned(hu: npt.NDArray[np.int16], lps_from_ijk: Array, k: int) -> Slice:
    """Return an acquired slice, hu (rows, columns), before the volume is complete."""
    affine = np.column_stack([lps_from_ijk[:3, 0], lps_from_ijk[:3, 1], (lps_from_ijk @ [0, 0, k, 1])[:3]])
    return Slice(hu=hu.copy(), lps_from_px=affine)


@dataclass(frozen=True, slots=True, kw_only=True)
class SeriesDescription:
    """A series, without data that identify the patient.

    Attributes:
        series: Its identifier: the SeriesInstanceUID, or "nifti".
        kind: "dicom" or "nifti".
        modality: As in DICOM ("CT", "MR"); empty if unknown.
        words: Series description of the scanner; empty if it contains a part of the patient's name.
        number: Number of the series in its study; 0 if it has none.
        patient: 1 for the first patient found, 2 for the second.
        images: Number of slices.
        size_wh_px: Columns and rows of a slice; zeros if the slices differ.
        pixel_mm: Distance between columns and between rows; zeros if unknown.
        thickness_mm: Slice thickness stated by the scanner; 0 if unknown.
        kernel: Reconstruction kernel ("Br38f"); empty if unknown.
        compression: Name of its transfer syntax.
        problem: Why this series is not usable for planning; empty if no reason is known.
    """

    series: str
    kind: str
    modality: str
    words: str
    number: int
    patient: int
    images: int
    size_wh_px: tuple[int, int]
    pixel_mm: tuple[float, float]
    thickness_mm: float
    kernel: str
    compression: str
    problem: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class ExcludedFiles:
    """Number of excluded files or images, with the reason."""

    count: int
    reason: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Ct:
    """A completely read CT.

    Attributes:
        volume: Hounsfield units with their affine in LPS mm.
        series: description, without patient data.
        warnings: warnings for the planning.
        left_out: excluded files.
    """

    volume: Volume
    series: SeriesDescription
    warnings: tuple[Remark, ...]
    left_out: tuple[ExcludedFiles, ...]
