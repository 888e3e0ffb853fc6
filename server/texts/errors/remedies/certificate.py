"""Remedies of errors of accuracy tests and their certificates."""

from server.texts.language import Text

CERTIFICATE: tuple[Text, ...] = (
    {
        "en": "Hold the tip in the divot longer, and record this capture again.",
        "de": "Die Spitze länger in der Mulde halten und diese Aufnahme wiederholen.",
    },
    {
        "en": "Hold the tool so that its marker faces the camera and is not covered, and record this capture "
        "again.",
        "de": "Das Instrument so halten, dass sein Marker zur Kamera zeigt und nicht verdeckt ist, und diese "
        "Aufnahme wiederholen.",
    },
    {
        "en": "Hold the tool upright, then tilted by about 30 degrees, then turned about its axis.",
        "de": "Das Instrument aufrecht halten, dann um etwa 30° geneigt, dann um seine Achse gedreht.",
    },
    {
        "en": "Issue the certificate, or discard the last capture.",
        "de": "Das Zertifikat ausstellen oder die letzte Aufnahme verwerfen.",
    },
    {"en": "Do the captures in their order.", "de": "Die Aufnahmen in ihrer Reihenfolge machen."},
    {"en": "Capture the first divot.", "de": "Die erste Mulde aufnehmen."},
    {"en": "Take the captures that are missing.", "de": "Die fehlenden Aufnahmen machen."},
    {
        "en": "Begin the accuracy test again.",
        "de": "Den Genauigkeitstest neu beginnen.",
    },
    {
        "en": "Begin an accuracy test with a tool and a plate.",
        "de": "Einen Genauigkeitstest mit einem Instrument und einer Platte beginnen.",
    },
    {
        "en": "Rest the hand, hold the tip still in the divot, and record this capture again.",
        "de": "Die Hand auflegen, die Spitze in der Mulde stillhalten und diese Aufnahme wiederholen.",
    },
    {
        "en": "Record poses of its own for each capture, and name them in the captures file.",
        "de": "Für jede Aufnahme eigene Lagen aufzeichnen und sie in der Datei der Aufnahmen nennen.",
    },
    {
        "en": "Record the captures with 'coaxial track --json'.",
        "de": "Die Aufnahmen mit 'coaxial track --json' aufzeichnen.",
    },
    {
        "en": "Bring the camera nearer, improve the light, and calibrate camera and tip again.",
        "de": "Die Kamera näher stellen, das Licht verbessern und Kamera und Spitze neu kalibrieren.",
    },
    {
        "en": "Capture the plate at two distances, tilted to the camera, with the tool in all postures.",
        "de": "Die Platte in zwei Abständen schräg zur Kamera aufnehmen, das Instrument in allen Haltungen.",
    },
    {
        "en": "Capture divots that are farther apart, or measure the rulers of the plate more exactly.",
        "de": "Weiter entfernte Mulden aufnehmen oder die Maßstäbe der Platte genauer messen.",
    },
    {
        "en": "Tilt the tool farther to all sides and turn it about its axis in the divots.",
        "de": "Das Instrument in den Mulden weiter nach allen Seiten neigen und um seine Achse drehen.",
    },
    {
        "en": "Capture the plate at two distances, tilted to the camera by 30 degrees and more.",
        "de": "Die Platte in zwei Abständen aufnehmen, um 30° und mehr zur Kamera geneigt.",
    },
    {
        "en": "Calibrate the camera again with the zoom and focus of the procedure, and lock both.",
        "de": "Die Kamera mit Zoom und Fokus des Eingriffs neu kalibrieren und beide feststellen.",
    },
    {
        "en": "Measure the black square of the tool's marker, correct side_mm, and calibrate the tip again.",
        "de": "Das schwarze Quadrat des Markers messen, side_mm berichtigen und die Spitze neu kalibrieren.",
    },
    {
        "en": "Capture more divots of the plate before it is moved, each upright, tilted and turned.",
        "de": "Vor dem Verschieben der Platte mehr Mulden aufnehmen, jede aufrecht, geneigt und gedreht.",
    },
    {
        "en": "Print the plate at 100 %, without fitting it to the page, and measure its rulers again.",
        "de": "Die Platte mit 100 % und ohne Anpassung an die Seite drucken und ihre Maßstäbe neu messen.",
    },
    {
        "en": "Measure both rulers of the plate with calipers or a steel ruler, and state their lengths.",
        "de": "Beide Maßstäbe der Platte mit Messschieber oder Stahllineal messen und die Längen angeben.",
    },
    {
        "en": "Measure both rulers of the plate. If they are correct, measure the black square of the "
        "marker.",
        "de": "Beide Maßstäbe der Platte messen; wenn sie stimmen, das schwarze Quadrat des Markers messen.",
    },
    {
        "en": "Do not rely on the stated errors of this system; calibrate camera and tip again.",
        "de": "Den angegebenen Fehlern dieses Systems nicht vertrauen; Kamera und Spitze neu kalibrieren.",
    },
    {
        "en": "Check that neither the tool nor its marker is bent or loose, and calibrate the tip again.",
        "de": "Prüfen, dass weder Instrument noch Marker verbogen oder lose ist, und die Spitze neu "
        "kalibrieren.",
    },
    {
        "en": "Capture more divots in each placement, and each divot upright, tilted and turned.",
        "de": "In jeder Aufstellung mehr Mulden aufnehmen, und jede Mulde aufrecht, geneigt und gedreht.",
    },
    {
        "en": "Correct the name of the divot. If the plate moved, record its captures again as another "
        "placement.",
        "de": "Den Namen der Mulde berichtigen. Wurde die Platte bewegt, ihre Aufnahmen als andere "
        "Aufstellung wiederholen.",
    },
    {
        "en": "Get the certificate again from whoever issued it; do not use this one.",
        "de": "Das Zertifikat vom Aussteller neu beschaffen; dieses nicht benutzen.",
    },
    {
        "en": "Repeat the accuracy test, and issue a new certificate.",
        "de": "Den Genauigkeitstest wiederholen und ein neues Zertifikat ausstellen.",
    },
    {
        "en": "Do the accuracy test, and install its certificate.",
        "de": "Den Genauigkeitstest durchführen und sein Zertifikat installieren.",
    },
    {
        "en": "Rely on the accuracy that the maker of the tracker states.",
        "de": "Die Genauigkeit gilt, die der Hersteller des Trackingsystems angibt.",
    },
    {
        "en": "Calibrate the camera, or restore focus and zoom.",
        "de": "Die Kamera kalibrieren oder Schärfe und Zoom wiederherstellen.",
    },
    {
        "en": "Issue it with COAXIAL_HOME set to the folder of this server.",
        "de": "Mit COAXIAL_HOME auf dem Ordner dieses Servers ausstellen.",
    },
    {"en": "Set the clock of this computer.", "de": "Die Uhr dieses Computers stellen."},
    {
        "en": "Restore this file from a backup, or remove it: then a new key signs, and older certificates "
        "are of another signer.",
        "de": "Diese Datei aus einer Sicherung wiederherstellen oder entfernen: dann signiert ein neuer "
        "Schlüssel, und ältere Zertifikate sind von einem anderen Aussteller.",
    },
    {
        "en": "Repeat the test at least once a year.",
        "de": "Den Test mindestens einmal im Jahr wiederholen.",
    },
    {
        "en": "Correct what the test found, and repeat it.",
        "de": "Beheben, was der Test gefunden hat, und den Test wiederholen.",
    },
    {
        "en": "Give a certificate as it was issued, as JSON or PDF.",
        "de": "Ein Zertifikat so angeben, wie es ausgestellt wurde, als JSON oder PDF.",
    },
    {
        "en": "Check it with the version of Coaxial that issued it.",
        "de": "Mit der Version von Coaxial prüfen, die es ausgestellt hat.",
    },
    {
        "en": "Write one with 'coaxial certify plate --output plate.pdf', or give name, sd_mm and divots.",
        "de": "Eine mit 'coaxial certify plate --output plate.pdf' schreiben, oder name, sd_mm und divots "
        "angeben.",
    },
    {"en": "Name one of its divots: {divots}.", "de": "Eine ihrer Mulden nennen: {divots}."},
    {
        "en": "Give the position of each divot in mm, as measured or printed.",
        "de": "Die Lage jeder Mulde in mm angeben, wie gemessen oder gedruckt.",
    },
    {
        "en": "Give at least 2x2 and at most {max_divots} divots, and a pitch of 5 to 300 mm.",
        "de": "Mindestens 2x2 und höchstens {max_divots} Mulden angeben, und einen Abstand von 5 bis 300 mm.",
    },
    {
        "en": "Give no lengths of rulers for a plate whose divots were measured.",
        "de": "Für eine Platte mit gemessenen Mulden keine Längen von Maßstäben angeben.",
    },
    {
        "en": "Give the measured lengths of the rulers across and down the page in mm.",
        "de": "Die gemessenen Längen der Maßstäbe quer und längs der Seite in mm angeben.",
    },
    {
        "en": "Use fewer divots, a smaller pitch, or a larger paper with --paper A3.",
        "de": "Weniger Mulden, einen kleineren Abstand oder größeres Papier mit --paper A3 benutzen.",
    },
)
