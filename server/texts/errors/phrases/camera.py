"""Phrases in errors of camera, calibration and image source."""

from collections.abc import Mapping

from server.texts.errors.phrases.system import SYSTEM_ERRORS
from server.texts.language import NO_TEXT, Text

_BOARD_PROBLEMS: tuple[Text, ...] = (
    {
        "en": "no dots that stand in a grid",
        "de": "keine Punkte, die ein Raster bilden",
    },
    {
        "en": "{dots} dots stand in a grid, at least {needed} are needed",
        "de": "{dots} Punkte bilden ein Raster, nötig mindestens {needed}",
    },
    {
        "en": "{spots} spots stand in a grid, and they are square and not round",
        "de": "{spots} Flecken bilden ein Raster, sie sind aber eckig und nicht rund",
    },
    {
        "en": "a grid of {wide} x {high} steps, and the board has {columns} x {rows}",
        "de": "ein Raster von {wide} x {high} Schritten, die Tafel hat {columns} x {rows}",
    },
    {
        "en": "{larger} larger dots are seen, and {misfits} dots differ in size from the board with "
        "larger dots {fiducials}",
        "de": "{larger} größere Punkte sind zu sehen, und {misfits} Punkte haben eine andere Größe als "
        "auf der Tafel mit den größeren Punkten {fiducials}",
    },
    {
        "en": "{tags} tags of {dictionary} are read, and {complete} have all of their corners between "
        "squares, at least {needed} are needed",
        "de": "{tags} Tags aus {dictionary} sind lesbar, bei {complete} liegen alle Ecken zwischen "
        "Quadraten, nötig mindestens {needed}",
    },
    {
        "en": "{codes} markers of {dictionary} and {corners} corners between them are seen, at least "
        "{needed} corners are needed",
        "de": "{codes} Marker aus {dictionary} und {corners} Ecken dazwischen sind zu sehen, nötig "
        "mindestens {needed} Ecken",
    },
    {
        "en": "{corners} corners of squares stand in a grid, at least {needed} are needed",
        "de": "{corners} Ecken von Quadraten bilden ein Raster, nötig mindestens {needed}",
    },
    {
        "en": "{corners} corners where dark and light take turns, at least {needed} are needed",
        "de": "{corners} Ecken, an denen dunkel und hell abwechseln, nötig mindestens {needed}",
    },
    {
        "en": "dark and light take turns at {percent} % of {corners} corners in a grid, needed {needed} %",
        "de": "dunkel und hell wechseln an {percent} % von {corners} Ecken eines Rasters ab, nötig "
        "{needed} %",
    },
    {
        "en": "a grid of {wide} x {high} corners, and the board has {columns} x {rows}",
        "de": "ein Raster von {wide} x {high} Ecken, die Tafel hat {columns} x {rows}",
    },
    {
        "en": "{corners} corners stand in a grid, and dark and light do not take turns at {misfits} of them",
        "de": "{corners} Ecken bilden ein Raster, aber an {misfits} davon wechseln dunkel und hell nicht ab",
    },
)
_CORNERS: tuple[Text, ...] = (
    {
        "en": "top left",
        "de": "oben links",
    },
    {
        "en": "top right",
        "de": "oben rechts",
    },
    {
        "en": "bottom left",
        "de": "unten links",
    },
    {
        "en": "bottom right",
        "de": "unten rechts",
    },
)

CAMERA: Mapping[str, tuple[Text, ...]] = {
    "focus_phrase": (
        {
            "en": "is automatic",
            "de": "ist automatisch",
        },
        {
            "en": "cannot be locked or read in its browser",
            "de": "lässt sich in seinem Browser weder feststellen noch auslesen",
        },
    ),
    "skip_phrase": (
        {
            "en": "{skipped_images} of {images} images were not shown on this page",
            "de": "{skipped_images} von {images} Bildern wurden auf dieser Seite nicht gezeigt",
        },
        {
            "en": "{unprocessed_images} of {shown_images} images on this page were not searched for a code",
            "de": "in {unprocessed_images} von {shown_images} Bildern auf dieser Seite wurde kein Code "
            "gesucht",
        },
    ),
    "board_problem": _BOARD_PROBLEMS,
    "fault_hint": (
        NO_TEXT,
        {
            "en": " (the first that cannot: {view_fault})",
            "de": " (die erste unbrauchbare: {view_fault})",
        },
    ),
    "view_fault": (
        {
            "en": "{points} points, at least {needed} are needed",
            "de": "{points} Punkte, nötig mindestens {needed}",
        },
        {
            "en": "{points} points lie outside of the image",
            "de": "{points} Punkte liegen außerhalb des Bildes",
        },
        {
            "en": "all points lie on one line",
            "de": "alle Punkte liegen auf einer Geraden",
        },
        {
            "en": "its points are not the image of a flat board",
            "de": "ihre Punkte sind nicht das Bild einer ebenen Tafel",
        },
        {
            "en": "the order of its points is wrong: they lie {steps} steps of the grid off a flat board "
            "(RMS)",
            "de": "die Reihenfolge ihrer Punkte ist falsch: sie weichen um {steps} Rasterschritte von "
            "einer ebenen Tafel ab (RMS)",
        },
        {
            "en": "the order of its points is wrong: they are mirrored, as if the board were seen from "
            "behind",
            "de": "die Reihenfolge ihrer Punkte ist falsch: sie sind gespiegelt, als wäre die Tafel von "
            "hinten zu sehen",
        },
    ),
    "plane_problem": (
        {
            "en": "{points} points were seen, needed {needed}",
            "de": "{points} Punkte waren zu sehen, nötig {needed}",
        },
        {
            "en": "it has {points} points beside those measured, needed {needed}",
            "de": "sie hat {points} Punkte neben den gemessenen, nötig {needed}",
        },
        {
            "en": "the points beside those measured lie on one line",
            "de": "die Punkte neben den gemessenen liegen auf einer Geraden",
        },
        {
            "en": "no pose of the plane fits its points",
            "de": "keine Lage der Ebene passt zu ihren Punkten",
        },
        {
            "en": "a measured point is not seen on it",
            "de": "ein gemessener Punkt ist nicht auf ihr zu sehen",
        },
    ),
    "board_fault": (
        {
            "en": "{columns} x {rows}, which is {points} points, allowed {low} to {high}",
            "de": "{columns} x {rows}, das sind {points} Punkte, erlaubt {low} bis {high}",
        },
        {
            "en": "{length} {mm}, allowed above 0 to 10000",
            "de": "{length} {mm}, erlaubt über 0 bis 10000",
        },
        {
            "en": "larger dots {fiducials} of {count} dots, allowed indexes 0 to {last}",
            "de": "größere Punkte {fiducials} von {count} Punkten, erlaubt die Nummern 0 bis {last}",
        },
        {
            "en": "a marker of {marker_mm} mm in a square of {square_mm} mm",
            "de": "ein Marker von {marker_mm} mm in einem Quadrat von {square_mm} mm",
        },
        {
            "en": "the dictionary '{dictionary}', allowed {allowed}",
            "de": "das Wörterbuch „{dictionary}“, erlaubt {allowed}",
        },
        {
            "en": "{needed} markers, and {dictionary} has {available}",
            "de": "{needed} Marker, {dictionary} hat {available}",
        },
        {
            "en": "a gap of {gap_mm} mm between tags of {tag_mm} mm",
            "de": "ein Abstand von {gap_mm} mm zwischen Tags von {tag_mm} mm",
        },
        {
            "en": "{needed} tags, and {dictionary} has {available}",
            "de": "{needed} Tags, {dictionary} hat {available}",
        },
    ),
    "displacement_problem": (
        {
            "en": "their shapes are {shapes}, needed (n, 2) alike",
            "de": "ihre Formen sind {shapes}, nötig einheitlich (n, 2)",
        },
        {
            "en": "there is none",
            "de": "es gibt keine",
        },
        {
            "en": "a coordinate is not finite",
            "de": "eine Koordinate ist nicht endlich",
        },
        {
            "en": "number {number} is 0 mm long",
            "de": "Nummer {number} ist 0 mm lang",
        },
    ),
    "camera_problem": (
        {
            "en": "its matrix has shape {shape}, needed (3, 3)",
            "de": "seine Matrix hat die Form {shape}, nötig (3, 3)",
        },
        {
            "en": "it has {coefficients} distortion coefficients, allowed {allowed}",
            "de": "es hat {coefficients} Verzeichnungskoeffizienten, erlaubt {allowed}",
        },
        {
            "en": "a number is not finite",
            "de": "eine Zahl ist nicht endlich",
        },
        {
            "en": "its image size is {size} px, needed two whole numbers",
            "de": "seine Bildgröße ist {size} px, nötig zwei ganze Zahlen",
        },
        {
            "en": "its image size is {size} px, at least 16x16",
            "de": "seine Bildgröße ist {size} px, mindestens 16x16",
        },
        {
            "en": "its focal lengths are {fx} and {fy} px, needed above 0",
            "de": "seine Brennweiten sind {fx} und {fy} px, nötig über 0",
        },
        {
            "en": "its focal lengths are {fx} and {fy} px, needed at least {min_px} px for {size} px",
            "de": "seine Brennweiten sind {fx} und {fy} px, nötig mindestens {min_px} px bei {size} px",
        },
        {
            "en": "its matrix is not [[fx, 0, cx], [0, fy, cy], [0, 0, 1]]",
            "de": "seine Matrix ist nicht [[fx, 0, cx], [0, fy, cy], [0, 0, 1]]",
        },
        {
            "en": "its principal point is ({u}, {v}) px, {sizes} image sizes from the middle of {size} px, "
            "outside of the image",
            "de": "sein Hauptpunkt ist ({u}, {v}) px, {sizes} Bildgrößen von der Mitte von {size} px, "
            "außerhalb des Bildes",
        },
        {
            "en": "its focal lengths are {fx} and {fy} px, a ratio of {ratio}, allowed {allowed}",
            "de": "seine Brennweiten sind {fx} und {fy} px, ein Verhältnis von {ratio}, erlaubt {allowed}",
        },
        {
            "en": "with focal lengths of {fx} and {fy} px an image of {size} px shows {field_deg} deg "
            "between opposite corners, needed {needed_deg} deg",
            "de": "mit Brennweiten von {fx} und {fy} px zeigt ein Bild von {size} px {field_deg}° zwischen "
            "gegenüberliegenden Ecken, nötig {needed_deg}°",
        },
        {
            "en": "its sensor tilts by {tilt_deg} deg, allowed {allowed_deg} deg",
            "de": "sein Sensor ist um {tilt_deg}° geneigt, erlaubt {allowed_deg}°",
        },
        {
            "en": "its distortion {distortion_fault}, at {angle_deg} deg from its axis, inside of the image",
            "de": "seine Verzeichnung {distortion_fault}, {angle_deg}° von seiner Achse, innerhalb des "
            "Bildes",
        },
        {
            "en": "it sees farther than {angle_deg} deg from its axis, where this image should end: that "
            "is ({u}, {v}) px, inside of {size} px",
            "de": "es sieht weiter als {angle_deg}° von seiner Achse, wo dieses Bild enden sollte: das ist "
            "({u}, {v}) px, innerhalb von {size} px",
        },
        {
            "en": "its distortion cannot be removed at ({u}, {v}) px: removed and applied again it leaves "
            "{off_px} px, allowed {allowed_px} px",
            "de": "seine Verzeichnung lässt sich bei ({u}, {v}) px nicht entfernen: entfernt und neu "
            "angewendet bleiben {off_px} px, erlaubt {allowed_px} px",
        },
    ),
    "distortion_fault": (
        {
            "en": "folds the image",
            "de": "faltet das Bild",
        },
        {
            "en": "leaves {scale} of the scale at its axis, needed {needed}",
            "de": "lässt {scale} des Maßstabs an seiner Achse, nötig {needed}",
        },
        {
            "en": "stretches the image {factor} times, allowed {allowed}",
            "de": "streckt das Bild {factor}-fach, erlaubt {allowed}",
        },
    ),
    "readout_estimate": (
        {
            "en": "readout {readout_ms} ms, standard deviation {sd_ms} ms",
            "de": "Auslesezeit {readout_ms} ms, Standardabweichung {sd_ms} ms",
        },
    ),
    "ruler_problem": (
        {
            "en": "{ruler_length} is {value} {unit}, needed above 0",
            "de": "{ruler_length} beträgt {value} {unit}, nötig über 0",
        },
        {
            "en": "the {ruler_axis} distance is {value} mm, needed 0 or more",
            "de": "der {ruler_axis} Abstand beträgt {value} mm, nötig 0 oder mehr",
        },
    ),
    "ruler_length": (
        {
            "en": "the displacement",
            "de": "die Verschiebung",
        },
        {
            "en": "the displacement in the image",
            "de": "die Verschiebung im Bild",
        },
    ),
    "ruler_axis": (
        {
            "en": "vertical",
            "de": "vertikale",
        },
        {
            "en": "horizontal",
            "de": "horizontale",
        },
    ),
    "image_problem": (
        {
            "en": "its {bytes} bytes are not an image, or a damaged one",
            "de": "seine {bytes} Bytes sind kein Bild, oder ein beschädigtes",
        },
        {
            "en": "it cannot be read",
            "de": "es ist nicht lesbar",
        },
        *SYSTEM_ERRORS,
    ),
    "unusable_images": (
        {
            "en": "{file} ({image_problem}), {unusable_images}",
            "de": "{file} ({image_problem}), {unusable_images}",
        },
        {
            "en": "{file} ({image_problem})",
            "de": "{file} ({image_problem})",
        },
    ),
    "more_images": (
        NO_TEXT,
        {
            "en": " and {count} more",
            "de": " und {count} weitere",
        },
    ),
    "source_problem": (
        {
            "en": "it does not exist",
            "de": "sie existiert nicht",
        },
        {
            "en": "it is a pipe, a socket or a device, not a file",
            "de": "sie ist eine Pipe, ein Socket oder ein Gerät, keine Datei",
        },
        {
            "en": "it is empty (0 bytes)",
            "de": "sie ist leer (0 Bytes)",
        },
        {
            "en": "it cannot be read",
            "de": "sie ist nicht lesbar",
        },
        *SYSTEM_ERRORS,
    ),
    "video_problem": (
        {
            "en": "it is not open",
            "de": "sie ist nicht geöffnet",
        },
        {
            "en": "it cannot be decoded as video",
            "de": "sie lässt sich nicht als Video dekodieren",
        },
        {
            "en": "it has no image that can be decoded",
            "de": "sie hat kein dekodierbares Bild",
        },
    ),
    "stream_problem": (
        {
            "en": "no answer within {limit_s} s",
            "de": "keine Antwort innerhalb von {limit_s} s",
        },
        *SYSTEM_ERRORS,
    ),
    "plugin_problem": (
        {
            "en": "cannot be opened",
            "de": "lässt sich nicht öffnen",
        },
        {
            "en": "returned no image",
            "de": "lieferte kein Bild",
        },
    ),
    "code_count": (
        {
            "en": "the code was read in {read} of {images} images",
            "de": "der Code war in {read} von {images} Bildern lesbar",
        },
        {
            "en": "{timed} of {codes} codes could be timed",
            "de": "von {codes} Codes ließ sich bei {timed} die Zeit messen",
        },
    ),
    "image_subject": (
        {
            "en": "images are",
            "de": "Bilder haben",
        },
        {
            "en": "{image} is",
            "de": "{image} hat",
        },
    ),
    "omit_hint": (
        NO_TEXT,
        {
            "en": "Omit the image if it is from another camera. ",
            "de": "Das Bild weglassen, wenn es von einer anderen Kamera ist. ",
        },
    ),
    "scaling_hint": (
        {
            "en": "If both sizes show the same field of view, set camera.same_sensor_area, and the "
            "calibration is scaled.",
            "de": "Zeigen beide Größen dasselbe Bildfeld, camera.same_sensor_area setzen, dann wird die "
            "Kalibrierung skaliert.",
        },
        {
            "en": "It is never scaled to another aspect ratio, because the field of view differs.",
            "de": "Auf ein anderes Seitenverhältnis wird sie nie skaliert, weil das Bildfeld ein anderes "
            "ist.",
        },
    ),
    "marker_problem": (
        {
            "en": "it is {dtype} with {dimensions} dimensions, needed uint8 grey (h, w)",
            "de": "es ist {dtype} mit {dimensions} Dimensionen, nötig uint8 grau (h, w)",
        },
        {
            "en": "it is {width}x{height} px, at least {min_side}x{min_side}",
            "de": "es hat {width}x{height} px, mindestens {min_side}x{min_side}",
        },
        {
            "en": "it is {width}x{height} px, and a square may differ by {percent}",
            "de": "es hat {width}x{height} px, und ein Quadrat darf um {percent} abweichen",
        },
        {
            "en": "its contrast is {contrast} grey levels, at least {min_contrast}",
            "de": "sein Kontrast ist {contrast} Graustufen, mindestens {min_contrast}",
        },
        {
            "en": "{dark} of its border is dark, at least {min_dark}",
            "de": "{dark} seines Randes sind dunkel, mindestens {min_dark}",
        },
    ),
    "allowed_values": (
        {
            "en": "a number from 0 (none) to {high} (very hard)",
            "de": "eine Zahl von 0 (keine) bis {high} (sehr stark)",
        },
        {
            "en": "a whole number from {low} to {high}",
            "de": "eine ganze Zahl von {low} bis {high}",
        },
        {
            "en": "a number from 0 to {high}",
            "de": "eine Zahl von 0 bis {high}",
        },
        {
            "en": "a number above 0",
            "de": "eine Zahl über 0",
        },
        {
            "en": "sides from {low} to {high} px",
            "de": "Seiten von {low} bis {high} px",
        },
        {
            "en": "seconds from {low} to {high}",
            "de": "Sekunden von {low} bis {high}",
        },
    ),
    "collection_message": (
        {
            "en": "taken",
            "de": "aufgenommen",
        },
        {
            "en": "too small a part of the board is visible",
            "de": "ein zu kleiner Teil der Tafel ist sichtbar",
        },
        {
            "en": "board found: hold it still",
            "de": "Tafel gefunden: ruhig halten",
        },
        {
            "en": "the board is moving: hold it still",
            "de": "die Tafel bewegt sich: ruhig halten",
        },
        {
            "en": "a similar view has already been taken: move or tilt the board",
            "de": "eine ähnliche Ansicht ist schon aufgenommen: die Tafel bewegen oder neigen",
        },
        {
            "en": "there is no image",
            "de": "es gibt kein Bild",
        },
        {
            "en": "there is no image: the source has ended",
            "de": "es gibt kein Bild: die Quelle ist zu Ende",
        },
        *_BOARD_PROBLEMS,
    ),
    "view_advice": (
        {
            "en": "Show the board to the camera.",
            "de": "Die Tafel der Kamera zeigen.",
        },
        {
            "en": "Hold the board into the {image_corners} of the image.",
            "de": "Die Tafel in diese Ecken des Bildes halten: {image_corners}.",
        },
        {
            "en": "The board was in {covered} of the image, needed {needed}: move it along the rim.",
            "de": "Die Tafel war in {covered} des Bildes, nötig {needed}: sie am Rand entlang bewegen.",
        },
        {
            "en": "Tilt the board by {tilt_deg} degrees or more, {tilt_way} ({reached_deg} so far).",
            "de": "Die Tafel um {tilt_deg}° oder mehr neigen, {tilt_way} (bisher {reached_deg}°).",
        },
        {
            "en": "{views} of {needed} views: hold it still in more places and tilts.",
            "de": "{views} von {needed} Ansichten: sie an weiteren Orten und mit weiteren Neigungen ruhig "
            "halten.",
        },
    ),
    "image_corners": (
        {
            "en": "{image_corner}, {image_corners}",
            "de": "{image_corner}, {image_corners}",
        },
        *_CORNERS,
    ),
    "image_corner": (*_CORNERS,),
    "tilt_way": (
        {
            "en": "its upper edge away from you",
            "de": "die Oberkante von der Person weg",
        },
        {
            "en": "its upper edge towards you",
            "de": "die Oberkante zur Person hin",
        },
        {
            "en": "its left edge away from you",
            "de": "die linke Kante von der Person weg",
        },
        {
            "en": "its right edge away from you",
            "de": "die rechte Kante von der Person weg",
        },
    ),
}
