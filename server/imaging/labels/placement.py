"""Labels in the grid of the CT: resampling by nearest neighbour, and checks against the CT."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
import scipy

from server.imaging.labels.label_image import LabelImage, bounding_box
from tracker.errors import InvalidInput, Remark
from tracker.geometry import Array
from tracker.plan import Volume
from tracker.plan.labels import (
    CLASS_OF_LEVEL,
    Labels,
    LabelVolume,
    VertebraLabel,
    check_levels,
    measure_labels,
)

# Volume of one vertebra: a cervical one of a small adult has about 6 ml, a large lumbar one 100 ml.
MIN_ML, MAX_ML = 5.0, 200.0
# Share of the labels that must lie in the CT, which may show three vertebrae of a spine that was segmented as
# a whole, and share of a label that others may overlap.
MIN_INSIDE_RATIO, MAX_OVERLAP_RATIO = 0.1, 0.01
# Bone is denser than its surroundings: mean HU inside of the labels less that of a shell around them. On a
# correct segmentation it is some hundred HU; labels of another patient or frame have about none. Labels that
# are beside the bone, or between two vertebrae, have some; they gain when they are shifted back.
MIN_CONTRAST_HU = 60.0
MAX_GAIN_HU = 25.0
SHELL_MM = 4.0
SHIFTS_MM = (4.0, 8.0, 16.0)
SAME_FRAME = (
    "Segment this CT again, or give the segmentation of this CT; it must have the same patient coordinates."
)


@dataclass(frozen=True, slots=True, kw_only=True)
class PlacedLabels:
    """Labels of vertebrae that were checked against the CT.

    Attributes:
        volume: the part of the CT's grid that has labels.
        vertebrae: measured, from the head down.
        contrast_hu: mean HU inside of the labels less that around them.
        warnings: for the planning.
        source: "nifti" or "dicom".
        source_voxel_mm: size of the voxels of the file, before resampling.
    """

    volume: LabelVolume
    vertebrae: tuple[VertebraLabel, ...]
    contrast_hu: float
    warnings: tuple[Remark, ...]
    source: str
    source_voxel_mm: tuple[float, float, float]


def labels_on_ct(images: Iterable[LabelImage], ct: Volume) -> PlacedLabels:
    """Resample images of labels to the grid of the CT, and check them.

    Args:
        images: as `read_label_images` yields them; each is released before the next one is read.
        ct: the CT, in the order of the patient's axes.

    Raises:
        InvalidInput: LABELS_EMPTY, LABELS_OUTSIDE_CT, LABELS_OVERLAP, LABEL_VOLUME_ODD, LABELS_NOT_ON_BONE.
        PlanError: LEVEL_DOUBTFUL.
    """
    whole = np.zeros(ct.hu.shape, dtype=np.uint8)
    stated_ml = inside_ml = overlap_ml = 0.0
    others, unnamed, source, source_voxel = 0, False, "", np.zeros(3)
    for image in images:
        others += image.others
        unnamed |= not image.is_named
        source, source_voxel = image.source, np.maximum(source_voxel, image.spacing_mm)
        stated_ml += float(np.count_nonzero(image.labels)) * _voxel_ml(image.lps_from_ijk)
        added, overlapping = _add(whole, image, ct)
        inside_ml += added * _voxel_ml(ct.lps_from_ijk)
        overlap_ml += overlapping * _voxel_ml(ct.lps_from_ijk)
    _check_extent(stated_ml, inside_ml, overlap_ml)
    coarsest = float(max(source_voxel.max(), ct.spacing_mm.max()))
    volume = LabelVolume(labels=whole, lps_from_ijk=ct.lps_from_ijk, voxel_mm=coarsest)
    measured = measure_labels(volume, shape_ijk=ct.shape_ijk)
    vertebrae = tuple(one for one in measured if not (one.is_cut and one.volume_ml < MIN_ML))
    for one in vertebrae:
        _check_volume(one)
    for one in measured:
        if one not in vertebrae:
            whole[whole == CLASS_OF_LEVEL[one.level]] = 0
    if not vertebrae:
        raise _empty()
    check_levels(vertebrae)
    cropped = _cropped(volume)
    contrast_hu = _checked_contrast_hu(cropped, ct)
    warnings = _warnings(
        measured, vertebrae, others=others, unnamed=unnamed, outside_ratio=1.0 - inside_ml / stated_ml
    )
    return PlacedLabels(
        volume=cropped,
        vertebrae=vertebrae,
        contrast_hu=contrast_hu,
        warnings=tuple(warnings),
        source=source,
        source_voxel_mm=(float(source_voxel[0]), float(source_voxel[1]), float(source_voxel[2])),
    )


def _voxel_ml(affine: Array) -> float:
    return float(abs(np.linalg.det(affine[:3, :3]))) / 1000.0


def _add(whole: Labels, image: LabelImage, ct: Volume) -> tuple[int, int]:
    """Write the nearest label of each voxel of the CT; return how many were labelled, and how many before."""
    box = bounding_box(image.labels)
    if box is None:
        return 0, 0
    part = image.labels[box]
    start = np.array([one.start for one in box[::-1]])
    # Indexes in the part from indexes in the CT.
    index_from_ct = np.linalg.inv(image.lps_from_ijk) @ ct.lps_from_ijk
    index_from_ct[:3, 3] -= start
    low, high = _reach(np.linalg.inv(index_from_ct).astype(np.float64), part.shape, ct)
    added = overlapping = 0
    j, i = np.meshgrid(np.arange(low[1], high[1]), np.arange(low[0], high[0]), indexing="ij")
    in_slice = (
        i[..., None] * index_from_ct[:3, 0] + j[..., None] * index_from_ct[:3, 1] + index_from_ct[:3, 3]
    )
    size = np.array(part.shape[::-1])
    for k in range(int(low[2]), int(high[2])):
        index = np.floor(in_slice + k * index_from_ct[:3, 2] + 0.5).astype(np.int32)
        is_inside = ((index >= 0) & (index < size)).all(axis=-1)
        at = index[is_inside]
        found = np.zeros(is_inside.shape, dtype=np.uint8)
        found[is_inside] = part[at[:, 2], at[:, 1], at[:, 0]]
        if not found.any():
            continue
        target = whole[k, low[1] : high[1], low[0] : high[0]]
        is_free = (found > 0) & (target == 0)
        overlapping += int(np.count_nonzero((found > 0) & (target > 0) & (target != found)))
        added += int(np.count_nonzero(is_free))
        target[is_free] = found[is_free]
    return added, overlapping


def _reach(ct_from_index: Array, shape: tuple[int, ...], ct: Volume) -> tuple[Array, Array]:
    """Return the range of indexes of the CT that a part of labels reaches."""
    ends = [(-0.5, size - 0.5) for size in shape[::-1]]
    corners = np.array(np.meshgrid(*ends, [1.0])).reshape(4, -1)
    reached = (ct_from_index @ corners)[:3]
    size = np.array(ct.shape_ijk)
    low = np.clip(np.floor(reached.min(axis=1)), 0, size).astype(int)
    high = np.clip(np.ceil(reached.max(axis=1)) + 1, low, size).astype(int)
    return low, high


def _cropped(volume: LabelVolume) -> LabelVolume:
    box = bounding_box(volume.labels)
    assert box is not None  # noqa: S101  for the type checker: there is a vertebra
    affine = volume.lps_from_ijk.copy()
    affine[:3, 3] = volume.lps_from_index([one.start for one in box[::-1]])
    return LabelVolume(labels=volume.labels[box].copy(), lps_from_ijk=affine, voxel_mm=volume.voxel_mm)


def _checked_contrast_hu(labels: LabelVolume, ct: Volume) -> float:
    """Return the mean HU in the labels less that in a shell around them; reject labels beside the bone."""
    start = np.rint(ct.index_from_lps(labels.lps_from_ijk[:3, 3])).astype(int)[::-1]
    spacing = ct.spacing_mm[::-1]
    margin = np.ceil(max(SHIFTS_MM) / spacing).astype(int)
    low = np.maximum(start - margin, 0)
    high = np.minimum(start + labels.labels.shape + margin, ct.hu.shape)
    inside = np.zeros(high - low, dtype=bool)
    at = [slice(int(s - b), int(s - b + n)) for s, b, n in zip(start, low, labels.labels.shape, strict=True)]
    inside[tuple(at)] = labels.labels > 0
    near = scipy.ndimage.maximum_filter(inside, size=tuple(2 * np.ceil(SHELL_MM / spacing).astype(int) + 1))
    hu = ct.hu[tuple(slice(int(a), int(b)) for a, b in zip(low, high, strict=True))]
    shell = near & ~inside
    contrast_hu = float(hu[inside].mean()) - (float(hu[shell].mean()) if shell.any() else 0.0)
    if contrast_hu < MIN_CONTRAST_HU:
        raise InvalidInput(
            "LABELS_NOT_ON_BONE",
            f"the labels do not lie on bone: inside of them the CT has {contrast_hu:.0f} HU more than around "
            f"them, expected {MIN_CONTRAST_HU:.0f} or more",
            SAME_FRAME,
            {"contrast_hu": contrast_hu, "min_contrast_hu": MIN_CONTRAST_HU},
        )
    gain_hu, shift_mm = max(
        (_gain_hu(inside, hu, shift), by_mm)
        for by_mm in SHIFTS_MM
        for shift in _shifts(np.ceil(by_mm / spacing).astype(int))
    )
    if gain_hu > MAX_GAIN_HU:
        raise InvalidInput(
            "LABELS_NOT_ON_BONE",
            f"the labels lie beside the bone: shifted by {shift_mm:g} mm, the CT inside of them is "
            f"{gain_hu:.0f} HU denser, allowed {MAX_GAIN_HU:.0f}",
            SAME_FRAME,
            {"shift_mm": shift_mm, "gain_hu": gain_hu, "max_gain_hu": MAX_GAIN_HU},
        )
    return contrast_hu


def _shifts(voxels: npt.NDArray[np.int64]) -> list[tuple[int, ...]]:
    """Return shifts by so many voxels to both sides along each axis."""
    axes = np.diag(voxels)
    return [tuple(int(one) for one in sign * axis) for axis in axes for sign in (-1, 1)]


def _gain_hu(inside: npt.NDArray[np.bool_], hu: npt.NDArray[np.int16], shift: tuple[int, ...]) -> float:
    """Return how much denser the CT is in a shifted mask, of the voxels that stay in the CT."""
    to = tuple(slice(max(by, 0), size + min(by, 0)) for by, size in zip(shift, hu.shape, strict=True))
    of = tuple(slice(max(-by, 0), size + min(-by, 0)) for by, size in zip(shift, hu.shape, strict=True))
    mask = inside[of]
    return float(hu[to][mask].mean() - hu[of][mask].mean()) if mask.any() else 0.0


def _check_extent(stated_ml: float, inside_ml: float, overlap_ml: float) -> None:
    if stated_ml == 0.0:
        raise _empty()
    inside_ratio = (inside_ml + overlap_ml) / stated_ml
    if inside_ratio < MIN_INSIDE_RATIO:
        raise InvalidInput(
            "LABELS_OUTSIDE_CT",
            f"{inside_ratio:.0%} of the labels ({stated_ml:.0f} ml) lie in the CT, expected "
            f"{MIN_INSIDE_RATIO:.0%} or more",
            SAME_FRAME,
            {"inside": inside_ratio, "min_inside": MIN_INSIDE_RATIO, "stated_ml": stated_ml},
        )
    if overlap_ml > MAX_OVERLAP_RATIO * inside_ml:
        raise InvalidInput(
            "LABELS_OVERLAP",
            f"{overlap_ml:.1f} ml belong to two vertebrae, allowed {MAX_OVERLAP_RATIO * inside_ml:.1f} ml",
            "Give one segmentation, in which each voxel has one label.",
            {"overlap_ml": overlap_ml, "allowed_ml": MAX_OVERLAP_RATIO * inside_ml},
        )


def _empty() -> InvalidInput:
    return InvalidInput(
        "LABELS_EMPTY",
        "the segmentation has no vertebra in the CT",
        "Give a segmentation of vertebrae C1 to S1; state their names if the file has none.",
    )


def _check_volume(one: VertebraLabel) -> None:
    if MIN_ML <= one.volume_ml <= MAX_ML:
        return
    raise InvalidInput(
        "LABEL_VOLUME_ODD",
        f"the label {one.level} has {one.volume_ml:.1f} ml, plausible for a vertebra are {MIN_ML:g} to "
        f"{MAX_ML:g} ml",
        "Check the segmentation and the names of its labels.",
        {"level": one.level, "volume_ml": one.volume_ml, "min_ml": MIN_ML, "max_ml": MAX_ML},
    )


def _warnings(
    measured: tuple[VertebraLabel, ...],
    vertebrae: tuple[VertebraLabel, ...],
    *,
    others: int,
    unnamed: bool,
    outside_ratio: float,
) -> list[Remark]:
    warnings = []
    if unnamed:
        warnings.append(
            Remark(
                code="LABELS_UNNAMED",
                message="the file does not name its labels; their numbers were read as those of "
                "TotalSegmentator v2",
                remedy="Compare the levels with the CT.",
            )
        )
    cut = ", ".join(one.level for one in vertebrae if one.is_cut)
    if cut:
        warnings.append(
            Remark(code="LABELS_CUT", message=f"cut by the border of the CT: {cut}", context={"levels": cut})
        )
    dropped = ", ".join(one.level for one in measured if one not in vertebrae)
    if dropped:
        warnings.append(
            Remark(
                code="LABELS_TOO_SMALL",
                message=f"not used, because less than {MIN_ML:g} ml lie in the CT: {dropped}",
                context={"min_ml": MIN_ML, "levels": dropped},
            )
        )
    if outside_ratio > MAX_OVERLAP_RATIO:
        warnings.append(
            Remark(
                code="LABELS_PARTLY_OUTSIDE_CT",
                message=f"{outside_ratio:.0%} of the labels lie outside of the CT",
                context={"outside_ratio": outside_ratio},
            )
        )
    if others:
        warnings.append(
            Remark(
                code="LABELS_OF_OTHER_PARTS",
                message=f"{others} labels are no vertebra and are not used",
                context={"others": others},
            )
        )
    return warnings
