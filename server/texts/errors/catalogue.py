"""Templates of messages by code, and of remedies, in all languages."""

from collections.abc import Mapping
from itertools import product

from server.texts.errors.access import ACCESS
from server.texts.errors.camera import CAMERA
from server.texts.errors.cases import CASES
from server.texts.errors.certificate import CERTIFICATE
from server.texts.errors.procedure import PROCEDURE
from server.texts.errors.recordings import RECORDINGS
from server.texts.errors.registration import REGISTRATION
from server.texts.errors.remedies import REMEDIES as OF_ERRORS
from server.texts.errors.tool import TOOL
from server.texts.language import LANGUAGES, Text
from server.texts.steps import CONFIRM, REASONS, STEPS

# Why a capture has no tip in an image, as a part of its message.
_UNSEEN: tuple[Text, ...] = (
    {"en": "the tool's marker is not seen", "de": "der Marker des Instruments ist nicht zu sehen"},
    {"en": "the tool's marker is in view twice", "de": "der Marker des Instruments ist doppelt im Bild"},
    {
        "en": "the position of the tip is uncertain by millimetres",
        "de": "der Ort der Spitze ist um Millimeter unsicher",
    },
    {"en": "the camera is not calibrated", "de": "die Kamera ist nicht kalibriert"},
    {
        "en": "focus or zoom of the camera has changed since the calibration",
        "de": "Schärfe oder Zoom der Kamera wurde seit der Kalibrierung verstellt",
    },
)
_AT_RATE: tuple[Text, ...] = (
    dict.fromkeys(LANGUAGES, ""),
    {"en": " at {rate_hz:.1f} images/s", "de": " bei {rate_hz:.1f} Bildern/s"},
)
_CAPTURE_UNSEEN: tuple[Text, ...] = tuple(
    {
        "en": "the tip was known in {seen} of {images} images" + rate["en"] + " and not in {unseen} "
        f"({why['en']}), needed in all",
        "de": "die Spitze war in {seen} von {images} Bildern" + rate["de"] + " bekannt und in {unseen} nicht "
        f"({why['de']}), nötig in allen",
    }
    for why, rate in product(_UNSEEN, _AT_RATE)
)
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
    {"CAPTURE_UNSEEN": _CAPTURE_UNSEEN},
    PROCEDURE,
    REGISTRATION,
    TOOL,
    CAMERA,
    RECORDINGS,
    CASES,
    ACCESS,
    CERTIFICATE,
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
