"""Messages about the labels of vertebrae."""

from collections.abc import Mapping

from server.api.case_messages import HeadingMessage
from server.api.ct_messages import list_of, mapping_of
from server.stream.messages import Message


class VertebraLabelMessage(Message):
    """The label of one vertebra."""

    level: str
    """C1 to S1."""
    volume_ml: float
    centroid_lps_mm: list[float]
    low_lps_mm: list[float]
    """Smallest coordinates of its voxels."""
    high_lps_mm: list[float]
    """Largest coordinates."""
    is_cut: bool
    """Whether it touches the border of the CT."""


class LabelsMessage(Message):
    """The labels of vertebrae in the CT of the open case."""

    heading: HeadingMessage
    source: str
    """nifti or dicom."""
    source_voxel_mm: list[float]
    """Voxel size of the segmentation, before it was resampled to the CT."""
    contrast_hu: float
    """Mean HU inside of the labels less that around them."""
    sha256: str
    """SHA-256 of the file of the labels."""
    vertebrae: list[VertebraLabelMessage]
    """From the head down."""
    warnings: list[str]


def labels_message(heading: HeadingMessage, content: Mapping[str, object]) -> LabelsMessage:
    """Return the message of a document of labels."""
    return LabelsMessage.model_validate(
        {
            "heading": heading,
            "source": content.get("source"),
            "source_voxel_mm": list_of(content.get("source_voxel_mm")),
            "contrast_hu": content.get("contrast_hu"),
            "sha256": content.get("sha256"),
            "vertebrae": [mapping_of(one) for one in list_of(content.get("vertebrae"))],
            "warnings": list_of(content.get("warnings")),
        }
    )
