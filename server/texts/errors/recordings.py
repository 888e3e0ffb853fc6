"""Messages of errors of recordings, by code."""

from collections.abc import Mapping

from server.texts.language import Text

RECORDINGS: Mapping[str, tuple[Text, ...]] = {
    "CLUSTER_LIBRARY_MISSING": (
        {
            "en": "a cluster is reached with distributed (Dask), which is not installed",
            "de": "ein Cluster wird mit distributed (Dask) erreicht, das nicht installiert ist",
        },
    ),
    "CLUSTER_UNREACHABLE": (
        {
            "en": "the scheduler {scheduler} cannot be reached: {reason}",
            "de": "der Scheduler {scheduler} ist nicht erreichbar: {reason}",
        },
    ),
    "PARQUET_WRITER_MISSING": (
        {
            "en": "Parquet files are written with pyarrow, which is not installed",
            "de": "Parquet-Dateien werden mit pyarrow geschrieben, das nicht installiert ist",
        },
    ),
    "SEQUENCE_EMPTY": (
        {"en": "{name} has no image in this period", "de": "{name} hat in diesem Zeitraum kein Bild"},
    ),
    "SEQUENCE_NOT_WRITTEN": (
        {
            "en": "the sequence {name} cannot be written: {reason}",
            "de": "die Sequenz {name} kann nicht geschrieben werden: {reason}",
        },
    ),
    "SEQUENCE_SIZES_DIFFER": (
        {
            "en": "the images in this period have {count} sizes ({sizes}), a sequence has one",
            "de": "die Bilder in diesem Zeitraum haben {count} Größen ({sizes}), eine Sequenz hat nur eine",
        },
    ),
    "SEQUENCE_TOO_LARGE": (
        {
            "en": "the uncompressed images need {needed_gb:.1f} GB, and {free_gb:.1f} GB are free",
            "de": "die unkomprimierten Bilder brauchen {needed_gb:.1f} GB, frei sind {free_gb:.1f} GB",
        },
    ),
    "EXPORT_UNKNOWN": (
        {"en": "{name} has no export of this name", "de": "{name} hat keinen Export dieses Namens"},
    ),
    "RECORDED_IMAGE_UNKNOWN": (
        {
            "en": "{name} has {images} images, but no image {number}",
            "de": "{name} hat {images} Bilder, aber kein Bild {number}",
        },
    ),
    "RECORDING_BUDGET_EXCEEDED": (
        {
            "en": "all recordings together would exceed recording.max_total_gb with this one, which "
            "has {written_gb:.2f} GB",
            "de": "alle Aufnahmen zusammen würden mit dieser, die {written_gb:.2f} GB hat, "
            "recording.max_total_gb überschreiten",
        },
        {
            "en": "all recordings together have reached recording.max_total_gb, {max_total_gb:g} GB",
            "de": "alle Aufnahmen zusammen haben recording.max_total_gb erreicht, {max_total_gb:g} GB",
        },
    ),
    "RECORDING_CONSENT_MISSING": (
        {
            "en": "nobody has stated that the patient consented to a recording",
            "de": "niemand hat angegeben, dass der Patient in eine Aufnahme eingewilligt hat",
        },
    ),
    "RECORDING_DAMAGED": (
        {
            "en": "{name} cannot be read up to {to_s:.1f} s: {incomplete_reason}",
            "de": "{name} ist nicht bis {to_s:.1f} s lesbar: {incomplete_reason}",
        },
        {
            "en": "image {number} of {name} cannot be decoded",
            "de": "Bild {number} von {name} lässt sich nicht dekodieren",
        },
    ),
    "RECORDING_DISK_FULL": (
        {
            "en": "{free_gb:.2f} GB are free on the disk of the cases, and {min_free_gb:.2f} GB must "
            "stay free (recording.min_free_gb)",
            "de": "{free_gb:.2f} GB sind auf der Platte der Fälle frei, und {min_free_gb:.2f} GB "
            "müssen frei bleiben (recording.min_free_gb)",
        },
        {
            "en": "{free_gb:.2f} GB are free on the disk of the cases, and {min_free_gb:g} GB must stay "
            "free (recording.min_free_gb)",
            "de": "{free_gb:.2f} GB sind auf der Platte der Fälle frei, {min_free_gb:g} GB müssen frei "
            "bleiben (recording.min_free_gb)",
        },
    ),
    "RECORDING_EMPTY": ({"en": "{name} has no image", "de": "{name} hat kein Bild"},),
    "RECORDING_NOT_INDEXED": ({"en": "{name} is not indexed yet", "de": "{name} ist noch nicht eingelesen"},),
    "RECORDING_WITHOUT_SETUP": (
        {
            "en": "{name} does not state with which setup image {number} was computed",
            "de": "{name} gibt nicht an, mit welchem Aufbau Bild {number} berechnet wurde",
        },
    ),
    "RECORDING_PROTECTED": (
        {"en": "{name} is protected from deletion", "de": "{name} ist vor dem Löschen geschützt"},
    ),
    "RECORDING_RUNS": ({"en": "{name} is being written", "de": "{name} wird gerade geschrieben"},),
    "RECORDING_SWITCHED_OFF": ({"en": "recording.when is never", "de": "recording.when ist never"},),
    "RECORDING_UNKNOWN": (
        {
            "en": "the open case has no recording {name!r}",
            "de": "der geöffnete Fall hat keine Aufnahme {name!r}",
        },
        {"en": "{name} was deleted meanwhile", "de": "{name} wurde inzwischen gelöscht"},
    ),
    "RECORDING_OTHER_VERSION": (
        {
            "en": "the results of image {image} cannot be read: {unknown} values have an unknown format",
            "de": "die Ergebnisse von Bild {image} sind nicht lesbar: {unknown} Werte haben ein "
            "unbekanntes Format",
        },
    ),
    "RECORDING_TOO_NEW": (
        {
            "en": "the recording has format {format_version}, this version reads up to {max_format_version}",
            "de": "die Aufnahme hat das Format {format_version}, diese Version liest bis "
            "{max_format_version}",
        },
    ),
    "TABLE_NOT_WRITTEN": (
        {
            "en": "the table {name} cannot be written: {reason}",
            "de": "die Tabelle {name} kann nicht geschrieben werden: {reason}",
        },
    ),
    "CUT_EMPTY": (
        {
            "en": "there is no image from {from_s:.1f} to {to_s:.1f} s; {name} {image_range}",
            "de": "von {from_s:.1f} bis {to_s:.1f} s gibt es kein Bild; {name} {image_range}",
        },
    ),
    "CUT_NOT_WRITTEN": (
        {
            "en": "{name} cannot be written: {write_problem}",
            "de": "{name} kann nicht geschrieben werden: {write_problem}",
        },
    ),
    "VIDEO_NOT_WRITTEN": (
        {
            "en": "the video {name} cannot be written: {system_error}",
            "de": "das Video {name} kann nicht geschrieben werden: {system_error}",
        },
    ),
    "RECORDING_NOT_WRITTEN": (
        {
            "en": "the recording {name} cannot be written: {write_problem}",
            "de": "die Aufnahme {name} kann nicht geschrieben werden: {write_problem}",
        },
    ),
    "RECORDING_NOT_READABLE": (
        {
            "en": "{file} cannot be read as a recording: {read_problem}",
            "de": "{file} ist nicht als Aufnahme lesbar: {read_problem}",
        },
    ),
    "VIDEO_ENCODER_MISSING": (
        {
            "en": "videos cannot be written: {encoder_problem}",
            "de": "Videos lassen sich nicht schreiben: {encoder_problem}",
        },
    ),
}
