"""Images of the patient: DICOM and NIfTI in, meshes in. What is read here is handed to `tracker.plan`.

What a file says of the patient (name, date of birth, number) is compared and then dropped: no record,
message, warning or log line here holds it, nor any name of a file or folder.
"""

from server.imaging.ct import Ct, FirstSlice, LeftOut, Progress, SeriesDescription
from server.imaging.read import list_series, read_ct

__all__ = ["Ct", "FirstSlice", "LeftOut", "Progress", "SeriesDescription", "list_series", "read_ct"]
