"""What all objects of one export share: the program, series, and identifiers for tracking."""

import copy
from dataclasses import dataclass
from typing import Any

from pydicom.dataset import Dataset
from pydicom.uid import generate_uid

# Required by DICOM for each image of a study; highdicom reads them, and gets them empty.
PATIENT_AND_STUDY = (
    "PatientName",
    "PatientID",
    "PatientBirthDate",
    "PatientSex",
    "AccessionNumber",
    "StudyID",
    "StudyDate",
    "StudyTime",
    "ReferringPhysicianName",
)


@dataclass(frozen=True, slots=True, kw_only=True)
class Equipment:
    """The program that makes the objects.

    Attributes:
        version: of Coaxial.
        source_series_uid: of the CT; tracking identifiers are derived from it.
    """

    version: str
    source_series_uid: str

    def of_series(self, description: str, *, number: int) -> dict[str, Any]:
        """Return the arguments of highdicom for the only object of a new series."""
        return {
            "series_instance_uid": generate_uid(),
            "series_number": number,
            "series_description": f"Coaxial: {description}",
            "sop_instance_uid": generate_uid(),
            "instance_number": 1,
            "manufacturer": "Coaxial",
            "manufacturer_model_name": "Coaxial",
            "software_versions": self.version,
            "device_serial_number": "0",
        }

    def tracking_uid(self, name: str) -> str:
        """Return the identifier of one structure, which is the same in each export of this CT."""
        return str(generate_uid(entropy_srcs=["coaxial", self.source_series_uid, name]))

    @staticmethod
    def without_patient(image: Dataset) -> Dataset:
        """Return a header with the attributes that highdicom requires, empty."""
        completed = copy.copy(image)
        for keyword in PATIENT_AND_STUDY:
            setattr(completed, keyword, None)
        return completed
