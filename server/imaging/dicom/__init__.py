"""Reading of DICOM: detection of slices, grouping into series, and Hounsfield units."""

from server.imaging.dicom.reader import list_dicom, read_dicom

__all__ = ["list_dicom", "read_dicom"]
