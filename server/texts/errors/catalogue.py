"""Templates of messages by code, and of remedies, in all languages."""

from collections.abc import Mapping

from server.texts.errors.access import ACCESS
from server.texts.errors.camera import CAMERA
from server.texts.errors.cases import CASES
from server.texts.errors.certificate import CERTIFICATE
from server.texts.errors.dicom import DICOM
from server.texts.errors.hub import HUB
from server.texts.errors.labels import LABELS
from server.texts.errors.procedure import PROCEDURE
from server.texts.errors.process import PROCESS
from server.texts.errors.recordings import RECORDINGS
from server.texts.errors.registration import REGISTRATION
from server.texts.errors.remarks import REMARKS
from server.texts.errors.remedies import REMEDIES as OF_ERRORS
from server.texts.errors.tool import TOOL
from server.texts.language import Text
from server.texts.steps import CONFIRM, REASONS, STEPS

# A step that is requested too early has the code of the step that it waits for, with that step's state.
_WAITS: Mapping[str, tuple[Text, ...]] = {
    f"{step.upper()}_{state}": (REASONS["WAITS_FOR_STEP"].message,)
    for step in STEPS
    for state in ("MISSING", "OUT_OF_DATE", "FAILED")
}
_UNSIGNED: Mapping[str, tuple[Text, ...]] = {
    f"{step.upper()}_NOT_COSIGNED": (REASONS["WAITS_FOR_COSIGNATURE"].message,) for step in STEPS
}
_PARTS = (
    {code: (sentence.message,) for code, sentence in REASONS.items()},
    _WAITS,
    _UNSIGNED,
    PROCEDURE,
    REGISTRATION,
    TOOL,
    CAMERA,
    PROCESS,
    RECORDINGS,
    CASES,
    HUB,
    LABELS,
    DICOM,
    ACCESS,
    CERTIFICATE,
    REMARKS,
)
MESSAGES: Mapping[str, tuple[Text, ...]] = {
    code: tuple(text for part in _PARTS for text in part.get(code, ()))
    for code in sorted({code for part in _PARTS for code in part})
}
REMEDIES: tuple[Text, ...] = (
    *(sentence.remedy for sentence in REASONS.values() if sentence.remedy["en"]),
    *CONFIRM.values(),
    *OF_ERRORS,
)
