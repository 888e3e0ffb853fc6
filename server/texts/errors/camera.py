"""Messages of errors of camera and image source, by code."""

from collections.abc import Mapping

from server.texts.language import Text

CAMERA: Mapping[str, tuple[Text, ...]] = {
    "CAMERA_NOT_OPENED": ({"en": "{camera} cannot be opened", "de": "{camera} lässt sich nicht öffnen"},),
    "CAMERA_STOPPED": ({"en": "{camera} sent no image", "de": "{camera} lieferte kein Bild"},),
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
    "STREAM_TORN": (
        {
            "en": "the stream {stream} sent {images} truncated images in a row",
            "de": "der Videostrom {stream} sendete nacheinander {images} abgeschnittene Bilder",
        },
    ),
    "STREAM_WITHOUT_VIDEO": (
        {
            "en": "the stream {stream} is reachable, but sent no video within {timeout_s:g} s",
            "de": "der Videostrom {stream} ist erreichbar, sendete aber {timeout_s:g} s lang kein Video",
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
}
