"""Records of a CT: voxels, description, warnings, and excluded files."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from tracker.geometry import Array
from tracker.plan import Volume
from tracker.plan.slices import Slice

# Progress callback: number done, and total.
Progress: TypeAlias = Callable[[int, int], None]


# Called once with a slice from the middle of the CT, before the others are read.
FirstSlice: TypeAlias = Callable[[Slice], None]


def no_progress(_done: int, _of: int) -> None:
    """Ignore progress."""


def no_preview(_slice: Slice) -> None:
    """Ignore the preview slice."""


def slice_as_scanned(hu: npt.NDArray[np.int16], lps_from_ijk: Array, k: int) -> Slice:
    """A slice as it was scanned, hu (rows, columns), before the volume is complete."""
    affine = np.column_stack([lps_from_ijk[:3, 0], lps_from_ijk[:3, 1], (lps_from_ijk @ [0, 0, k, 1])[:3]])
    return Slice(hu=hu.copy(), lps_from_px=affine)


@dataclass(frozen=True, slots=True, kw_only=True)
class SeriesDescription:
    """One series that was found, without anything that names the patient.

    Attributes:
        series: its identifier: the SeriesInstanceUID, or "nifti".
        kind: "dicom" or "nifti".
        modality: as in DICOM ("CT", "MR"); empty if it is not known.
        words: the scanner's description of the series; empty where it holds a part of the patient's name.
        number: the series' number in its study, 0 if it has none.
        patient: 1 for the first patient that was found, 2 for the second.
        images: how many slices there are.
        size_wh_px: columns and rows of a slice; zeros where the slices differ.
        pixel_mm: distance between columns and between rows; zeros if unknown.
        thickness_mm: as stated by the scanner, 0 if unknown.
        kernel: the filter with which it was computed ("Br38f"); empty if unknown.
        compression: the name of its transfer syntax.
        problem: why this series cannot be used for a plan; empty if no reason is known.
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
        warnings: warnings for the planning, each a sentence.
        left_out: excluded files.
    """

    volume: Volume
    series: SeriesDescription
    warnings: tuple[str, ...]
    left_out: tuple[ExcludedFiles, ...]
