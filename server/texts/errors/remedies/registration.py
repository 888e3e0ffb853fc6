"""Remedies of errors of registration and its check."""

from server.texts.language import Text

REGISTRATION: tuple[Text, ...] = (
    {
        "en": "Start the registration again with the current plan, camera and tool.",
        "de": "Die Registrierung mit jetziger Planung, Kamera und jetzigem Instrument neu beginnen.",
    },
    {
        "en": "Calibrate the camera first, or set camera.calibration to its file.",
        "de": "Zuerst die Kamera kalibrieren, oder camera.calibration auf ihre Datei setzen.",
    },
    {"en": "Mark each planned needle once.", "de": "Jede geplante Nadel einmal markieren."},
    {"en": "Fit the overlay first.", "de": "Zuerst die Schicht anpassen."},
    {
        "en": "Clear the view of the marker on the patient, and register again.",
        "de": "Die Sicht auf den Patientenmarker freimachen und neu registrieren.",
    },
    {"en": "Turn it to the camera, and register again.", "de": "Ihn zur Kamera drehen und neu registrieren."},
    {
        "en": "Mark more landmarks on the CT in the plan, including one for the check.",
        "de": "In der Planung weitere Landmarken auf dem CT setzen, auch eine für die Prüfung.",
    },
    {
        "en": "Capture another landmark, or include one that was excluded.",
        "de": "Eine weitere Landmarke antasten, oder eine ausgeschlossene wieder verwenden.",
    },
    {
        "en": "Touch at least three landmarks that are not collinear; four or more reveal a gross error.",
        "de": "Mindestens drei Landmarken antasten, die nicht auf einer Geraden liegen; ab vier fällt ein "
        "grober Fehler auf.",
    },
    {
        "en": "Register by these points only, or by the needles only.",
        "de": "Nur mit diesen Punkten registrieren, oder nur mit den Nadeln.",
    },
    {"en": "Capture it first.", "de": "Diese Landmarke zuerst antasten."},
    {
        "en": "Hold the marker nearer to the camera and in better light, and touch the landmark again.",
        "de": "Den Marker näher an die Kamera und in besseres Licht halten und die Landmarke neu antasten.",
    },
    {
        "en": "Rest the hand, hold the tip still on the landmark, and touch it again.",
        "de": "Die Hand auflegen, die Spitze ruhig auf die Landmarke halten und neu antasten.",
    },
    {
        "en": "Touch it again; if the error remains, patient or reference has moved: register again.",
        "de": "Neu antasten; bleibt der Fehler, hat sich Patient oder Patientenmarker bewegt: neu "
        "registrieren.",
    },
    {
        "en": "Check on another landmark: one that was used fits by construction.",
        "de": "An einer anderen Landmarke prüfen: eine verwendete passt immer.",
    },
    {
        "en": "Check that each needle is on its landmark and marked at its entry into the bone.",
        "de": "Prüfen, dass jede Nadel auf ihrer Landmarke sitzt und an ihrem Eintritt in den Knochen "
        "markiert ist.",
    },
    {
        "en": "Touch a needle's entry with the tool's tip, or measure the camera's tilt more accurately.",
        "de": "Den Eintritt einer Nadel mit der Spitze des Instruments antasten, oder die Neigung der "
        "Kamera genauer messen.",
    },
    {
        "en": "Set a landmark for each needle on the CT, or draw the three lines.",
        "de": "Auf dem CT für jede Nadel eine Landmarke setzen, oder die drei Linien zeichnen.",
    },
    {
        "en": "Set a landmark for each needle on the CT.",
        "de": "Auf dem CT für jede Nadel eine Landmarke setzen.",
    },
    {"en": "Put the needles farther apart.", "de": "Die Nadeln weiter auseinander setzen."},
    {
        "en": "Put one needle farther from the line through the others.",
        "de": "Eine Nadel weiter weg von der Geraden durch die anderen setzen.",
    },
    {
        "en": "Mark each needle by hand, or remove the drill and other instruments from the image.",
        "de": "Jede Nadel von Hand markieren, oder Bohrer und andere Instrumente aus dem Bild nehmen.",
    },
    {
        "en": "Undo nudges, or register again: an error of this size needs a new registration.",
        "de": "Feinkorrekturen rückgängig machen, oder neu registrieren: ein Fehler dieser Größe braucht "
        "eine neue Registrierung.",
    },
    {"en": "The registration is unchanged.", "de": "Die Registrierung ist unverändert."},
    {
        "en": "Sweep the tip slowly over both laminae, the base of the spinous process and both facets.",
        "de": "Mit der Spitze langsam beide Laminae, die Basis des Dornfortsatzes und beide "
        "Gelenkfortsätze abfahren.",
    },
    {
        "en": "Register by landmarks first, and check that mesh and sweep are both in mm and of this "
        "vertebra.",
        "de": "Zuerst mit Landmarken registrieren, und prüfen, dass Netz und Messpunkte in mm sind und zu "
        "diesem Wirbel gehören.",
    },
    {
        "en": "Keep the tip on bare bone while sweeping, and lift it off only when the sweep has ended.",
        "de": "Die Spitze beim Abfahren auf freiem Knochen halten und erst am Ende abheben.",
    },
    {
        "en": "Hold the tip in the divot, tilt the tool slowly to all sides by 20 degrees and more, and "
        "calibrate again.",
        "de": "Die Spitze in der Mulde halten, das Instrument langsam um 20 Grad und mehr nach allen Seiten "
        "schwenken und neu kalibrieren.",
    },
    {
        "en": "Turn the markers to the camera, do not cover them, and touch the landmark again.",
        "de": "Die Marker zur Kamera drehen, nicht verdecken, und die Landmarke neu antasten.",
    },
    {
        "en": "Available tools: {tools}. Calibrate tip and axis first.",
        "de": "Verfügbare Instrumente: {tools}. Zuerst Spitze und Achse kalibrieren.",
    },
    {
        "en": "Existing landmarks: {landmarks}. Set them in the plan.",
        "de": "Vorhandene Landmarken: {landmarks}. In der Planung setzen.",
    },
    {
        "en": "Touch these landmarks again, each when its name is shown, or put the rows in order.",
        "de": "Diese Landmarken neu antasten, jede, wenn ihr Name angezeigt wird, oder die Zeilen "
        "richtig ordnen.",
    },
    {
        "en": "Check that left and right landmarks are not exchanged, and that no axis has the "
        "wrong sign (LPS and RAS differ in two signs, not in one).",
        "de": "Prüfen, dass linke und rechte Landmarken nicht vertauscht sind und keine Achse das "
        "falsche Vorzeichen hat (LPS und RAS unterscheiden sich in zwei Vorzeichen, nicht in einem).",
    },
    {
        "en": "Touch the landmarks again, and choose ones whose distances from each other differ.",
        "de": "Die Landmarken neu antasten und solche mit verschiedenen Abständen voneinander wählen.",
    },
    {"en": "Give each landmark a unique name.", "de": "Jeder Landmarke einen eigenen Namen geben."},
    {
        "en": "Give a symmetric positive 3x3 matrix in mm^2 for each tip, or none at all.",
        "de": "Zu jeder Spitze eine symmetrische, positive 3x3-Matrix in mm^2 angeben, oder zu keiner.",
    },
    {
        "en": "Add landmarks, farther apart and around the target, then register again.",
        "de": "Weitere Landmarken hinzunehmen, weiter auseinander und um den Zielpunkt herum, und neu "
        "registrieren.",
    },
    {
        "en": "Give both in millimetres, and check that both files are of the same landmarks.",
        "de": "Beide in Millimetern angeben und prüfen, dass beide Dateien dieselben Landmarken enthalten.",
    },
    {
        "en": "Exclude one of them, or touch it again.",
        "de": "Einen davon ausschließen, oder ihn neu antasten.",
    },
    {
        "en": "Sweep surfaces with other normals too: the flanks of the spinous process, the rims "
        "of the facets, the transverse processes.",
        "de": "Auch Flächen anderer Richtung abfahren: die Seiten des Dornfortsatzes, die Ränder der "
        "Gelenkfortsätze, die Querfortsätze.",
    },
    {
        "en": "Sweep more of the bone: the base of the spinous process, and both facets.",
        "de": "Mehr vom Knochen abfahren: die Basis des Dornfortsatzes und beide Gelenkfortsätze.",
    },
    {"en": "Register again.", "de": "Neu registrieren."},
    {
        "en": "Give both in mm: the landmark on the CT, the tip in the anchor's frame.",
        "de": "Beide in mm angeben: die Landmarke auf dem CT, die Spitze im Koordinatensystem der "
        "Kamera oder des Patientenmarkers.",
    },
    {"en": "Align the slice with the needles again.", "de": "Die Schicht neu an den Nadeln ausrichten."},
    {
        "en": "Give a point and a direction in LPS, and spreads above 0.",
        "de": "Einen Punkt und eine Richtung in LPS angeben, und Streuungen über 0.",
    },
    {"en": "Name each once.", "de": "Jede Nadel nur einmal nennen."},
    {
        "en": "Measure V and H from the camera to the patient, and give their accuracy.",
        "de": "V und H von der Kamera zum Patienten messen und ihre Genauigkeit angeben.",
    },
    {
        "en": "Measure H to the vertebra again, or tilt the camera.",
        "de": "H bis zum Wirbel neu messen, oder die Kamera neigen.",
    },
    {
        "en": "Mark the needle's exit from the bone, and its head.",
        "de": "Den Austritt der Nadel aus dem Knochen und ihren Kopf markieren.",
    },
    {
        "en": "Give a point of the plan in mm, such as the entry point.",
        "de": "Einen Punkt der Planung in mm angeben, etwa den Eintrittspunkt.",
    },
    {
        "en": "Register by points again, then sweep.",
        "de": "Zuerst neu mit Landmarken registrieren, dann abfahren.",
    },
    {
        "en": "Set reference.marker to the marker on the patient, or register again.",
        "de": "reference.marker auf den Patientenmarker setzen, oder neu registrieren.",
    },
    {
        "en": "Touch that landmark again, or leave it out, then register again.",
        "de": "Diese Landmarke neu antasten, oder sie weglassen, und neu registrieren.",
    },
    {
        "en": "Touch {possible_outliers[0]} again, which is the likeliest; {possible_outliers[1]} may "
        "be mistaken instead, which another landmark would show.",
        "de": "Die wahrscheinlichste, {possible_outliers[0]}, neu antasten; auch {possible_outliers[1]} "
        "kann falsch sein, was eine weitere Landmarke zeigen würde.",
    },
    {
        "en": "Touch {possible_outliers[0]} again, which is the likeliest; {possible_outliers[1]} or "
        "{possible_outliers[2]} may be mistaken instead, which another landmark would show.",
        "de": "Die wahrscheinlichste, {possible_outliers[0]}, neu antasten; auch {possible_outliers[1]} "
        "oder {possible_outliers[2]} kann falsch sein, was eine weitere Landmarke zeigen würde.",
    },
    {
        "en": "Start a registration by landmarks with a tool.",
        "de": "Eine Registrierung mit Landmarken beginnen und dazu ein Instrument wählen.",
    },
    {"en": "Start a sweep with a tool.", "de": "Das Abfahren mit einem Instrument beginnen."},
    {"en": "Start a check on a landmark.", "de": "Eine Prüfung an einer Landmarke beginnen."},
    {
        "en": "Start a collection for a calibration board.",
        "de": "Eine Aufnahme von Ansichten einer Tafel beginnen.",
    },
    {
        "en": "Start a measurement on the camera's page.",
        "de": "Eine Messung auf der Seite der Kamera beginnen.",
    },
    {"en": "Start a measurement of the readout time.", "de": "Eine Messung der Auslesezeit beginnen."},
    {
        "en": "Start a collection for a tool and a purpose.",
        "de": "Eine Aufnahme für ein Instrument und einen Zweck beginnen.",
    },
    {
        "en": "Add a landmark that lies well beside that line, such as a transverse process, and fit again.",
        "de": "Eine Landmarke deutlich neben dieser Geraden hinzunehmen, etwa einen Querfortsatz, und neu "
        "registrieren.",
    },
    {
        "en": "Mark each needle again under its own name, or touch the entry of one with the tool's tip.",
        "de": "Jede Nadel neu unter ihrem Namen markieren, oder den Eintritt von einer mit der Spitze "
        "des Instruments antasten.",
    },
    {
        "en": "Mark one needle each for {needles}, in this order.",
        "de": "Je eine Nadel für {needles} markieren, in dieser Reihenfolge.",
    },
    {
        "en": "Nudge in small steps, and register again where many would be needed.",
        "de": "In kleinen Schritten korrigieren, und neu registrieren, wo viele nötig wären.",
    },
    {
        "en": "Give the positions of the tip in mm, in the anchor's frame.",
        "de": "Die Orte der Spitze in mm angeben, im Koordinatensystem des Ankers.",
    },
    {
        "en": "Hold the tip still on the landmark{left_hint} until it is captured.",
        "de": "Die Spitze{left_hint} ruhig auf die Landmarke halten, bis sie erfasst ist.",
    },
    {
        "en": "Hold the tip still on the landmark{hold_hint} until it is taken.",
        "de": "Die Spitze{hold_hint} ruhig auf die Landmarke halten, bis sie erfasst ist.",
    },
    {
        "en": "Hold the tip still, and touch the landmark again.{rate_remedy}",
        "de": "Die Spitze ruhig halten und die Landmarke neu antasten.{rate_remedy}",
    },
    {
        "en": "Touch the landmark again when images come faster.{rate_remedy}",
        "de": "Die Landmarke neu antasten, wenn die Bilder schneller kommen.{rate_remedy}",
    },
    {
        "en": "Check the names and entries of the needles, V, H and azimuth, and the touched points.",
        "de": "Namen und Eintritte der Nadeln, V, H und Azimut sowie die angetasteten Punkte prüfen.",
    },
)
