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
        "en": "Check that the poses lead from the marker to camera or tracker, and are not inverted.",
        "de": "Prüfen, dass die Lagen vom Marker zur Kamera oder zum Trackingsystem führen und nicht "
        "invertiert sind.",
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
    {
        "en": "Calibrate the tool with its present marker; a tip is never scaled.",
        "de": "Das Instrument mit seinem jetzigen Marker kalibrieren; eine Spitze wird nie skaliert.",
    },
    {
        "en": "Give tools.{tool}.calibration, or tip_in_marker_mm and axis_in_marker.",
        "de": "tools.{tool}.calibration angeben, oder tip_in_marker_mm und axis_in_marker.",
    },
    {
        "en": "Give the tip in the marker's frame, as pivot calibration returns it.",
        "de": "Die Spitze im Koordinatensystem des Markers angeben, wie die Kalibrierung durch Schwenken "
        "sie liefert.",
    },
    {
        "en": "Give the tip as three numbers in mm in the marker's frame, as pivot calibration returns it.",
        "de": "Die Spitze als drei Zahlen in mm im Koordinatensystem des Markers angeben, wie die "
        "Kalibrierung durch Schwenken sie liefert.",
    },
    {
        "en": "Give the direction from the marker towards the tip, as three numbers.",
        "de": "Die Richtung vom Marker zur Spitze als drei Zahlen angeben.",
    },
    {
        "en": "Give each pose its covariance (6, 6) in mm and radians, translation first, or give none.",
        "de": "Zu jeder Lage ihre Kovarianz (6, 6) in mm und Radiant angeben, Translation zuerst, oder zu "
        "keiner.",
    },
    {
        "en": "Measure the outer side of the printed black square in mm.",
        "de": "Die äußere Seite des gedruckten schwarzen Quadrats in mm messen.",
    },
    {
        "en": "Use shapes that differ; 'coaxial marker design' with another seed makes another.",
        "de": "Verschiedene Formen verwenden; „coaxial marker design“ mit einem anderen Startwert "
        "erzeugt eine andere.",
    },
    {
        "en": "Use a shape that differs from its mirror image; 'coaxial marker design' makes one.",
        "de": "Eine Form verwenden, die sich von ihrem Spiegelbild unterscheidet; „coaxial marker "
        "design“ erzeugt eine.",
    },
    {"en": "Use a shape without rotational symmetry.", "de": "Eine Form ohne Drehsymmetrie verwenden."},
    {"en": "Give each marker a unique name.", "de": "Jedem Marker einen eigenen Namen geben."},
    {
        "en": "Record longer, and keep the tool in view.",
        "de": "Länger aufnehmen und das Instrument im Bild halten.",
    },
    {
        "en": "Record at a higher rate, so that the motion of a hand is resolved.",
        "de": "Mit höherer Rate aufnehmen, damit die Bewegung einer Hand aufgelöst wird.",
    },
    {
        "en": "Check that both sources track one rigid tool (the same point where translations are "
        "compared), and that the offset lies within the search range.",
        "de": "Prüfen, dass beide Quellen ein starres Instrument verfolgen (denselben Punkt, wo "
        "Translationen verglichen werden) und dass der Zeitversatz im Suchbereich liegt.",
    },
    {
        "en": "Increase the search range, or start both clocks closer together.",
        "de": "Den Suchbereich vergrößern, oder beide Uhren näher beieinander starten.",
    },
    {
        "en": "Check that both clocks count real time: no images timed by a nominal rate, and none lost.",
        "de": "Prüfen, dass beide Uhren echte Zeit zählen: keine Bilder mit nomineller Rate, keine "
        "verlorenen.",
    },
    {
        "en": "Give its name. Available markers: {markers}.",
        "de": "Seinen Namen angeben. Verfügbare Marker: {markers}.",
    },
    {
        "en": "Tracked markers: {markers}. Upload it on the camera's page.",
        "de": "Verfolgte Marker: {markers}. Den Marker auf der Kameraseite hochladen.",
    },
    {
        "en": "Tracked markers: {markers}. Add it under markers.",
        "de": "Verfolgte Marker: {markers}. Den Marker unter markers hinzufügen.",
    },
    {
        "en": "Give a PNG, JPEG or BMP image that the black square of the marker fills edge to edge, "
        "row 0 at the top.",
        "de": "Ein PNG-, JPEG- oder BMP-Bild angeben, das vom schwarzen Quadrat des Markers bis zum "
        "Rand ausgefüllt wird, Zeile 0 oben.",
    },
    {
        "en": "Add the axis with 'coaxial spin', or set tools.{tool}.axis_in_marker.",
        "de": "Die Achse mit „coaxial spin“ hinzufügen, oder tools.{tool}.axis_in_marker setzen.",
    },
    {
        "en": "Write one with 'coaxial pivot POSES --marker NAME --side-mm MM --output FILE'.",
        "de": "Eine mit „coaxial pivot POSES --marker NAME --side-mm MM --output FILE“ schreiben.",
    },
    {
        "en": "Check the source of this 4x4 matrix: no scale, no reflection, row-major order.",
        "de": "Die Herkunft dieser 4x4-Matrix prüfen: keine Skalierung, keine Spiegelung, zeilenweise "
        "Ordnung.",
    },
    {
        "en": "Compare translations, if both sources track the same point of the tool.",
        "de": "Verschiebungen vergleichen, wenn beide Quellen denselben Punkt des Instruments verfolgen.",
    },
    {
        "en": "Record longer with both sources at once, start both clocks together, or reduce the search.",
        "de": "Länger mit beiden Quellen zugleich aufnehmen, beide Uhren zusammen starten, oder den "
        "Suchbereich verkleinern.",
    },
    {
        "en": "Record again: rotate and move the tool by hand, fast and irregularly, in view of both for "
        "over 10 s.",
        "de": "Neu aufnehmen: das Instrument von Hand schnell und unregelmäßig drehen und bewegen, über 10 "
        "s lang im Blick beider.",
    },
    {
        "en": "Give increasing times in seconds with one pose each, and omit times without a pose.",
        "de": "Ansteigende Zeiten in Sekunden mit je einer Lage angeben, Zeiten ohne Lage weglassen.",
    },
    {
        "en": "Each pose is a 4x4 matrix that maps points from the marker's frame to the camera's: "
        "rotation on the left, translation in the last column, 0 0 0 1 in the last row.",
        "de": "Jede Lage ist eine 4x4-Matrix, die Punkte aus dem Koordinatensystem des Markers in das der "
        "Kamera überführt: links die Drehung, in der letzten Spalte die Verschiebung, in der letzten "
        "Zeile 0 0 0 1.",
    },
    {
        "en": "Give all translations in one unit, and specify it if it is not mm (m: --unit m).",
        "de": "Alle Verschiebungen in einer Einheit angeben, und diese nennen, wenn es nicht mm ist (m: "
        "--unit m).",
    },
)
