"""Remedies of warnings about completed work."""

from server.texts.language import Text

REMARKS: tuple[Text, ...] = (
    {
        "en": "Take 10 to 20 views; a few views determine the lens poorly.",
        "de": "10 bis 20 Ansichten aufnehmen; wenige Ansichten bestimmen das Objektiv schlecht.",
    },
    {
        "en": "Read the reasons: columns and rows of the board, blur, a bent board.",
        "de": "Die Gründe lesen: Spalten und Zeilen der Tafel, Unschärfe, eine verbogene Tafel.",
    },
    {
        "en": "Add views with the board tilted by 20 to 45 deg: else focal length is mixed with distance.",
        "de": "Ansichten mit um 20 bis 45° gekippter Tafel hinzufügen: sonst vermischen sich Brennweite und "
        "Abstand.",
    },
    {
        "en": "Add views from nearer and farther, over the distances at which you will work.",
        "de": "Nähere und weitere Ansichten hinzufügen, über die Abstände, in denen gearbeitet wird.",
    },
    {
        "en": "Add views with the board there: beyond its points the lens is extrapolated.",
        "de": "Ansichten mit der Tafel dort hinzufügen: jenseits ihrer Punkte wird das Objektiv "
        "extrapoliert.",
    },
    {
        "en": "Add views with the board tilted in other directions and filling the image.",
        "de": "Ansichten hinzufügen, in denen die Tafel in andere Richtungen gekippt ist und das Bild füllt.",
    },
    {
        "en": "Give images of one camera at one zoom and focus, and of a board that is flat and stiff.",
        "de": "Bilder einer einzigen Kamera mit einem Zoom und einem Fokus verwenden, von einer ebenen und "
        "steifen Tafel.",
    },
    {
        "en": "Count {board_points} again{count_hint}: the board seems to have {columns} x {rows}.",
        "de": "Noch einmal zählen ({board_points}{count_hint}): die Tafel hat offenbar {columns} x {rows}.",
    },
    {
        "en": "Make sure that this is the patient's CT.",
        "de": "Sicherstellen, dass dies das CT des Patienten ist.",
    },
    {
        "en": "Compare the levels with the CT.",
        "de": "Die Höhen mit dem CT vergleichen.",
    },
    {
        "en": "Plan only on complete bone, or scan a larger part of the patient.",
        "de": "Nur auf vollständigem Knochen planen, oder einen größeren Teil des Patienten aufnehmen.",
    },
    {
        "en": "Give a region around one vertebra: its voxels are few enough.",
        "de": "Einen Bereich um einen Wirbel angeben: er hat wenige genug Voxel.",
    },
    {
        "en": "Compare the surface with the slices before planning on it.",
        "de": "Die Oberfläche vor der Planung mit den Schichten vergleichen.",
    },
    {
        "en": "Make the surface again, from finer slices or with another threshold, or move the channel.",
        "de": "Die Oberfläche neu erzeugen, aus feineren Schichten oder mit anderer Schwelle, oder den Kanal "
        "verschieben.",
    },
    {
        "en": "Register with the surface of one vertebra, as vertebrae are not rigidly connected.",
        "de": "Mit der Oberfläche eines einzigen Wirbels registrieren, denn Wirbel sind nicht starr "
        "verbunden.",
    },
    {
        "en": "Fill its holes in the segmentation, or use it for display only.",
        "de": "Die Löcher in der Segmentierung füllen, oder das Netz nur zur Anzeige verwenden.",
    },
    {
        "en": "Check the surface before planning on it.",
        "de": "Die Oberfläche vor der Planung prüfen.",
    },
    {
        "en": "To use one bone only, export it alone.",
        "de": "Für einen einzigen Knochen diesen allein exportieren.",
    },
    {
        "en": "Check the isthmus on the slices.",
        "de": "Den Isthmus auf den Schichten prüfen.",
    },
    {
        "en": "Use finer slices if available.",
        "de": "Feinere Schichten verwenden, wenn vorhanden.",
    },
    {
        "en": "Check the axis on the slices.",
        "de": "Die Achse auf den Schichten prüfen.",
    },
    {
        "en": "Check that the click lies in a pedicle.",
        "de": "Prüfen, ob der Klick in einem Pedikel liegt.",
    },
    {
        "en": "Check the length on the slices.",
        "de": "Die Länge auf den Schichten prüfen.",
    },
    {
        "en": "Check the side.",
        "de": "Die Seite prüfen.",
    },
    {
        "en": "Add a landmark far from the others, and check on one that was not used.",
        "de": "Eine Landmarke weit von den anderen hinzufügen, und an einer nicht verwendeten prüfen.",
    },
    {
        "en": "Check on a landmark that was not used, on one side; or add one that makes the sides differ.",
        "de": "An einer nicht verwendeten Landmarke auf einer Seite prüfen; oder eine hinzufügen, durch die "
        "sich die Seiten unterscheiden.",
    },
    {
        "en": "Measure the printed marker's side again and check the camera with 'coaxial accuracy'.",
        "de": "Die Seite des gedruckten Markers noch einmal messen und die Kamera mit "
        "„coaxial accuracy“ prüfen.",
    },
    {
        "en": "Sweep surfaces with other normals too, such as the flanks of the spinous process.",
        "de": "Auch Flächen mit anderen Normalen abfahren, etwa die Flanken des Dornfortsatzes.",
    },
)
