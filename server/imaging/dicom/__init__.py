"""DICOM in: which files are slices, which slices are one series, and their Hounsfield units."""

from server.imaging.dicom.read import list_dicom, read_dicom

__all__ = ["list_dicom", "read_dicom"]
