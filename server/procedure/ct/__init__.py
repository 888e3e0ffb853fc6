"""The step in which a CT comes into the case, and the CT of the open case as it is looked at."""

from server.procedure.ct.opened import CtInUse, OpenedCt
from server.procedure.ct.step import CtStep, ReadingBegun, UploadUnknown

__all__ = ["CtInUse", "CtStep", "OpenedCt", "ReadingBegun", "UploadUnknown"]
