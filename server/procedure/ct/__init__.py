"""The step in which a CT comes into the case, and the CT of the open case as it is looked at."""

from server.procedure.ct.provider import CtProvider, MappedCt
from server.procedure.ct.step import CtStep, CtUpload, UploadUnknown

__all__ = ["CtProvider", "CtStep", "CtUpload", "MappedCt", "UploadUnknown"]
