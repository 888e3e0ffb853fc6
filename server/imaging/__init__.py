"""Reading of CTs (DICOM, NIfTI) and meshes for `tracker.plan`.

Patient data in a file (name, date of birth, ID) is compared and then dropped: no record, message, warning or
log line contains it, nor the name of a file or folder.
"""

from server.imaging.ct import Ct, ExcludedFiles, FirstSlice, Progress, SeriesDescription
from server.imaging.ct_reader import list_series, read_ct

__all__ = ["Ct", "ExcludedFiles", "FirstSlice", "Progress", "SeriesDescription", "list_series", "read_ct"]
