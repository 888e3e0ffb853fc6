"""Names of labels: in the file, in the request, or else the class numbers of TotalSegmentator v2."""

import re
from collections.abc import Mapping

from server.imaging.container import Entry
from tracker.errors import InvalidInput
from tracker.plan.labels import CLASS_OF_LEVEL, LEVEL_OF_CLASS, MAX_CLASS, level_from_name

# SNOMED CT codes of segments in DICOM SEG (DICOM PS3.16, CID 7603 and others; as in pydicom's table of codes,
# S1 as in the table of TotalSegmentator).
LEVEL_OF_SNOMED: Mapping[str, str] = {
    "14806007": "C1",
    "39976000": "C2",
    "113205007": "C3",
    "5329002": "C4",
    "36978003": "C5",
    "36054005": "C6",
    "87391001": "C7",
    "64864005": "T1",
    "53733008": "T2",
    "1626008": "T3",
    "73071006": "T4",
    "56401006": "T5",
    "45296009": "T6",
    "62487009": "T7",
    "11068009": "T8",
    "82687006": "T9",
    "7610001": "T10",
    "12989004": "T11",
    "23215003": "T12",
    "66794005": "L1",
    "14293000": "L2",
    "36470004": "L3",
    "11994002": "L4",
    "49668003": "L5",
    "65985001": "S1",
}
MAX_NUMBER, MAX_NAMES, MAX_TEXT = 65_535, 200, 4000
# Extensions follow the header of 348 or 540 bytes up to the first voxel; larger ones are not label tables.
MAX_EXTENSION_BYTES = 2**20
# A label of the table that Connectome Workbench and TotalSegmentator write: its number, and its name.
_LABEL = re.compile(
    rb"<Label\b[^>]{0,200}\bKey=\"(?P<number>\d{1,5})\"[^>]{0,200}>\s{0,20}(?:<!\[CDATA\[)?"
    rb"(?P<name>[\w .-]{1,64})"
)
HOW = "State the level of each label as number:level, for example 29:L3,28:L4."


def names_from_text(text: str) -> dict[int, int]:
    """Parse `29:L3,28:L4`: return class numbers of levels by the number of a label.

    Raises:
        InvalidInput: LABEL_NAMES_INVALID.
    """
    parts = [part.strip() for part in text[:MAX_TEXT].split(",") if part.strip()]
    named: dict[int, int] = {}
    for part in parts:
        number, _, name = part.partition(":")
        level = level_from_name(name)
        is_number = number.strip().isascii() and number.strip().isdigit() and len(number) < 6
        if level is None or not is_number or not 0 < int(number) <= MAX_NUMBER or int(number) in named:
            raise InvalidInput(
                "LABEL_NAMES_INVALID",
                f"'{part[:40]}' does not state a number from 1 to {MAX_NUMBER} with its level",
                HOW,
                {"part": part[:40], "max_number": MAX_NUMBER},
            )
        named[int(number)] = CLASS_OF_LEVEL[level]
    if len(named) > MAX_NAMES or len(set(named.values())) < len(named) or len(text) > MAX_TEXT:
        raise InvalidInput(
            "LABEL_NAMES_INVALID",
            f"the names state {len(set(named.values()))} levels for {len(named)} labels; each level can have "
            "one label",
            HOW,
            {"levels": len(set(named.values())), "labels": len(named)},
        )
    return named


def class_of_file_name(name: str) -> int | None:
    """Return the class number for `vertebrae_L3.nii.gz`, as TotalSegmentator names its files, else None."""
    stem = re.sub(r"\.nii(\.gz)?$", "", name, flags=re.IGNORECASE)
    level = level_from_name(stem) if stem != name else None
    return None if level is None else CLASS_OF_LEVEL[level]


def names_in_extension(content: bytes) -> dict[int, int]:
    """Return class numbers by the number of a label, from the label table in a NIfTI extension; 0 for others.

    The table is XML, of which only its labels are read, by their pattern.
    """
    found: dict[int, int] = {}
    for label in _LABEL.finditer(content[:MAX_EXTENSION_BYTES]):
        level, number = level_from_name(label["name"].decode("ascii", errors="replace")), int(label["number"])
        if number <= MAX_NUMBER:
            found[number] = 0 if level is None else CLASS_OF_LEVEL[level]
    return found


def classes_of_totalsegmentator() -> dict[int, int]:
    """Return the class numbers of TotalSegmentator v2: vertebrae as they are, all other structures as 0."""
    return {number: number if number in LEVEL_OF_CLASS else 0 for number in range(1, MAX_CLASS + 1)}


def is_named_vertebra(entry: Entry) -> bool:
    """Return whether the name of a file is that of one vertebra."""
    return class_of_file_name(entry.name) is not None
