"""Names of camera controls and texts of their values."""

from collections.abc import Mapping

from server.texts.language import Language, Text
from tracker.camera import CameraControl

CONTROLS: Mapping[Language, Mapping[CameraControl, str]] = {
    "en": {
        CameraControl.FOCUS: "Focus",
        CameraControl.ZOOM: "Zoom",
        CameraControl.PAN: "Pan",
        CameraControl.TILT: "Tilt",
        CameraControl.AUTOFOCUS: "Automatic focus",
        CameraControl.AUTO_EXPOSURE: "Automatic exposure",
        CameraControl.EXPOSURE: "Exposure",
        CameraControl.GAIN: "Gain",
        CameraControl.AUTO_WHITE_BALANCE: "Automatic white balance",
        CameraControl.WHITE_BALANCE: "White balance",
    },
    "de": {
        CameraControl.FOCUS: "Fokus",
        CameraControl.ZOOM: "Zoom",
        CameraControl.PAN: "Schwenkung",
        CameraControl.TILT: "Neigung",
        CameraControl.AUTOFOCUS: "Autofokus",
        CameraControl.AUTO_EXPOSURE: "Belichtungsautomatik",
        CameraControl.EXPOSURE: "Belichtung",
        CameraControl.GAIN: "Verstärkung",
        CameraControl.AUTO_WHITE_BALANCE: "Automatischer Weißabgleich",
        CameraControl.WHITE_BALANCE: "Weißabgleich",
    },
}
CAMERA: Text = {"en": "The camera", "de": "Die Kamera"}
OFF_ON: Mapping[Language, tuple[str, str]] = {"en": ("off", "on"), "de": ("aus", "an")}
SWITCHES = (CameraControl.AUTOFOCUS, CameraControl.AUTO_WHITE_BALANCE)


def control_name(control: CameraControl | None, language: Language) -> str:
    """Return the name of a control, capitalised; "The camera" if the control is unknown."""
    return CAMERA[language] if control is None else CONTROLS[language][control]


def setting(control: CameraControl | None, value: float, language: Language) -> str:
    """Return the value of a control: a number in driver units, or on/off for a switch."""
    if control in SWITCHES:
        return OFF_ON[language][1 if value else 0]
    return f"{value:.0f}"
