"""Reading of CTs (DICOM, NIfTI) and meshes for `tracker.plan`.

Patient data in a file (name, date of birth, ID) are compared and then dropped: no record, message, warning or
log line contains them, or the name of a file or folder.

`ct_reader` is not imported here, because the DICOM packages take three quarters of a second of the start.
"""

from server.imaging.ct import Ct, ExcludedFiles, FirstSlice, Progress, SeriesDescription

__all__ = ["Ct", "ExcludedFiles", "FirstSlice", "Progress", "SeriesDescription"]
