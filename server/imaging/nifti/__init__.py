"""NIfTI in: any order and direction of its axes, any kind of number, into Hounsfield units in LPS mm."""

from server.imaging.nifti.header import is_nifti
from server.imaging.nifti.read import describe_nifti, read_nifti

__all__ = ["describe_nifti", "is_nifti", "read_nifti"]
