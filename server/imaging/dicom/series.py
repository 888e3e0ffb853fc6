"""Grouping of slices into series, check for a single patient, and choice of the CT series."""

import re
from collections import Counter

from pydicom.dataset import Dataset
from pydicom.uid import UID

from server.imaging.container import Container, Entry
from server.imaging.ct import Progress, SeriesDescription
from server.imaging.dicom.frame import Frame, PatientIdentity, frames_of
from server.imaging.dicom.header import BAD_DICOM, BROKEN, UnusedFile, read_header, without_warnings
from tracker.errors import InvalidInput

# A series with fewer slices counts as a scout or a sample if there is a series with more.
FEW_SLICES = 4
GIVE_ONE = "Give a folder with the images of one patient only."


def group_frames_by_series(container: Container, progress: Progress) -> dict[str, list[Frame]]:
    """Return all slices by series; excluded files are recorded in the container.

    Raises:
        InvalidInput: CT_FILE_DAMAGED, CT_NO_DICOM.
    """
    series: dict[str, list[Frame]] = {}
    for done, entry in enumerate(container.entries, start=1):
        with without_warnings():
            header = read_header(entry)
            frames = header if isinstance(header, UnusedFile) else _frames(entry, header)
        if isinstance(frames, UnusedFile):
            container.reasons[frames.reason] += 1
        else:
            series.setdefault(frames[0].shared.series, []).extend(frames)
        progress(done, len(container.entries))
    damaged = container.reasons[BROKEN]
    if damaged:
        raise InvalidInput(
            "CT_FILE_DAMAGED",
            f"{damaged} of {len(container.entries)} files are truncated or damaged DICOM files",
            "Copy or export the series again; a damaged slice cannot be repaired.",
            {"damaged": damaged, "files": len(container.entries)},
        )
    if not series:
        files, excluded = len(container.entries) + _beforehand(container), container.excluded_text
        raise InvalidInput(
            "CT_NO_DICOM",
            f"no DICOM slice in the upload (files: {files}): {excluded}",
            "Give a folder or zip of the CT's DICOM slices, or a NIfTI file.",
            {
                **{one.reason.replace(" ", "_"): one.count for one in container.left_out},
                "files": files,
                "excluded_list": excluded,
            },
        )
    return series


def _frames(entry: Entry, header: Dataset) -> list[Frame] | UnusedFile:
    try:
        return frames_of(entry, header)
    except BAD_DICOM:
        return UnusedFile(reason=BROKEN)


def _beforehand(container: Container) -> int:
    """Return the number of files excluded before any was opened."""
    return max(0, sum(container.reasons.values()) - len(container.entries))


def check_one_patient(frames: list[Frame], *, what: str) -> None:
    """Reject images of more than one patient, without naming them.

    Raises:
        InvalidInput: CT_PATIENTS_MIXED.
    """
    identities = {frame.shared.patient_identity for frame in frames}
    for field, kind_of_value in (
        ("identifier", "patient IDs"),
        ("name", "patient names"),
        ("born", "dates of birth"),
    ):
        different = {getattr(patient_identity, field) for patient_identity in identities} - {""}
        if len(different) > 1:
            raise InvalidInput(
                "CT_PATIENTS_MIXED",
                f"{what} contains images with {len(different)} different {kind_of_value}, expected 1",
                GIVE_ONE,
                {
                    "images_where": what,
                    "identity_kind": kind_of_value,
                    "patients": len(different),
                    "images": len(frames),
                },
            )


def describe(series: dict[str, list[Frame]]) -> tuple[SeriesDescription, ...]:
    """Return all series, ordered by number, without data that identify the patient."""
    identities: list[PatientIdentity] = []
    described = []
    for identifier, frames in sorted(series.items(), key=lambda one: (one[1][0].shared.number, one[0])):
        first = frames[0].shared
        if first.patient_identity not in identities:
            identities.append(first.patient_identity)
        sizes = {frame.shared.size_wh_px for frame in frames}
        pixel = frames[0].pixel_mm
        described.append(
            SeriesDescription(
                series=identifier,
                kind="dicom",
                modality=first.modality,
                words=_without_names(first.words, [frame.shared.patient_identity for frame in frames]),
                number=first.number,
                patient=identities.index(first.patient_identity) + 1,
                images=len(frames),
                size_wh_px=first.size_wh_px if len(sizes) == 1 else (0, 0),
                pixel_mm=(pixel[1], pixel[0]) if pixel else (0.0, 0.0),
                thickness_mm=first.thickness_mm,
                kernel=first.kernel,
                compression=UID(first.compression).name,
                problem=_problem(frames),
            )
        )
    return tuple(described)


def _without_names(words: str, identities: list[PatientIdentity]) -> str:
    """Return the series description; empty if it contains a part of the patient's name."""
    parts = {
        part
        for patient_identity in identities
        for field in (patient_identity.name, patient_identity.identifier, patient_identity.born)
        for part in re.split(r"[\s,^]+", field)
        if len(part) >= 3
    }
    return "" if any(part in words.casefold() for part in parts) else words


def _problem(frames: list[Frame]) -> str:
    modality = frames[0].shared.modality
    if modality != "CT":
        return f"it is {modality or 'of unknown kind'}, not CT"
    if len(frames) < 2:
        return "it has 1 slice, the minimum is 2"
    if not all(frame.position_lps_mm and frame.directions and frame.pixel_mm for frame in frames):
        return "its slices do not state their positions"
    return ""


def choose(series: dict[str, list[Frame]], requested: str | None) -> list[Frame]:
    """Return the slices of the requested series, or of the only CT.

    Raises:
        InvalidInput: CT_SERIES_UNKNOWN, CT_NOT_CT, CT_SERIES_UNCLEAR.
    """
    if requested is not None:
        if requested not in series:
            identifiers = ", ".join(sorted(series))
            raise InvalidInput(
                "CT_SERIES_UNKNOWN",
                f"none of the {len(series)} series has this identifier",
                f"Give the identifier of one of them: {identifiers}.",
                {"series": sorted(series), "count": len(series), "identifiers": identifiers},
            )
        _check_modality(series[requested])
        return series[requested]
    found = [frames for frames in series.values() if frames[0].shared.modality == "CT" and len(frames) > 1]
    many = [frames for frames in found if len(frames) >= FEW_SLICES]
    if len(many or found) == 1:
        return (many or found)[0]
    if not found:
        only = max(series.values(), key=len)
        _check_modality(only)
        raise InvalidInput(
            "CT_TOO_FEW_SLICES",
            f"the CT has {len(only)} slice, the minimum is 2",
            "Export the whole series again.",
            {"slices": len(only)},
        )
    usable = {one.series: one.words for one in describe(series) if not one.problem}
    slices, identifiers = ", ".join(str(len(frames)) for frames in found), ", ".join(usable)
    raise InvalidInput(
        "CT_SERIES_UNCLEAR",
        f"there are {len(found)} CT series, of {slices} slices",
        f"Select the series for planning: {identifiers}.",
        {"series": usable, "count": len(found), "slices": slices, "identifiers": identifiers},
    )


def _check_modality(frames: list[Frame]) -> None:
    kinds = Counter(frame.shared.modality for frame in frames)
    if set(kinds) != {"CT"}:
        counted = in_words(Counter(kind or "?" for kind in kinds.elements()))
        raise InvalidInput(
            "CT_NOT_CT",
            f"the images are not a CT: {counted}",
            "Give a CT; MR, PET and others have no Hounsfield units.",
            {"modalities": dict(kinds), "counted": counted},
        )


def in_words(counts: Counter[str]) -> str:
    """Return the most frequent values with their counts, such as `512 x 512 (120), 256 x 256 (1)`."""
    return ", ".join(f"{value} ({count})" for value, count in counts.most_common(4))
