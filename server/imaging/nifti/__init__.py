"""NIfTI in and out: any order and direction of its axes, any kind of number; Hounsfield units in LPS mm."""

from server.imaging.nifti.header import is_nifti
from server.imaging.nifti.read import describe_nifti, read_nifti
from server.imaging.nifti.write import nifti_bytes

__all__ = ["describe_nifti", "is_nifti", "nifti_bytes", "read_nifti"]
