"""Messages of errors of camera and image source, by code."""

from collections.abc import Mapping

from server.texts.language import Text

CAMERA: Mapping[str, tuple[Text, ...]] = {
    "CAMERA_NOT_OPENED": (
        {
            "en": "{camera} cannot be opened: {reason}",
            "de": "{camera} lässt sich nicht öffnen: {reason}",
        },
        {"en": "{camera} cannot be opened", "de": "{camera} lässt sich nicht öffnen"},
    ),
    "CAMERA_STOPPED": (
        {
            "en": "{camera} sent no image: {reason}",
            "de": "{camera} lieferte kein Bild: {reason}",
        },
        {"en": "{camera} sent no image", "de": "{camera} lieferte kein Bild"},
    ),
    "CAMERA_TORN": (
        {
            "en": "{camera} sent {images} images in a row that are incomplete or cannot be decoded",
            "de": "{camera} lieferte nacheinander {images} Bilder, die unvollständig oder nicht lesbar sind",
        },
    ),
    "IMAGE_SIZE_DIFFERS": (
        {
            "en": "the image is {width_px}x{height_px} px, the camera was calibrated at "
            "{calibrated_width_px}x{calibrated_height_px} px",
            "de": "das Bild hat {width_px}x{height_px} px, kalibriert wurde mit "
            "{calibrated_width_px}x{calibrated_height_px} px",
        },
    ),
    "PHONE_ABSENT": (
        {"en": "no phone or tablet sends images", "de": "kein Telefon oder Tablet sendet Bilder"},
    ),
    "PHONE_GONE": (
        {
            "en": "the phone has disconnected: its page was closed or stopped, or its network is down",
            "de": "die Verbindung zum Telefon ist getrennt: seine Seite wurde geschlossen oder gestoppt, "
            "oder sein Netz ist ausgefallen",
        },
    ),
    "PHONE_SILENT": (
        {
            "en": "the phone is connected, but sent no image for {limit_s:g} s",
            "de": "das Telefon ist verbunden, sendete aber seit {limit_s:g} s kein Bild",
        },
    ),
    "PHONE_TAKEN": (
        {
            "en": "another device is already sending images, signed in as {name}",
            "de": "ein anderes Gerät sendet schon Bilder, angemeldet als {name}",
        },
    ),
    "RECORDING_IMAGE_BROKEN": (
        {
            "en": "image {image_number} of {file} cannot be decoded",
            "de": "Bild {image_number} von {file} lässt sich nicht dekodieren",
        },
    ),
    "RECORDING_WITHOUT_IMAGES": (
        {"en": "the recording {file} has no image", "de": "die Aufnahme {file} hat kein Bild"},
    ),
    "REHEARSAL_CAMERA_STOPPED": (
        {
            "en": "an event of the rehearsal stopped its camera at {at_s:.1f} s",
            "de": "ein Ereignis des Probebetriebs hielt dessen Kamera bei {at_s:.1f} s an",
        },
    ),
    "SOURCE_FROZEN": (
        {
            "en": "the source {source} repeated the same image for {limit_s:g} s",
            "de": "{source} wiederholt seit {limit_s:g} s dasselbe Bild",
        },
    ),
    "STREAM_IN_BURSTS": (
        {
            "en": "the stream {stream} sends its images in bursts; for {limit_s:g} s all images were "
            "buffered on the way",
            "de": "der Videostrom {stream} sendet seine Bilder stoßweise; {limit_s:g} s lang wurden alle "
            "Bilder unterwegs gepuffert",
        },
    ),
    "STREAM_STOPPED": (
        {
            "en": "the stream {stream} stopped: no image within {timeout_s:g} s, or closed",
            "de": "der Videostrom {stream} ist ausgefallen: kein Bild in {timeout_s:g} s, oder geschlossen",
        },
    ),
    "TRACKING_STARVED": (
        {
            "en": "this computer is overloaded: no image was tracked for {silent_s:.1f} s, of which the "
            "tracking process waited {starved_s:.1f} s for a processor",
            "de": "dieser Rechner ist überlastet: {silent_s:.1f} s lang wurde kein Bild ausgewertet, davon "
            "wartete der Tracking-Prozess {starved_s:.1f} s auf einen Prozessor",
        },
    ),
    "STREAM_WITHOUT_VIDEO": (
        {
            "en": "the stream {stream} is reachable, but sent no video within {timeout_s:g} s",
            "de": "der Videostrom {stream} ist erreichbar, sendete aber {timeout_s:g} s lang kein Video",
        },
    ),
    "VIDEO_IMAGES_DAMAGED": (
        {
            "en": "{damaged_images} of {images} images of {file} are damaged and not used ({library_error})",
            "de": "{damaged_images} von {images} Bildern von {file} sind beschädigt und werden nicht "
            "verwendet ({library_error})",
        },
    ),
    "VIDEO_FILE_CUT": (
        {
            "en": "the video file {file} ends after {images} of {claimed_images} images",
            "de": "die Videodatei {file} endet nach {images} von {claimed_images} Bildern",
        },
    ),
    "VIEWS_DISAGREE": (
        {
            "en": "{disagreeing} of {usable} views do not fit the camera of the others, allowed is half of "
            "them",
            "de": "{disagreeing} von {usable} Ansichten passen nicht zur Kamera der übrigen, erlaubt ist "
            "die Hälfte",
        },
    ),
    "ACCURACY_NOT_INDEPENDENT": (
        {
            "en": "{shared_points} of the {points} points that the plane is fitted to are measured too",
            "de": "{shared_points} der {points} Punkte, an die die Ebene angepasst wird, werden auch "
            "gemessen",
        },
    ),
    "CAMERA_ASPECT_DIFFERS": (
        {
            "en": "a camera of {calibrated_size_wh_px[0]}x{calibrated_size_wh_px[1]} px cannot be scaled "
            "to {size_wh_px[0]}x{size_wh_px[1]} px, which has another ratio of width to height",
            "de": "eine Kamera mit {calibrated_size_wh_px[0]}x{calibrated_size_wh_px[1]} px kann nicht auf "
            "{size_wh_px[0]}x{size_wh_px[1]} px skaliert werden, das Seitenverhältnis ist ein anderes",
        },
    ),
    "CAMERA_FILE_INCOMPLETE": ({"en": "the camera file lacks {keys}", "de": "der Kameradatei fehlt {keys}"},),
    "CAMERA_SIZE_MISMATCH": (
        {
            "en": "{image_subject} {image_size_wh_px[0]}x{image_size_wh_px[1]} px, but the camera was "
            "calibrated at {calibrated_size_wh_px[0]}x{calibrated_size_wh_px[1]} px",
            "de": "{image_subject} {image_size_wh_px[0]}x{image_size_wh_px[1]} px, die Kamera wurde aber "
            "mit {calibrated_size_wh_px[0]}x{calibrated_size_wh_px[1]} px kalibriert",
        },
        {
            "en": "images of the board are {image_size_wh_px[0]}x{image_size_wh_px[1]} px, but the camera "
            "was calibrated at {calibrated_size_wh_px[0]}x{calibrated_size_wh_px[1]} px, and the readout "
            "time is stored for that size",
            "de": "die Bilder der Tafel haben {image_size_wh_px[0]}x{image_size_wh_px[1]} px, die Kamera "
            "wurde aber mit {calibrated_size_wh_px[0]}x{calibrated_size_wh_px[1]} px kalibriert, und die "
            "Auslesezeit wird für diese Größe gespeichert",
        },
    ),
    "COEFFICIENTS_INVALID": (
        {
            "en": "a lens with {coefficients} coefficients, allowed {allowed}",
            "de": "ein Objektiv mit {coefficients} Koeffizienten, erlaubt {allowed}",
        },
    ),
    "IMAGE_FORMAT_INVALID": (
        {
            "en": "an image of {source} is {given}, needed is uint8 (height, width, 3)",
            "de": "ein Bild von {source} ist {given}, nötig ist uint8 (Höhe, Breite, 3)",
        },
    ),
    "IMAGES_DAMAGED": (
        {
            "en": "damaged and not used: {damaged_images} of {images} images of {source} within "
            "{duration_s:.1f} s ({library_error})",
            "de": "beschädigt und nicht verwendet: {damaged_images} von {images} Bildern von {source} in "
            "{duration_s:.1f} s ({library_error})",
        },
    ),
    "IMAGE_NOT_DECODED": (
        {
            "en": "an image of {source} could not be decoded: {library_error}",
            "de": "ein Bild von {source} ließ sich nicht decodieren: {library_error}",
        },
    ),
    "IMAGE_TOO_LARGE": (
        {
            "en": "an image has {size} px and {bytes} bytes, the maximum is {limit_bytes} bytes",
            "de": "ein Bild hat {size} px und {bytes} Bytes, höchstens {limit_bytes} Bytes",
        },
    ),
    "READOUT_INTERRUPTED": (
        {
            "en": "after {images} images the next one came {later_s:.1f} s later, limit "
            "{max_pause_s:.1f} s, or with another size",
            "de": "nach {images} Bildern kam das nächste {later_s:.1f} s später, Grenze "
            "{max_pause_s:.1f} s, oder in anderer Größe",
        },
    ),
    "READOUT_INVALID": (
        {
            "en": "reading an image row by row would take {readout_ms:g} ms",
            "de": "das zeilenweise Auslesen eines Bildes würde {readout_ms:g} ms dauern",
        },
    ),
    "READOUT_TOO_FEW_IMAGES": (
        {
            "en": "the moving board was found in {images} images with neighbours within {gap_ms:.0f} "
            "ms, needed {min_images}",
            "de": "die bewegte Tafel wurde in {images} Bildern mit Nachbarn innerhalb von {gap_ms:.0f} "
            "ms gefunden, nötig {min_images}",
        },
    ),
    "RIG_TOO_SMALL": (
        {
            "en": "a rig of {cameras} camera, needed are at least 2",
            "de": "ein Verbund aus {cameras} Kamera, nötig mindestens 2",
        },
    ),
    "RIG_UNCONNECTED": (
        {
            "en": "{camera} sees the board together with another camera in {views} views, at least "
            "{min_pairs} are needed",
            "de": "{camera} sieht die Tafel in {views} Ansichten zusammen mit einer anderen Kamera, "
            "nötig mindestens {min_pairs}",
        },
    ),
    "RIG_VIEWS_DISAGREE": (
        {
            "en": "{disagree} of {views} instants do not fit to one rig, allowed is a third of them",
            "de": "{disagree} von {views} Zeitpunkten passen nicht zu einem Verbund, erlaubt ist ein Drittel",
        },
        {
            "en": "{disagree} of {views} views place {cameras[1]} elsewhere to {cameras[0]} than the rest, "
            "allowed is a third of them",
            "de": "{disagree} von {views} Ansichten ordnen {cameras[1]} zu {cameras[0]} anders an als die "
            "übrigen, erlaubt ist ein Drittel",
        },
    ),
    "VIEWS_ALL_PARALLEL": (
        {
            "en": "in all {views} views the board is parallel to itself within {tilt_range_deg:.1f} deg, "
            "needed {needed_deg:g} deg: distance and focal length cannot be separated",
            "de": "in allen {views} Ansichten ist die Tafel auf {tilt_range_deg:.1f}° parallel zu sich "
            "selbst, nötig {needed_deg:g}°: Abstand und Brennweite lassen sich nicht trennen",
        },
        {
            "en": "the board's directions differ by {tilt_range_deg:.1f} deg, needed {needed_deg:g} "
            "deg, and the focal length has a standard deviation of {focal_sd_percent:.1f} %, "
            "allowed {allowed_percent:.0f} %",
            "de": "die Richtungen der Tafel unterscheiden sich um {tilt_range_deg:.1f}°, nötig "
            "{needed_deg:g}°, und die Brennweite hat eine Standardabweichung von "
            "{focal_sd_percent:.1f} %, erlaubt {allowed_percent:.0f} %",
        },
    ),
    "PHONE_WITHOUT_SERVER": (
        {
            "en": "the source 'phone' needs a running server",
            "de": "die Quelle „phone“ braucht einen laufenden Server",
        },
    ),
    "REHEARSAL_WITHOUT_THEATRE": (
        {
            "en": "the rehearsal was requested, but its theatre was not built",
            "de": "der Probebetrieb wurde verlangt, sein Operationssaal aber nicht erzeugt",
        },
    ),
    "VIEWS_FROM_ONE_PLACE": (
        {
            "en": "all {views} views show the board in one place: it is tilted by {tilt_range_deg:.1f} deg "
            "between them and moved by {moved_percent:.1f} % of its distance, needed {needed_deg:g} "
            "deg",
            "de": "alle {views} Ansichten zeigen die Tafel an einem Ort: zwischen ihnen ist sie um "
            "{tilt_range_deg:.1f}° geneigt und um {moved_percent:.1f} % ihres Abstands bewegt, nötig "
            "{needed_deg:g}°",
        },
    ),
    "CAMERA_CHANGED": (
        {
            "en": "{control} of the camera changed from {calibrated} to {now} since the calibration, which "
            "is therefore invalid",
            "de": "{control} der Kamera änderte sich seit der Kalibrierung von {calibrated} auf {now}, sie "
            "ist damit ungültig",
        },
        {
            "en": "{control} of the camera changed from {before} to {now} while views were taken",
            "de": "{control} der Kamera änderte sich von {before} auf {now}, während Ansichten aufgenommen "
            "wurden",
        },
    ),
    "CAMERA_DIFFERS": (
        {
            "en": "{file} was calibrated for the camera whose {key} is '{calibrated}', but camera.{key} is "
            "'{camera}'",
            "de": "{file} wurde für die Kamera kalibriert, deren {key} „{calibrated}“ ist, camera.{key} "
            "ist aber „{camera}“",
        },
    ),
    "STREAM_ADDRESS_INVALID": (
        {
            "en": "the stream's address {stream} is invalid: it has no valid host or port",
            "de": "die Adresse {stream} des Videostroms ist ungültig: sie hat keinen gültigen Rechner oder "
            "Port",
        },
    ),
    "PHONE_FOCUS_NOT_LOCKED": (
        {
            "en": "the focus of the phone's camera {focus_phrase}: when it changes, the calibration is "
            "invalid, and the change may go unnoticed",
            "de": "der Fokus der Kamera des Telefons {focus_phrase}: ändert er sich, ist die Kalibrierung "
            "ungültig, und die Änderung bleibt womöglich unbemerkt",
        },
    ),
    "CAMERA_TRIGGER_NOT_OFFERED": (
        {
            "en": "{camera} has no trigger '{trigger}'",
            "de": "{camera} hat keinen Trigger „{trigger}“",
        },
    ),
    "CAMERA_LIBRARY_MISSING": (
        {
            "en": "{camera} needs a library that is not installed here",
            "de": "{camera} braucht eine Bibliothek, die hier nicht installiert ist",
        },
    ),
    "LATENCY_IMAGES_SKIPPED": (
        {
            "en": "{skip_phrase}, the maximum is {max_images}",
            "de": "{skip_phrase}, höchstens {max_images}",
        },
    ),
    "BOARD_NOT_FOUND": (
        {
            "en": "the board was not found in {image}: {board_problem}",
            "de": "die Tafel wurde in {image} nicht gefunden: {board_problem}",
        },
        {
            "en": "the board was not found in the image: {board_problem}",
            "de": "die Tafel wurde im Bild nicht gefunden: {board_problem}",
        },
    ),
    "TOO_FEW_VIEWS": (
        {
            "en": "{usable} of {views} views of the board can be used, at least {needed} are "
            "needed{fault_hint}",
            "de": "{usable} von {views} Ansichten der Tafel sind verwendbar, nötig mindestens "
            "{needed}{fault_hint}",
        },
    ),
    "CALIBRATION_DIVERGED": (
        {
            "en": "no camera fits the {views} views: {divergence}",
            "de": "keine Kamera passt zu den {views} Ansichten: {divergence}",
        },
    ),
    "ACCURACY_PLANE_UNKNOWN": (
        {
            "en": "the plane of the displacements is not determined: {plane_problem}",
            "de": "die Ebene der Verschiebungen ist nicht bestimmt: {plane_problem}",
        },
    ),
    "ACCURACY_INVALID": (
        {
            "en": "points of shape {shape} were seen at pixels of shape {px_shape}, needed (n, 2) each",
            "de": "Punkte der Form {shape} wurden an Pixeln der Form {px_shape} gesehen, nötig je (n, 2)",
        },
        {
            "en": "a coordinate is not finite",
            "de": "eine Koordinate ist nicht endlich",
        },
        {
            "en": "a point at ({point_px[0]:.1f}, {point_px[1]:.1f}) px lies outside of the camera's image "
            "of {size_wh_px[0]}x{size_wh_px[1]} px",
            "de": "ein Punkt bei ({point_px[0]:.1f}, {point_px[1]:.1f}) px liegt außerhalb des Bildes der "
            "Kamera von {size_wh_px[0]}x{size_wh_px[1]} px",
        },
    ),
    "BOARD_INVALID": (
        {
            "en": "there is no such calibration board: {board_fault}",
            "de": "eine solche Kalibriertafel gibt es nicht: {board_fault}",
        },
    ),
    "IMAGE_INVALID": (
        {
            "en": "an image has shape {shape} and type {dtype}, needed (h, w) or (h, w, 3) of 8 bits, at "
            "least 16 x 16",
            "de": "ein Bild hat die Form {shape} und den Typ {dtype}, nötig (h, w) oder (h, w, 3) mit 8 "
            "Bit, mindestens 16 x 16",
        },
        {
            "en": "an image is {given}, needed an array uint8 (h, w) or (h, w, 3)",
            "de": "ein Bild ist {given}, nötig ein Array uint8 (h, w) oder (h, w, 3)",
        },
        {
            "en": "an image is {dtype} of shape {shape}, needed uint8 (h, w) or (h, w, 3)",
            "de": "ein Bild ist {dtype} der Form {shape}, nötig uint8 (h, w) oder (h, w, 3)",
        },
        {
            "en": "the image is {dtype} of shape {shape}, needed uint8 of {size_wh_px[1]} rows and "
            "{size_wh_px[0]} columns, grey or BGR",
            "de": "das Bild ist {dtype} der Form {shape}, nötig uint8 mit {size_wh_px[1]} Zeilen und "
            "{size_wh_px[0]} Spalten, grau oder BGR",
        },
    ),
    "VIEW_INVALID": (
        {
            "en": "a view of a board has {ids} ids, object points of shape {object_shape} and image points "
            "of shape {image_shape}, needed (n,), (n, 3), (n, 2), finite, each id once",
            "de": "eine Ansicht einer Tafel hat {ids} Kennungen, Objektpunkte der Form {object_shape} und "
            "Bildpunkte der Form {image_shape}, nötig (n,), (n, 3), (n, 2), endlich, jede Kennung "
            "einmal",
        },
    ),
    "DISPLACEMENTS_INVALID": (
        {
            "en": "the displacements cannot be used: {displacement_problem}",
            "de": "die Verschiebungen sind nicht verwendbar: {displacement_problem}",
        },
    ),
    "CAMERA_MODEL_INVALID": (
        {
            "en": "the camera model cannot be used: {camera_problem}",
            "de": "das Kameramodell ist nicht verwendbar: {camera_problem}",
        },
    ),
    "CAMERA_FILE_INVALID": (
        {
            "en": "the camera file has a value that is no number: {library_error}",
            "de": "die Kameradatei hat einen Wert, der keine Zahl ist: {library_error}",
        },
        {
            "en": "the controls of a camera are {controls}, expected integers by name",
            "de": "die controls einer Kamera sind {controls}, erwartet ganze Zahlen mit ihren Namen",
        },
        {
            "en": "the readout of a camera is {readout_ms}, expected a number of ms from 0 to "
            "{max_readout_ms:g}",
            "de": "die Auslesezeit einer Kamera ist {readout_ms}, erwartet eine Zahl von 0 bis "
            "{max_readout_ms:g} ms",
        },
        {
            "en": "the camera file {file} is a {given}, expected keys with values",
            "de": "die Kameradatei {file} ist ein {given}, erwartet Schlüssel mit Werten",
        },
    ),
    "READOUT_TOO_SLOW": (
        {
            "en": "the board moved at {speed_px_s:.0f} px/s, needed {min_speed_px_s:.0f} px/s "
            "({readout_estimate})",
            "de": "die Tafel bewegte sich mit {speed_px_s:.0f} px/s, nötig {min_speed_px_s:.0f} px/s "
            "({readout_estimate})",
        },
    ),
    "READOUT_ONE_WAY": (
        {
            "en": "the board moved one way in {forth} images and back in {back}, needed {needed} of each",
            "de": "die Tafel bewegte sich in {forth} Bildern hin und in {back} zurück, nötig je {needed}",
        },
    ),
    "READOUT_UNOBSERVABLE": (
        {
            "en": "this motion does not determine the readout time: {readout_estimate}, allowed "
            "{max_sd_ms:.1f} ms",
            "de": "diese Bewegung bestimmt die Auslesezeit nicht: {readout_estimate}, erlaubt "
            "{max_sd_ms:.1f} ms",
        },
    ),
    "READOUT_IMPOSSIBLE": (
        {
            "en": "{readout_estimate}: it must be between 0 and the {period_ms:.1f} ms between images",
            "de": "{readout_estimate}: sie muss zwischen 0 und den {period_ms:.1f} ms zwischen zwei "
            "Bildern liegen",
        },
    ),
    "RULER_INVALID": (
        {
            "en": "the ruler cannot be used: {ruler_problem}",
            "de": "das Lineal ist nicht verwendbar: {ruler_problem}",
        },
    ),
    "FOLDER_IMAGE_UNREADABLE": (
        {
            "en": "the image {file} cannot be used: {image_problem}",
            "de": "das Bild {file} ist nicht verwendbar: {image_problem}",
        },
        {
            "en": "{images} images cannot be used: {unusable_images}{more_images}",
            "de": "{images} Bilder sind nicht verwendbar: {unusable_images}{more_images}",
        },
    ),
    "FOLDER_WITHOUT_IMAGES": (
        {
            "en": "the folder {folder} has 0 images ({suffixes})",
            "de": "der Ordner {folder} enthält 0 Bilder ({suffixes})",
        },
    ),
    "SOURCE_NOT_FOUND": (
        {
            "en": "the folder {folder} cannot be listed: {system_error}",
            "de": "der Ordner {folder} ist nicht lesbar: {system_error}",
        },
        {
            "en": "the source {file} cannot be opened: {source_problem}",
            "de": "die Quelle {file} lässt sich nicht öffnen: {source_problem}",
        },
    ),
    "VIDEO_FILE_UNREADABLE": (
        {
            "en": "the source {file} cannot be opened: {source_problem}",
            "de": "die Quelle {file} lässt sich nicht öffnen: {source_problem}",
        },
        {
            "en": "{file} ({bytes} bytes) is not a usable video file: {video_problem}",
            "de": "{file} ({bytes} Bytes) ist keine verwendbare Videodatei: {video_problem}",
        },
    ),
    "CAMERA_MODE_NOT_GRANTED": (
        {
            "en": "the phone sends other images than requested: the settings request {requested}, "
            "{granted} was granted",
            "de": "das Telefon sendet andere Bilder als verlangt: die Einstellungen verlangen {requested}, "
            "gewährt wurde {granted}",
        },
    ),
    "PLUGIN_SOURCE_FAILED": (
        {
            "en": "the plug-in {plugin} {plugin_problem}: {library_error}",
            "de": "das Plug-in {plugin} {plugin_problem}: {library_error}",
        },
    ),
    "PLUGIN_NOT_INSTALLED": (
        {
            "en": "there is no plug-in {plugin} in {group}; installed: {installed}",
            "de": "in {group} gibt es kein Plug-in {plugin}; installiert: {installed}",
        },
    ),
    "PLUGIN_AMBIGUOUS": (
        {
            "en": "{count} packages have a plug-in {plugin} in {group}: {packages}",
            "de": "{count} Pakete haben ein Plug-in {plugin} in {group}: {packages}",
        },
    ),
    "PLUGIN_NOT_LOADED": (
        {
            "en": "the plug-in {plugin} cannot be imported: {library_error}",
            "de": "das Plug-in {plugin} lässt sich nicht importieren: {library_error}",
        },
    ),
    "STREAM_UNREACHABLE": (
        {
            "en": "the stream {stream} cannot be reached at {host}:{port}: {stream_problem}",
            "de": "der Videostrom {stream} ist unter {host}:{port} nicht erreichbar: {stream_problem}",
        },
    ),
    "LATENCY_CODE_NOT_READ": (
        {
            "en": "{code_count}, the minimum is {min_timed}",
            "de": "{code_count}, mindestens {min_timed}",
        },
    ),
    "OVERLAY_SIZE": (
        {
            "en": "the image has {image_wh_px[0]}x{image_wh_px[1]} px, but its snapshot is of "
            "{size_wh_px[0]}x{size_wh_px[1]} px",
            "de": "das Bild hat {image_wh_px[0]}x{image_wh_px[1]} px, sein Ergebnis ist aber von "
            "{size_wh_px[0]}x{size_wh_px[1]} px",
        },
    ),
    "IMAGE_NOT_ENCODED": (
        {
            "en": "an image of shape {shape} cannot be encoded as JPEG",
            "de": "ein Bild der Form {shape} lässt sich nicht als JPEG kodieren",
        },
    ),
    "BOARD_DOTS_UNPRINTABLE": (
        {
            "en": "dots of {widest_mm:g} mm at a distance of {nearest_mm:.3g} mm cannot be separated, "
            "allowed: above 0 to {max_dot_mm:.3g} mm",
            "de": "Punkte von {widest_mm:g} mm im Abstand von {nearest_mm:.3g} mm lassen sich nicht "
            "trennen, erlaubt: über 0 bis {max_dot_mm:.3g} mm",
        },
    ),
    "BOARD_TOO_LARGE": (
        {
            "en": "the board needs {needed_mm[0]:.1f} x {needed_mm[1]:.1f} mm with its white margin, but "
            "{paper} has {free_mm[0]:.1f} x {free_mm[1]:.1f} mm in portrait orientation",
            "de": "die Tafel braucht {needed_mm[0]:.1f} x {needed_mm[1]:.1f} mm mit ihrem weißen Rand, "
            "{paper} hat im Hochformat aber {free_mm[0]:.1f} x {free_mm[1]:.1f} mm",
        },
    ),
    "PAPER_UNKNOWN": (
        {
            "en": "the paper size '{paper}' is unknown",
            "de": "das Papierformat „{paper}“ ist unbekannt",
        },
    ),
    "MARKER_SIDE_UNPRINTABLE": (
        {
            "en": "a marker of {side_mm:g} mm cannot be printed on A4 with its white margin, allowed: "
            "{min_side_mm:g} to {max_side_mm:g} mm",
            "de": "ein Marker von {side_mm:g} mm lässt sich mit seinem weißen Rand nicht auf A4 drucken, "
            "erlaubt: {min_side_mm:g} bis {max_side_mm:g} mm",
        },
    ),
    "MARKER_IMAGE_INVALID": (
        {
            "en": "the image of marker '{name}' cannot be used: {marker_problem}",
            "de": "das Bild des Markers „{name}“ ist nicht verwendbar: {marker_problem}",
        },
    ),
    "SCORE_SETTING_INVALID": (
        {
            "en": "the tracker's setting {setting} is {value:g}, allowed 0 to 1",
            "de": "die Einstellung {setting} des Trackers ist {value:g}, erlaubt 0 bis 1",
        },
    ),
    "REHEARSAL_SETTING_INVALID": (
        {
            "en": "the rehearsal's {key} is {value}, allowed is {allowed_values}",
            "de": "{key} des Probebetriebs ist {value}, erlaubt ist {allowed_values}",
        },
    ),
    "SOURCE_STALLED": (
        {
            "en": "the source {source} is open, but sent no image for {limit_s:g} s",
            "de": "{source} ist geöffnet, sendete aber {limit_s:g} s lang kein Bild",
        },
    ),
    "TRACKER_NOT_CONFIGURED": (
        {
            "en": "the source is openigtlink, but the settings have no external_tracker",
            "de": "die Quelle ist openigtlink, aber in den Einstellungen fehlt external_tracker",
        },
    ),
    "TRACKER_UNREACHABLE": (
        {
            "en": "the tracker at {place} cannot be reached: {library_error}",
            "de": "das Trackingsystem unter {place} ist nicht erreichbar: {library_error}",
        },
    ),
    "TRACKER_CLOSED": (
        {
            "en": "the tracker at {place} closed the connection",
            "de": "das Trackingsystem unter {place} hat die Verbindung beendet",
        },
    ),
    "TRACKER_SILENT": (
        {
            "en": "the tracker at {place} sent no new pose of {bodies} for {limit_s:g} s",
            "de": "das Trackingsystem unter {place} sendete {limit_s:g} s lang keine neue Lage von {bodies}",
        },
    ),
    "TRACKER_LATE": (
        {
            "en": "all poses of the tracker at {place} arrive {late_ms:.0f} ms later than the fastest "
            "before, allowed are {limit_ms:g} ms",
            "de": "alle Lagen des Trackingsystems unter {place} kommen {late_ms:.0f} ms später an als die "
            "schnellsten zuvor, erlaubt sind {limit_ms:g} ms",
        },
    ),
    "TRACKER_MESSAGE_INVALID": (
        {
            "en": "a message of the tracker at {place} is not valid: {reason}",
            "de": "eine Nachricht des Trackingsystems unter {place} ist ungültig: {reason}",
        },
    ),
    "CAMERA_NOT_TRIGGERED": (
        {
            "en": "{source} waits for a pulse on {trigger}, but received none for {limit_s:g} s",
            "de": "{source} wartet auf einen Impuls an {trigger}, erhielt aber {limit_s:g} s lang keinen",
        },
    ),
    "PHONE_IMAGE_BROKEN": (
        {
            "en": "an image of the phone is not a complete JPEG",
            "de": "ein Bild des Telefons ist kein vollständiges JPEG",
        },
    ),
    "PHONE_IMAGE_OLD": (
        {
            "en": "images of the phone arrive {age_s:.1f} s after their capture, limit {limit_s:g} s",
            "de": "Bilder des Telefons kommen {age_s:.1f} s nach ihrer Aufnahme an, Grenze {limit_s:g} s",
        },
    ),
    "PHONE_IMAGE_REPEATED": (
        {
            "en": "an image of the phone was captured no later than the one before it",
            "de": "ein Bild des Telefons wurde nicht später aufgenommen als das vorige",
        },
    ),
    "PHONE_IMAGE_SIZE": (
        {
            "en": "an image of the phone has {width_px}x{height_px} px, allowed are {min_side_px} to "
            "{max_width_px}x{max_height_px}",
            "de": "ein Bild des Telefons hat {width_px}x{height_px} px, erlaubt sind {min_side_px} bis "
            "{max_width_px}x{max_height_px}",
        },
    ),
    "PHONE_NOT_SELECTED": (
        {
            "en": "the image source of this server is {source}, not a phone",
            "de": "die Bildquelle dieses Servers ist {source}, kein Telefon",
        },
    ),
}
