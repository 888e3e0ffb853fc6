"""Remedies of errors of cases, documents and files."""

from server.texts.language import Text

CASES: tuple[Text, ...] = (
    {
        "en": "Wait until they are done, or cancel them, then try again.",
        "de": "Das Ende dieser Vorgänge abwarten, oder sie abbrechen, dann erneut versuchen.",
    },
    {"en": "Create the {kind} first.", "de": "Dieses Dokument zuerst erstellen: {kind}."},
    {"en": "Create the {kind} again.", "de": "Dieses Dokument neu erstellen: {kind}."},
    {
        "en": "GET /api/cases lists the cases; this one may have been deleted.",
        "de": "GET /api/cases nennt die Fälle; dieser wurde vielleicht gelöscht.",
    },
    {"en": "Close it first.", "de": "Ihn zuerst schließen."},
    {
        "en": "Enter the name of the case exactly as in the list; nothing was deleted.",
        "de": "Den Namen des Falls genau wie in der Liste eingeben; nichts wurde gelöscht.",
    },
    {
        "en": "Load the newest version, and apply the change to it again.",
        "de": "Die neueste Version laden und die Änderung an ihr wiederholen.",
    },
    {
        "en": "GET /api/cases/{case_id}/files lists the files of the case.",
        "de": "GET /api/cases/{case_id}/files nennt die Dateien des Falls.",
    },
    {
        "en": "GET /api/cases/{case_id}/documents lists the documents of the case.",
        "de": "GET /api/cases/{case_id}/documents nennt die Dokumente des Falls.",
    },
    {
        "en": "Import it with the Coaxial that exported it, or a newer one; nothing of it was stored.",
        "de": "Mit dem Coaxial importieren, das es exportierte, oder einem neueren; nichts davon wurde "
        "gespeichert.",
    },
    {
        "en": "Give a folder or zip of DICOM slices, a multi-frame DICOM file, or a NIfTI file.",
        "de": "Einen Ordner oder ein Zip mit DICOM-Schichten angeben, eine Multiframe-DICOM-Datei oder eine "
        "NIfTI-Datei.",
    },
    {"en": "Copy or upload the archive again.", "de": "Das Archiv neu kopieren oder hochladen."},
    {
        "en": "Give a folder that contains only this series.",
        "de": "Einen Ordner angeben, der nur diese Serie enthält.",
    },
    {
        "en": "Create the archive again from the folder of slices; do not use one from an unknown source.",
        "de": "Das Archiv aus dem Ordner der Schichten neu erstellen; keines aus unbekannter Quelle "
        "verwenden.",
    },
    {
        "en": "Unpack it with its password, and give the folder or a zip without one.",
        "de": "Es mit seinem Passwort entpacken, und den Ordner oder ein Zip ohne Passwort angeben.",
    },
    {
        "en": "Give a zip that contains only this series.",
        "de": "Ein Zip angeben, das nur diese Serie enthält.",
    },
    {
        "en": "Export one pass as a separate series, and give only that series.",
        "de": "Einen Durchlauf als eigene Serie exportieren und nur diese angeben.",
    },
    {
        "en": "Copy or export the series again; a damaged slice cannot be repaired.",
        "de": "Die Serie neu kopieren oder exportieren; eine beschädigte Schicht lässt sich nicht "
        "reparieren.",
    },
    {"en": "Copy or convert the file again.", "de": "Die Datei neu kopieren oder umwandeln."},
    {"en": "Export the whole series again.", "de": "Die ganze Serie neu exportieren."},
    {
        "en": "Convert it into a single .nii or .nii.gz.",
        "de": "In ein einzelnes .nii oder .nii.gz umwandeln.",
    },
    {
        "en": "Export it with fewer triangles; 60000 are enough for a vertebra.",
        "de": "Mit weniger Dreiecken exportieren; 60000 genügen für einen Wirbel.",
    },
    {
        "en": "Export it with fewer triangles, or as binary STL or PLY.",
        "de": "Mit weniger Dreiecken exportieren, oder als binäres STL oder PLY.",
    },
    {
        "en": "Export the series again with its geometry; pictures of slices are not usable for planning.",
        "de": "Die Serie mit ihrer Geometrie neu exportieren; Bilder von Schichten eignen sich nicht zur "
        "Planung.",
    },
    {"en": "Give the original CT.", "de": "Das ursprüngliche CT angeben."},
    {
        "en": "Export the original CT series again, in Hounsfield units.",
        "de": "Die ursprüngliche CT-Serie neu exportieren, in Hounsfield-Einheiten.",
    },
    {
        "en": "Export only the part around the vertebrae, or a series with fewer pixels.",
        "de": "Nur den Teil um die Wirbel exportieren, oder eine Serie mit weniger Pixeln.",
    },
    {
        "en": "Copy or export the series again; a truncated slice cannot be repaired.",
        "de": "Die Serie neu kopieren oder exportieren; eine abgeschnittene Schicht lässt sich nicht "
        "reparieren.",
    },
    {
        "en": "Export the series again uncompressed, or with lossless JPEG 2000, JPEG-LS, JPEG or RLE.",
        "de": "Die Serie neu exportieren, unkomprimiert oder verlustfrei mit JPEG 2000, JPEG-LS, JPEG "
        "oder RLE.",
    },
    {
        "en": "Put what is large into a file of the case, and its name into the document.",
        "de": "Große Daten in einer Datei des Falls speichern und deren Namen in das Dokument schreiben.",
    },
    {
        "en": "Give a suffix such as .npy or .nii.gz, of lower-case letters and digits.",
        "de": "Eine Endung wie .npy oder .nii.gz angeben, aus Kleinbuchstaben und Ziffern.",
    },
    {"en": "Attach the file to another document.", "de": "Die Datei an ein anderes Dokument anhängen."},
    {
        "en": "Remove it from the dependencies of the document.",
        "de": "Die Identität aus den Abhängigkeiten des Dokuments entfernen.",
    },
    {
        "en": "Stop the other one, or set COAXIAL_HOME to another folder.",
        "de": "Das andere Coaxial beenden, oder COAXIAL_HOME auf einen anderen Ordner setzen.",
    },
    {
        "en": "Check its read permission.",
        "de": "Die Leserechte prüfen.",
    },
    {
        "en": "Export the original CT series again.",
        "de": "Die originale CT-Serie neu exportieren.",
    },
    {
        "en": "Export the CT series in Hounsfield units (not iodine, density or effective atomic number).",
        "de": "Die CT-Serie in Hounsfield-Einheiten exportieren (nicht Jod, Dichte oder effektive "
        "Ordnungszahl).",
    },
    {
        "en": "Give a CT; MR, PET and others have no Hounsfield units.",
        "de": "Ein CT angeben; MR, PET und andere haben keine Hounsfield-Einheiten.",
    },
    {
        "en": "Select the series for planning: {identifiers}.",
        "de": "Die Serie für die Planung wählen: {identifiers}.",
    },
    {
        "en": "Give the identifier of one of them: {identifiers}.",
        "de": "Die Kennung von einer angeben: {identifiers}.",
    },
    {
        "en": "Give a folder with the images of one patient only.",
        "de": "Einen Ordner mit Bildern nur eines Patienten angeben.",
    },
    {
        "en": "Export one volume of the CT; a time series contains several.",
        "de": "Ein Volumen des CT exportieren; eine Zeitserie enthält mehrere.",
    },
    {
        "en": "Convert or export the CT again as NIfTI, or give its DICOM slices.",
        "de": "Das CT neu in NIfTI umwandeln oder exportieren, oder seine DICOM-Schichten angeben.",
    },
    {
        "en": "Export the bone surface again as triangles in STL, OBJ or PLY.",
        "de": "Die Knochenoberfläche neu als Dreiecke in STL, OBJ oder PLY exportieren.",
    },
    {
        "en": "Export the bone's surface again as triangles in STL, OBJ or PLY.",
        "de": "Die Knochenoberfläche neu als Dreiecke in STL, OBJ oder PLY exportieren.",
    },
    {
        "en": "Give one of {units}.",
        "de": "Eine von {units} angeben.",
    },
    {
        "en": "Do its step again, or open the list of documents and go on with the version before it. Then "
        "check the disk.",
        "de": "Seinen Schritt wiederholen oder in der Liste der Dokumente mit der Version davor "
        "weiterarbeiten. Dann die Platte prüfen.",
    },
    {
        "en": "Check which case it is, and give it its name again. Then check the disk.",
        "de": "Prüfen, welcher Fall es ist, und ihm seinen Namen noch einmal geben. Dann die Platte prüfen.",
    },
    {
        "en": "Load the list of documents again.",
        "de": "Die Liste der Dokumente neu laden.",
    },
    {
        "en": "Restore the file from a copy; steps that need it are not possible until then.",
        "de": "Die Datei aus einer Kopie wiederherstellen; bis dahin sind Schritte, die sie brauchen, "
        "nicht möglich.",
    },
    {
        "en": "Set COAXIAL_HOME to a folder on a disk of this computer.",
        "de": "COAXIAL_HOME auf einen Ordner auf einer Platte dieses Computers setzen.",
    },
    {
        "en": "Start the version of Coaxial that made it, or set COAXIAL_HOME to another folder.",
        "de": "Die Version von Coaxial starten, die sie erstellte, oder COAXIAL_HOME auf einen anderen "
        "Ordner setzen.",
    },
    {
        "en": "Give a folder or zip of the CT's DICOM slices, or a NIfTI file.",
        "de": "Einen Ordner oder ein Zip mit den DICOM-Schichten des CT angeben, oder eine NIfTI-Datei.",
    },
    {
        "en": "Upload the CT again.",
        "de": "Das CT neu hochladen.",
    },
    {
        "en": "Its size is implausible in any unit: export one vertebra only, with its unit.",
        "de": "Seine Größe ist in keiner Einheit plausibel: nur einen Wirbel exportieren, mit seiner "
        "Einheit.",
    },
    {
        "en": "Measure it and give its unit: {fitting_units}.",
        "de": "Es nachmessen und seine Einheit angeben: {fitting_units}.",
    },
    {
        "en": "Export the surface again as triangles, in mm of the patient's coordinates.",
        "de": "Die Oberfläche neu als Dreiecke exportieren, in mm der Patientenkoordinaten.",
    },
    {
        "en": "Export the series again as DICOM or NIfTI with its geometry, at least two slices.",
        "de": "Die Serie neu als DICOM oder NIfTI mit ihrer Geometrie exportieren, mindestens zwei "
        "Schichten.",
    },
    {
        "en": "Give a threshold in HU, 0 to 200 rounds of smoothing, and 100 triangles or more.",
        "de": "Einen Schwellwert in HU angeben, 0 bis 200 Durchgänge der Glättung, und 100 Dreiecke oder "
        "mehr.",
    },
    {
        "en": "Export the plan again.",
        "de": "Den Plan neu exportieren.",
    },
    {
        "en": "Give another one.",
        "de": "Eine andere Angabe machen.",
    },
    {
        "en": "Give texts, finite numbers, true, false, null, and lists and mappings of them.",
        "de": "Texte, endliche Zahlen, true, false, null, und Listen und Zuordnungen davon angeben.",
    },
    {
        "en": "Export the case again on its server; nothing of this archive was stored.",
        "de": "Den Fall auf seinem Server neu exportieren; von diesem Archiv wurde nichts gespeichert.",
    },
    {
        "en": "The next request starts another attempt.",
        "de": "Die nächste Anfrage beginnt einen neuen Versuch.",
    },
    {
        "en": "Save the markup in 3D Slicer again, as Markups JSON (.mrk.json).",
        "de": "Die Markierung in 3D Slicer neu speichern, als Markups JSON (.mrk.json).",
    },
    {
        "en": "Save one linear transform without scale as text (.tfm), not a composite, a deformation or "
        "HDF5 (.h5).",
        "de": "Eine lineare Transformation ohne Skalierung als Text (.tfm) speichern, keine "
        "zusammengesetzte, keine Deformation und kein HDF5 (.h5).",
    },
)
