"""Phrases in errors of cases, CTs, surfaces and plans."""

from collections.abc import Mapping

from server.texts.language import NO_TEXT, Text

_SIDES: tuple[Text, ...] = ({"en": "left", "de": "links"}, {"en": "right", "de": "rechts"})

CASES: Mapping[str, tuple[Text, ...]] = {
    "bone_shape": (
        {
            "en": "it is {width_mm:.1f} x {height_mm:.1f} mm",
            "de": "er misst {width_mm:.1f} x {height_mm:.1f} mm",
        },
        {
            "en": "it is equally thick for {length_mm:.0f} mm and joins neither body nor arch",
            "de": "er ist über {length_mm:.0f} mm gleich dick und geht weder in Wirbelkörper noch Bogen über",
        },
    ),
    "second": (
        {"en": "from 2 mm aside none is found", "de": "2 mm daneben wird keiner gefunden"},
        {
            "en": "from a few mm aside it is {other_mm[0]:.1f} x {other_mm[1]:.1f} mm, "
            "{apart_mm:.1f} mm away",
            "de": "wenige mm daneben ist er {other_mm[0]:.1f} x {other_mm[1]:.1f} mm, "
            "{apart_mm:.1f} mm entfernt",
        },
    ),
    "side": _SIDES,
    "other_side": _SIDES,
    "plan_problem": (
        {
            "en": "its format is not '{format}'",
            "de": "ihr Format ist nicht „{format}“",
        },
        {
            "en": "it is nested too deeply",
            "de": "sie ist zu tief verschachtelt",
        },
        {
            "en": "it is not valid JSON",
            "de": "sie ist kein gültiges JSON",
        },
        {
            "en": "it is not a JSON object",
            "de": "sie ist kein JSON-Objekt",
        },
    ),
    "table_hint": (
        NO_TEXT,
        {
            "en": ", but a lookup table",
            "de": ", sondern eine Umsetzungstabelle",
        },
    ),
    "pixel_count": (
        NO_TEXT,
        {
            "en": " ({pixel_bytes} bytes of pixels)",
            "de": " ({pixel_bytes} Bytes Pixel)",
        },
        {
            "en": " ({pixel_bytes} bytes of pixels, expected {needed_bytes})",
            "de": " ({pixel_bytes} Bytes Pixel, erwartet {needed_bytes})",
        },
    ),
    "images_where": (
        {
            "en": "the series",
            "de": "die Serie",
        },
        {
            "en": "the folder",
            "de": "der Ordner",
        },
    ),
    "identity_kind": (
        {
            "en": "patient IDs",
            "de": "Patienten-IDs",
        },
        {
            "en": "patient names",
            "de": "Patientennamen",
        },
        {
            "en": "dates of birth",
            "de": "Geburtsdaten",
        },
    ),
    "voxel_unit_guess": (
        NO_TEXT,
        {
            "en": "; they would be plausible in {length_unit}",
            "de": "; in {length_unit} wären sie plausibel",
        },
    ),
    "damage": (
        {
            "en": "it is missing",
            "de": "sie fehlt",
        },
        {
            "en": "its entry in the database was changed",
            "de": "ihr Eintrag in der Datenbank wurde verändert",
        },
        {
            "en": "its SHA-256 differs",
            "de": "ihr SHA-256 stimmt nicht",
        },
    ),
    "import_phrase": (
        NO_TEXT,
        {
            "en": " and imported by {importer}",
            "de": " und von {importer} importiert",
        },
    ),
    "document_problem": (
        {
            "en": "its file is damaged ({library_error})",
            "de": "die Datei ist beschädigt ({library_error})",
        },
        {
            "en": "the CT cannot be used: {volume_problem}",
            "de": "sein Inhalt ist ungültig: {volume_problem}",
        },
        {
            "en": "{count} values are invalid",
            "de": "{count} Werte sind ungültig",
        },
        {
            "en": "a pose is not a rigid motion: {rotation_problem}",
            "de": "eine Lage ist keine starre Bewegung: {rotation_problem}",
        },
        {
            "en": "it has {files} files, expected 1",
            "de": "es hat {files} Dateien, erwartet 1",
        },
    ),
    "excluded_hint": (
        NO_TEXT,
        {
            "en": ", only {excluded_list}",
            "de": ", nur {excluded_list}",
        },
    ),
    "excluded_list": (
        {
            "en": "{count} {excluded_kind}; {excluded_list}",
            "de": "{count} {excluded_kind}; {excluded_list}",
        },
        {
            "en": "{count} {excluded_kind}",
            "de": "{count} {excluded_kind}",
        },
    ),
    "nifti_problem": (
        {
            "en": "its header cannot be read",
            "de": "ihr Kopf ist nicht lesbar",
        },
        {
            "en": "it lacks a part of its {columns} x {rows} x {slices} voxels",
            "de": "ihr fehlt ein Teil ihrer {columns} x {rows} x {slices} Voxel",
        },
    ),
    "mesh_problem": (
        {
            "en": "it is empty",
            "de": "es ist leer",
        },
        {
            "en": "it has no lines of vertices (v) and faces (f)",
            "de": "es hat keine Zeilen mit Ecken (v) und Flächen (f)",
        },
        {
            "en": "it is neither text that begins with 'solid' nor binary",
            "de": "es ist weder Text, der mit „solid“ beginnt, noch binär",
        },
        {
            "en": "it declares {declared} triangles, which need {needed} bytes, but has {bytes}",
            "de": "es gibt {declared} Dreiecke an, die {needed} Bytes brauchen, hat aber {bytes}",
        },
        {
            "en": "it has no header",
            "de": "es hat keinen Kopf",
        },
        {
            "en": "its header is invalid",
            "de": "sein Kopf ist ungültig",
        },
        {
            "en": "its header declares at least {needed} bytes, but it has {bytes}",
            "de": "sein Kopf gibt mindestens {needed} Bytes an, es hat aber {bytes}",
        },
        {
            "en": "its vertices have shape {vertices} and its faces {faces}",
            "de": "die Ecken haben die Form {vertices} und die Flächen {faces}",
        },
        {
            "en": "a face names vertex {vertex}, there are {vertices}",
            "de": "eine Fläche nennt die Ecke {vertex}, es gibt {vertices}",
        },
        {
            "en": "a coordinate is not finite",
            "de": "eine Koordinate ist nicht endlich",
        },
        {
            "en": "a coordinate is above 1e9",
            "de": "eine Koordinate ist über 1e9",
        },
        {
            "en": "its vertices have shape {vertices}, needed (n, 3)",
            "de": "die Ecken haben die Form {vertices}, nötig (n, 3)",
        },
        {
            "en": "its faces have shape {faces}, needed (m, 3)",
            "de": "die Flächen haben die Form {faces}, nötig (m, 3)",
        },
    ),
    "fitting_units": (
        {
            "en": "in {mesh_unit} it is {sides} mm, the size of {mesh_kind}; {fitting_units}",
            "de": "in {mesh_unit} misst es {sides} mm, die Größe {mesh_kind}; {fitting_units}",
        },
        {
            "en": "in {mesh_unit} it is {sides} mm, the size of {mesh_kind}",
            "de": "in {mesh_unit} misst es {sides} mm, die Größe {mesh_kind}",
        },
    ),
    "mesh_kind": (
        {
            "en": "a vertebra",
            "de": "eines Wirbels",
        },
        {
            "en": "several vertebrae",
            "de": "mehrerer Wirbel",
        },
    ),
    "volume_problem": (
        {
            "en": "its array has shape {shape}, needed three dimensions of at least 2",
            "de": "sein Array hat die Form {shape}, nötig drei Dimensionen von mindestens 2",
        },
        {
            "en": "its values are {dtype}, needed int16",
            "de": "seine Werte sind {dtype}, nötig int16",
        },
        {
            "en": "its affine is not a (4, 4) matrix of finite numbers",
            "de": "seine Affine ist keine (4, 4)-Matrix endlicher Zahlen",
        },
        {
            "en": "the last row of its affine is not 0 0 0 1",
            "de": "die letzte Zeile seiner Affinen ist nicht 0 0 0 1",
        },
        {
            "en": "its affine is flat: two axes of the volume have the same direction, or one has no length",
            "de": "seine Affine ist flach: zwei Achsen des Volumens haben dieselbe Richtung, oder eine hat "
            "keine Länge",
        },
    ),
    "bone_problem": (
        {
            "en": "its threshold is {threshold_hu} HU",
            "de": "der Schwellwert ist {threshold_hu} HU",
        },
        {
            "en": "{rounds} rounds of smoothing, allowed 0 to 200",
            "de": "{rounds} Durchgänge der Glättung, erlaubt 0 bis 200",
        },
        {
            "en": "at most {faces} triangles, allowed 100 or more",
            "de": "höchstens {faces} Dreiecke, erlaubt 100 oder mehr",
        },
        {
            "en": "at most {voxels_allowed} voxels, allowed 1000 or more",
            "de": "höchstens {voxels_allowed} Voxel, erlaubt 1000 oder mehr",
        },
    ),
    "plan_place": (
        {
            "en": "plan",
            "de": "Plan",
        },
        {
            "en": "vertebra {vertebra}, {side} pedicle, {field}",
            "de": "Wirbel {vertebra}, Pedikel {side}, {field}",
        },
        {
            "en": "vertebra {vertebra}, {side} pedicle,",
            "de": "Wirbel {vertebra}, Pedikel {side},",
        },
        {
            "en": "vertebra {vertebra}, {side} channel,",
            "de": "Wirbel {vertebra}, Kanal {side},",
        },
        {
            "en": "vertebra {vertebra}, reference slice,",
            "de": "Wirbel {vertebra}, Referenzschicht,",
        },
        {
            "en": "vertebra {vertebra}, landmark {landmark},",
            "de": "Wirbel {vertebra}, Landmarke {landmark},",
        },
        {
            "en": "vertebra {vertebra}",
            "de": "Wirbel {vertebra}",
        },
    ),
    "plan_fault": (
        {
            "en": "is no mapping",
            "de": "ist keine Zuordnung",
        },
        {
            "en": "is no list",
            "de": "ist keine Liste",
        },
        {
            "en": "is not a finite number",
            "de": "ist keine endliche Zahl",
        },
        {
            "en": "is not a rectangular list of numbers",
            "de": "ist keine rechteckige Liste von Zahlen",
        },
        {
            "en": "contains a number that is not finite",
            "de": "enthält eine Zahl, die nicht endlich ist",
        },
        {
            "en": "has unknown keys {keys}",
            "de": "hat unbekannte Schlüssel {keys}",
        },
        {
            "en": "lacks {keys}",
            "de": "fehlt {keys}",
        },
        {
            "en": "cannot be read: {library_error}",
            "de": "ist nicht lesbar: {library_error}",
        },
        {
            "en": "is {given}, allowed are {allowed}",
            "de": "ist {given}, erlaubt sind {allowed}",
        },
        {
            "en": "is {given}, needed {needed}",
            "de": "ist {given}, nötig {needed}",
        },
        {
            "en": "has {count} vertebrae, allowed {allowed}",
            "de": "hat {count} Wirbel, erlaubt {allowed}",
        },
        {
            "en": "has a name of {letters} letters, allowed 1 to {allowed} printable ones without a slash, "
            "and more than dots",
            "de": "hat einen Namen aus {letters} Zeichen, erlaubt 1 bis {allowed} druckbare ohne "
            "Schrägstrich, und mehr als Punkte",
        },
        {
            "en": "has a name of {letters} letters, allowed 1 to {allowed} printable ones",
            "de": "hat einen Namen aus {letters} Zeichen, erlaubt 1 bis {allowed} druckbare",
        },
        {
            "en": "has {count} landmarks, allowed {allowed}",
            "de": "hat {count} Landmarken, erlaubt {allowed}",
        },
        {
            "en": "outline_lps_mm has shape {shape}, needed {low} to {high} points",
            "de": "outline_lps_mm hat die Form {shape}, nötig {low} bis {high} Punkte",
        },
        {
            "en": "axis_lps has length {length}, needed 1",
            "de": "axis_lps hat die Länge {length}, nötig 1",
        },
        {
            "en": "{measure} is {value}, allowed {low} to {high}",
            "de": "{measure} ist {value}, erlaubt {low} bis {high}",
        },
        {
            "en": "has more than {count} warnings, or one of more than {letters} letters",
            "de": "hat mehr als {count} Warnungen, oder eine mit mehr als {letters} Zeichen",
        },
        {
            "en": "is {length_mm} mm long with radius {radius_mm} mm, allowed {max_length_mm} and "
            "{max_radius_mm} mm",
            "de": "ist {length_mm} mm lang mit dem Radius {radius_mm} mm, erlaubt {max_length_mm} und "
            "{max_radius_mm} mm",
        },
        {
            "en": "has lines {lines}, needed middle, left and right",
            "de": "hat die Linien {lines}, nötig middle, left und right",
        },
        {
            "en": "has {count} paths, allowed 2",
            "de": "hat {count} Pfade, erlaubt 2",
        },
        {
            "en": "has shape {shape}, needed {needed}",
            "de": "hat die Form {shape}, nötig {needed}",
        },
        {
            "en": "contains {value}, allowed up to {allowed}",
            "de": "enthält {value}, erlaubt bis {allowed}",
        },
    ),
    "name_of": (
        {
            "en": "name",
            "de": "der Name",
        },
        {
            "en": "reason",
            "de": "der Grund",
        },
        {
            "en": "name of the case",
            "de": "der Name des Falls",
        },
        {
            "en": "name of a document",
            "de": "der Name eines Dokuments",
        },
        {
            "en": "name of the document",
            "de": "der Name des Dokuments",
        },
        {
            "en": "name of who makes it",
            "de": "der Name der ausführenden Person",
        },
        {
            "en": "name of who made it",
            "de": "der Name der ausführenden Person",
        },
        {
            "en": "name of the person who imports it",
            "de": "der Name der importierenden Person",
        },
        {
            "en": "name of the person who withdraws it",
            "de": "der Name der zurückziehenden Person",
        },
        {
            "en": "word of confirmation",
            "de": "das Wort zur Bestätigung",
        },
    ),
    "name_problem": (
        {
            "en": "has {letters} characters",
            "de": "hat {letters} Zeichen",
        },
        {
            "en": "has 0 visible characters",
            "de": "hat 0 sichtbare Zeichen",
        },
        {
            "en": "has control characters ({controls})",
            "de": "hat Steuerzeichen ({controls})",
        },
    ),
    "json_place": (
        NO_TEXT,
        {
            "en": "at {where} ",
            "de": "bei {where} ",
        },
    ),
    "json_problem": (
        {
            "en": "it is a {type}, not a mapping",
            "de": "es ist ein {type}, keine Zuordnung",
        },
        {
            "en": "it cannot be encoded ({library_error})",
            "de": "es lässt sich nicht kodieren ({library_error})",
        },
        {
            "en": "it is more than {levels} levels deep",
            "de": "es ist mehr als {levels} Ebenen tief",
        },
        {
            "en": "its key {key} is a {type}, not a text",
            "de": "sein Schlüssel {key} ist ein {type}, kein Text",
        },
        {
            "en": "it is {value}, which is no number",
            "de": "es ist {value}, das ist keine Zahl",
        },
        {
            "en": "it is a {type}",
            "de": "es ist ein {type}",
        },
    ),
    "archive_problem": (
        {
            "en": "it has {parts} parts, the maximum is {max_parts}",
            "de": "es hat {parts} Teile, höchstens {max_parts}",
        },
        {
            "en": "it has two parts of the same name",
            "de": "es hat zwei Teile mit demselben Namen",
        },
        {
            "en": "it unpacks to {unpacked_gb} GB, the maximum is {max_gb} GB",
            "de": "entpackt hat es {unpacked_gb} GB, höchstens {max_gb} GB",
        },
        {
            "en": "its part {part} is missing, so it is not a case",
            "de": "sein Teil {part} fehlt, es ist also kein Fall",
        },
        {
            "en": "its part {part} is missing",
            "de": "sein Teil {part} fehlt",
        },
        {
            "en": "its part {part} is larger than {max_mb} MB",
            "de": "sein Teil {part} ist größer als {max_mb} MB",
        },
        {
            "en": "its part {part} is not in its manifest",
            "de": "sein Teil {part} steht nicht in seinem Verzeichnis",
        },
        {
            "en": "its part {part} is damaged (its SHA-256 differs)",
            "de": "sein Teil {part} ist beschädigt (der SHA-256 stimmt nicht)",
        },
        {
            "en": "it is not a valid zip file (a part is outside of it)",
            "de": "es ist kein gültiges Zip (ein Teil liegt außerhalb)",
        },
        {
            "en": "it is not a valid zip file ({library_error})",
            "de": "es ist kein gültiges Zip ({library_error})",
        },
        {
            "en": "it cannot be read ({library_error})",
            "de": "es ist nicht lesbar ({library_error})",
        },
        {
            "en": "{part}: {key} is invalid ({library_error})",
            "de": "{part}: {key} ist ungültig ({library_error})",
        },
        {
            "en": "its part '{part}' does not belong to a case",
            "de": "sein Teil „{part}“ gehört nicht zu einem Fall",
        },
        {
            "en": "its part {part} is not valid JSON",
            "de": "sein Teil {part} ist kein gültiges JSON",
        },
        {
            "en": "its part {part} has {bytes} bytes, its manifest states {stated_bytes}",
            "de": "sein Teil {part} hat {bytes} Bytes, sein Verzeichnis gibt {stated_bytes} an",
        },
        {
            "en": "its part {part} is longer than its {bytes} bytes",
            "de": "sein Teil {part} ist länger als seine {bytes} Bytes",
        },
        {
            "en": "its files are not those listed in {part}",
            "de": "seine Dateien sind nicht die in {part} genannten",
        },
        {
            "en": "{part} ends inside a line",
            "de": "{part} endet mitten in einer Zeile",
        },
        {
            "en": "the name of the document {document} is not normalised",
            "de": "der Name des Dokuments {document} ist nicht normalisiert",
        },
        {
            "en": "it has two documents {document}",
            "de": "es hat das Dokument {document} zweimal",
        },
        {
            "en": "the document {document} has version {version}, but not version {before}",
            "de": "das Dokument {document} hat Version {version}, aber nicht Version {before}",
        },
        {
            "en": "the document {document} depends on {basis}, which does not precede it",
            "de": "das Dokument {document} hängt von {basis} ab, das ihm nicht vorausgeht",
        },
        {
            "en": "the document {document} has missing or duplicate files or dependencies",
            "de": "das Dokument {document} hat fehlende oder doppelte Dateien oder Abhängigkeiten",
        },
    ),
    "markup_problem": (
        {
            "en": "it has more than {max_mb} MB",
            "de": "sie hat mehr als {max_mb} MB",
        },
        {
            "en": "it has no list 'markups'",
            "de": "sie hat keine Liste „markups“",
        },
        {
            "en": "it has {count} markups, the maximum is {max_count}",
            "de": "sie hat {count} Markierungen, höchstens {max_count}",
        },
        {
            "en": "it is not valid JSON",
            "de": "sie ist kein gültiges JSON",
        },
        {
            "en": "the name of {markup} is not a text",
            "de": "der Name von {markup} ist kein Text",
        },
        {
            "en": "{markup} has the coordinate system {given}, expected LPS or RAS",
            "de": "{markup} hat das Koordinatensystem {given}, erwartet LPS oder RAS",
        },
        {
            "en": "{markup} has its coordinates in {given}, expected mm",
            "de": "{markup} hat seine Koordinaten in {given}, erwartet mm",
        },
        {
            "en": "the line {markup} has {count} control points, expected 2",
            "de": "die Linie {markup} hat {count} Kontrollpunkte, erwartet 2",
        },
        {
            "en": "{markup} has {count} control points, expected 1 to {max_count}",
            "de": "{markup} hat {count} Kontrollpunkte, erwartet 1 bis {max_count}",
        },
        {
            "en": "the label of {markup} is not a text",
            "de": "die Beschriftung von {markup} ist kein Text",
        },
        {
            "en": "{markup} is not placed (its positionStatus is {given})",
            "de": "{markup} ist nicht gesetzt (positionStatus ist {given})",
        },
        {
            "en": "{markup} has the position {given}, expected three numbers up to {max_mm} mm",
            "de": "{markup} hat den Ort {given}, erwartet drei Zahlen bis {max_mm} mm",
        },
        {
            "en": "markup {number} is not an object",
            "de": "Markierung {number} ist kein Objekt",
        },
        {
            "en": "{markup} is not an object",
            "de": "{markup} ist kein Objekt",
        },
    ),
    "markup": (
        {
            "en": "point {number} of {markup}",
            "de": "Punkt {number} von {markup}",
        },
        {
            "en": "markup {number}",
            "de": "Markierung {number}",
        },
        {
            "en": "'{name}'",
            "de": "„{name}“",
        },
    ),
    "transform_problem": (
        {
            "en": "it contains a {kind_name}, supported are {known} in three dimensions",
            "de": "sie enthält {kind_name}, unterstützt sind {known} in drei Dimensionen",
        },
        {
            "en": "its first line is not '{header}'",
            "de": "ihre erste Zeile ist nicht „{header}“",
        },
        {
            "en": "it is an HDF5 file (.h5)",
            "de": "sie ist eine HDF5-Datei (.h5)",
        },
        {
            "en": "its last line has no line end, as in a truncated file",
            "de": "ihre letzte Zeile hat kein Zeilenende, wie in einer abgeschnittenen Datei",
        },
        {
            "en": "it contains {count} transforms, expected 1",
            "de": "sie enthält {count} Transformationen, erwartet 1",
        },
        {
            "en": "it does not contain each of Transform, Parameters and FixedParameters once",
            "de": "sie enthält Transform, Parameters und FixedParameters nicht je einmal",
        },
        {
            "en": "its {kind_name} has {parameters} parameters and {fixed} fixed parameters, expected "
            "{expected} and 3",
            "de": "ihr {kind_name} hat {parameters} Parameter und {fixed} feste Parameter, erwartet "
            "{expected} und 3",
        },
        {
            "en": "its translation exceeds {max_mm} mm",
            "de": "ihre Verschiebung ist über {max_mm} mm",
        },
        {
            "en": "its {which} are not finite numbers",
            "de": "ihre {which} sind keine endlichen Zahlen",
        },
        {
            "en": "a pose is not a rigid motion: {rotation_problem}",
            "de": "sie ist keine starre Bewegung: {rotation_problem}",
        },
    ),
    "rotation_problem": (
        {
            "en": "its rotation deviates from orthonormal by {off}, allowed {allowed}, and all numbers "
            "must be finite",
            "de": "die Drehung weicht um {off} von orthonormal ab, erlaubt {allowed}, und alle Zahlen "
            "müssen endlich sein",
        },
    ),
    "excluded_kind": (
        {
            "en": "files that cannot be opened",
            "de": "nicht zu öffnende Dateien",
        },
        {
            "en": "not regular files",
            "de": "keine gewöhnlichen Dateien",
        },
        {
            "en": "empty files",
            "de": "leere Dateien",
        },
        {
            "en": "archives inside the archive",
            "de": "Archive im Archiv",
        },
        {
            "en": "truncated or damaged DICOM files",
            "de": "abgeschnittene oder beschädigte DICOM-Dateien",
        },
        {
            "en": "NIfTI files",
            "de": "NIfTI-Dateien",
        },
        {
            "en": "files that are not DICOM",
            "de": "Dateien, die kein DICOM sind",
        },
        {
            "en": "files that exceed the maximum size when unpacked",
            "de": "Dateien, die entpackt zu groß sind",
        },
        {
            "en": "files that declare more than {images} images",
            "de": "Dateien, die mehr als {images} Bilder angeben",
        },
        {
            "en": "multi-frame files without positions of their images",
            "de": "Multiframe-Dateien ohne Orte ihrer Bilder",
        },
        {
            "en": "DICOM files without an image",
            "de": "DICOM-Dateien ohne Bild",
        },
        {
            "en": "colour pictures (screens, reports)",
            "de": "Farbbilder (Bildschirme, Befunde)",
        },
        {
            "en": "localizers (scouts)",
            "de": "Übersichtsbilder (Scouts)",
        },
        {
            "en": "pictures of a screen (secondary captures)",
            "de": "Bilder eines Bildschirms (Secondary Captures)",
        },
    ),
    "gap_problem": (
        {
            "en": "the slices lie between {min_mm} and {max_mm} mm apart",
            "de": "die Schichten liegen zwischen {min_mm} und {max_mm} mm auseinander",
        },
        {
            "en": "the slices are shifted against each other within their planes",
            "de": "die Schichten sind in ihren Ebenen gegeneinander verschoben",
        },
    ),
}
