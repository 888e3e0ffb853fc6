"""Remedies of errors, a module an area. Several errors share one."""

from server.texts.errors.remedies.access import ACCESS
from server.texts.errors.remedies.camera import CAMERA
from server.texts.errors.remedies.cases import CASES
from server.texts.errors.remedies.certificate import CERTIFICATE
from server.texts.errors.remedies.dicom import DICOM
from server.texts.errors.remedies.hub import HUB
from server.texts.errors.remedies.labels import LABELS
from server.texts.errors.remedies.procedure import PROCEDURE
from server.texts.errors.remedies.process import PROCESS
from server.texts.errors.remedies.recordings import RECORDINGS
from server.texts.errors.remedies.registration import REGISTRATION
from server.texts.errors.remedies.remarks import REMARKS
from server.texts.errors.remedies.tool import TOOL
from server.texts.language import Text

REMEDIES: tuple[Text, ...] = (
    *PROCEDURE,
    *REGISTRATION,
    *REMARKS,
    *TOOL,
    *CAMERA,
    *PROCESS,
    *RECORDINGS,
    *CASES,
    *LABELS,
    *DICOM,
    *HUB,
    *ACCESS,
    *CERTIFICATE,
)
