"""Remedies of errors of calibrating a tool."""

from server.texts.language import Text

TOOL: tuple[Text, ...] = (
    {"en": "Calibrate the tip by pivoting first.", "de": "Zuerst die Spitze durch Schwenken kalibrieren."},
    {
        "en": "Calibrate the tip by pivot calibration first.",
        "de": "Zuerst die Spitze durch Schwenken kalibrieren.",
    },
    {
        "en": "Give radius_mm and length_mm of the drill or awl, measured or from its drawing.",
        "de": "radius_mm und length_mm des Bohrers oder der Ahle angeben, gemessen oder aus der Zeichnung.",
    },
    {
        "en": "Tilt the tool with its tip in the divot.",
        "de": "Das Instrument mit der Spitze in der Mulde schwenken.",
    },
    {
        "en": "Take more images while the tool moves; images of a tool at rest add no information.",
        "de": "Mehr Bilder aufnehmen, während sich das Instrument bewegt; Bilder in Ruhe bringen nichts "
        "Neues.",
    },
    {
        "en": "Prevent the tip from slipping, hold the marker in good light near the camera, and calibrate "
        "again.",
        "de": "Die Spitze nicht abrutschen lassen, den Marker in gutem Licht nahe der Kamera halten und neu "
        "kalibrieren.",
    },
    {
        "en": "Take more poses, tilt farther to all sides, and calibrate again.",
        "de": "Mehr Lagen aufnehmen, weiter nach allen Seiten schwenken und neu kalibrieren.",
    },
    {
        "en": "The tip slipped or was moved: calibrate again in one divot.",
        "de": "Die Spitze ist abgerutscht oder wurde versetzt: in einer einzigen Mulde neu kalibrieren.",
    },
    {
        "en": "Keep the tip in the divot and the handle still, rotate the tool about its axis by 180 "
        "degrees, or as far as the marker stays in view, and calibrate again.",
        "de": "Die Spitze in der Mulde und den Griff ruhig halten, das Instrument um 180 Grad um seine "
        "Achse drehen, oder so weit der Marker sichtbar bleibt, und neu kalibrieren.",
    },
    {
        "en": "Check that neither the tool nor its marker is bent or loose, and calibrate the tip again.",
        "de": "Prüfen, dass weder Instrument noch Marker verbogen oder lose ist, und die Spitze neu "
        "kalibrieren.",
    },
    {
        "en": "Keep the tip in the divot, tilt the tool to all sides, and check again.",
        "de": "Die Spitze in der Mulde halten, das Instrument nach allen Seiten schwenken und erneut prüfen.",
    },
)
