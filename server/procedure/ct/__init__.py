"""Import of a CT into the case, and access to the CT of the open case."""

from server.procedure.ct.provider import CtProvider, MappedCt
from server.procedure.ct.step import CtStep, CtUpload, UploadUnknown

__all__ = ["CtProvider", "CtStep", "CtUpload", "MappedCt", "UploadUnknown"]
