"""Reading of CTs (DICOM, NIfTI) and meshes for `tracker.plan`.

Patient data in a file (name, date of birth, ID) is compared and then dropped: no record, message, warning or
log line contains it, nor the name of a file or folder.

`ct_reader` is not imported here: what reads DICOM takes three quarters of a second of a server's start.
"""

from server.imaging.ct import Ct, ExcludedFiles, FirstSlice, Progress, SeriesDescription

__all__ = ["Ct", "ExcludedFiles", "FirstSlice", "Progress", "SeriesDescription"]
