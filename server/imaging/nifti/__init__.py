"""Reading and writing of NIfTI, with any axis order and number type, in Hounsfield units and LPS mm."""

from server.imaging.nifti.header import is_nifti
from server.imaging.nifti.reader import describe_nifti, read_nifti
from server.imaging.nifti.writer import nifti_bytes

__all__ = ["describe_nifti", "is_nifti", "nifti_bytes", "read_nifti"]
