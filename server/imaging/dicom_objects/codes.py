"""Codes of what is segmented and measured: SNOMED CT and DICOM where they have one, else codes of Coaxial."""

from pydicom.sr.codedict import codes
from pydicom.sr.coding import Code

from server.imaging.labels.names import LEVEL_OF_SNOMED
from tracker.plan.labels import level_from_name
from tracker.plan.pedicle import Side

PRIVATE_SCHEME, PRIVATE_SCHEME_NAME = "99COAXIAL", "Coaxial"
VERTEBRA = Code("51282000", "SCT", "Vertebra")
CODE_OF_LEVEL = {level: Code(code, "SCT", f"{level} vertebra") for code, level in LEVEL_OF_SNOMED.items()}
LATERALITY: dict[Side, Code] = {"left": codes.SCT.Left, "right": codes.SCT.Right}
MM, DEG = codes.UCUM.Millimeter, codes.UCUM.Degree
WIDTH, HEIGHT, LENGTH = codes.SCT.Width, codes.DCM.Height, codes.SCT.Length
DIAMETER, SCREW, PEDICLE = codes.SCT.Diameter, codes.SCT.BoneScrew, codes.SCT.PedicleOfVertebra


def private_code(value: str, meaning: str) -> Code:
    """Return a code of Coaxial's own scheme."""
    return Code(value, PRIVATE_SCHEME, meaning)


CHANNEL = private_code("channel", "Planned drill channel")
TRANSVERSE = private_code("transverse", "Transverse angle to anterior, positive medially")
SAGITTAL = private_code("sagittal", "Sagittal angle to anterior, positive cranially")
CLEARANCES = {
    f"{wall}_mm": private_code(f"wall-{wall}", f"Clearance to the {wall} wall, negative for a breach")
    for wall in ("medial", "lateral", "superior", "inferior", "anterior")
}
BREACH = private_code("breach", "Deepest breach of the pedicle wall")
GRADE = private_code("breach-grade", "Grade of breach by Gertzbein and Robbins")
CORRECTED = private_code("corrected", "Corrected by a person")


def code_of_vertebra(name: str) -> Code:
    """Return the code of the level that a name denotes; that of any vertebra if it denotes none."""
    level = level_from_name(name)
    return VERTEBRA if level is None else CODE_OF_LEVEL[level]


def code_of_grade(grade: str) -> Code:
    """Return the code of a grade of breach, A to E."""
    return private_code(f"grade-{grade}", f"Grade {grade}")


def ascii_text(value: str) -> str:
    """Return a text in the letters that every character set of DICOM has."""
    return value.encode("ascii", "replace").decode("ascii")
