"""Attributes of one slice: geometry and rescaling."""

from dataclasses import dataclass

from pydicom.dataset import Dataset
from pydicom.uid import ImplicitVRLittleEndian

from server.imaging.container import Entry
from server.imaging.dicom.header import BAD_DICOM, CT_CLASSES, UnusedFile, number, numbers, text, words

SECONDARY_CAPTURE = "1.2.840.10008.5.1.4.1.1.7"
MAX_FRAMES = 20_000


@dataclass(frozen=True, slots=True, kw_only=True)
class PatientIdentity:
    """Patient data of an image; only compared, never reported."""

    name: str
    identifier: str
    born: str


@dataclass(frozen=True, slots=True, kw_only=True)
class FileAttributes:
    """Attributes common to all slices of a file."""

    entry: Entry
    patient_identity: PatientIdentity
    series: str
    modality: str
    words: str
    number: int
    kernel: str
    frame_of_reference: str
    compression: str
    is_lossy: bool
    thickness_mm: float
    tilt_deg: float
    size_wh_px: tuple[int, int]
    bits: tuple[int, int, int]
    is_signed: bool
    photometric: str
    padding: tuple[int, int] | None
    frames: int
    has_table: bool


@dataclass(frozen=True, slots=True, kw_only=True)
class Frame:
    """One slice; missing attributes are empty tuples."""

    shared: FileAttributes
    index: int
    instance: int
    position_lps_mm: tuple[float, ...]
    directions: tuple[float, ...]
    pixel_mm: tuple[float, ...]
    slope: tuple[float, ...]
    intercept: tuple[float, ...]
    rescale_type: str


def frames_of(entry: Entry, header: Dataset) -> list[Frame] | UnusedFile:
    """Return the slices of one file, or why it has none."""
    reason = _no_slice(header)
    if reason:
        return UnusedFile(reason=reason)
    shared = _shared(entry, header)
    if shared.frames == 1 and "PerFrameFunctionalGroupsSequence" not in header:
        return [_frame(shared, 0, header, header)]
    if shared.frames > MAX_FRAMES:
        return UnusedFile(reason=f"files that declare more than {MAX_FRAMES} images")
    try:
        common = _only(header, "SharedFunctionalGroupsSequence")
        groups = list(header.get("PerFrameFunctionalGroupsSequence") or [])
    except BAD_DICOM:
        groups, common = [], None
    if len(groups) != shared.frames:
        # Frames without individual positions (a film, a turntable) are not slices.
        return UnusedFile(reason="multi-frame files without positions of their images")
    return [_grouped_frame(shared, index, group, common, header) for index, group in enumerate(groups)]


def _no_slice(header: Dataset) -> str:
    if "Rows" not in header or "Columns" not in header:
        return "DICOM files without an image"
    if int(number(header, "SamplesPerPixel", 1)) != 1:
        return "colour pictures (screens, reports)"
    kind = words(header, "ImageType")
    if any("LOCALIZER" in word.upper() or "SCOUT" in word.upper() for word in kind):
        return "localizers (scouts)"
    if text(header, "SOPClassUID").startswith(SECONDARY_CAPTURE):
        return "pictures of a screen (secondary captures)"
    return ""


def _shared(entry: Entry, header: Dataset) -> FileAttributes:
    bits_allocated = int(number(header, "BitsAllocated", 16))
    bits_stored = int(number(header, "BitsStored", bits_allocated))
    high_bit = int(number(header, "HighBit", bits_stored - 1))
    meta = getattr(header, "file_meta", None)
    compression = text(meta, "TransferSyntaxUID") if meta is not None else ""
    modality = text(header, "Modality").upper()
    if not modality and text(header, "SOPClassUID") in CT_CLASSES:
        modality = "CT"
    return FileAttributes(
        entry=entry,
        patient_identity=PatientIdentity(
            name=_plain(text(header, "PatientName").partition("=")[0]),
            identifier=_plain(text(header, "PatientID")),
            born=_plain(text(header, "PatientBirthDate")),
        ),
        series=text(header, "SeriesInstanceUID"),
        modality=modality,
        words=text(header, "SeriesDescription"),
        number=int(number(header, "SeriesNumber", 0)),
        kernel=(words(header, "ConvolutionKernel") or ("",))[0],
        frame_of_reference=text(header, "FrameOfReferenceUID"),
        compression=compression or str(ImplicitVRLittleEndian),
        is_lossy=text(header, "LossyImageCompression") == "01",
        thickness_mm=number(header, "SliceThickness", 0.0),
        tilt_deg=number(header, "GantryDetectorTilt", 0.0),
        size_wh_px=(int(number(header, "Columns", 0)), int(number(header, "Rows", 0))),
        bits=(bits_allocated, bits_stored, high_bit),
        is_signed=int(number(header, "PixelRepresentation", 0)) == 1,
        photometric=text(header, "PhotometricInterpretation").upper(),
        padding=_padding(header),
        frames=max(1, int(number(header, "NumberOfFrames", 1))),
        has_table="ModalityLUTSequence" in header,
    )


def _plain(value: str) -> str:
    """Normalise a name, so that different spellings of it compare equal."""
    return " ".join(value.replace("^", " ").split()).casefold()


def _padding(header: Dataset) -> tuple[int, int] | None:
    """Return the range of stored values that mark padding pixels."""
    first = numbers(header, "PixelPaddingValue", 1)
    if not first:
        return None
    second = numbers(header, "PixelPaddingRangeLimit", 1) or first
    ends = [int(first[0]), int(second[0])]
    if int(number(header, "PixelRepresentation", 0)) == 0:
        # A negative value denotes the same bit pattern.
        ends = [end % 2 ** int(number(header, "BitsAllocated", 16)) for end in ends]
    return min(ends), max(ends)


def _frame(shared: FileAttributes, index: int, place: Dataset, values: Dataset) -> Frame:
    return Frame(
        shared=shared,
        index=index,
        instance=int(number(place, "InstanceNumber", index)),
        position_lps_mm=numbers(place, "ImagePositionPatient", 3),
        directions=numbers(place, "ImageOrientationPatient", 6),
        pixel_mm=numbers(place, "PixelSpacing", 2),
        slope=numbers(values, "RescaleSlope", 1),
        intercept=numbers(values, "RescaleIntercept", 1),
        rescale_type=text(values, "RescaleType").upper(),
    )


def _grouped_frame(
    shared: FileAttributes, index: int, group: Dataset, common: Dataset | None, header: Dataset
) -> Frame:
    """Return a frame whose geometry is in its own or in the shared functional groups."""

    def found(keyword: str) -> Dataset:
        for holder in (group, common):
            inner = _only(holder, keyword) if holder is not None else None
            if inner is not None:
                return inner
        return header

    values = found("PixelValueTransformationSequence")
    return Frame(
        shared=shared,
        index=index,
        instance=index,
        position_lps_mm=numbers(found("PlanePositionSequence"), "ImagePositionPatient", 3),
        directions=numbers(found("PlaneOrientationSequence"), "ImageOrientationPatient", 6),
        pixel_mm=numbers(found("PixelMeasuresSequence"), "PixelSpacing", 2),
        slope=numbers(values, "RescaleSlope", 1),
        intercept=numbers(values, "RescaleIntercept", 1),
        rescale_type=text(values, "RescaleType").upper(),
    )


def _only(holder: Dataset, keyword: str) -> Dataset | None:
    """Return the first item of a sequence."""
    try:
        items = holder.get(keyword)
        return items[0] if items else None
    except BAD_DICOM:
        return None
