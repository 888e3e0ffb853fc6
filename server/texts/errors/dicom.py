"""Messages of errors of DICOM objects and of their way to and from an archive, by code."""

from collections.abc import Mapping

from server.texts.language import Text

DICOM: Mapping[str, tuple[Text, ...]] = {
    "ARCHIVE_CERTIFICATE_UNUSABLE": (
        {
            "en": "there is no certificate in {file} that the archive's could be verified with",
            "de": "in {file} ist kein Zertifikat, mit dem sich das des Archivs prüfen ließe",
        },
    ),
    "ARCHIVE_NOT_SET": (
        {"en": "the settings name no archive", "de": "die Einstellungen nennen kein Archiv"},
    ),
    "ARCHIVE_REJECTED": (
        {
            "en": "the archive {ae_title} at {host}:{port} rejects the connection of {own_title}",
            "de": "das Archiv {ae_title} unter {host}:{port} weist die Verbindung von {own_title} ab",
        },
    ),
    "ARCHIVE_UNREACHABLE": (
        {
            "en": "the archive at {host}:{port} does not answer",
            "de": "das Archiv unter {host}:{port} antwortet nicht",
        },
    ),
    "DICOM_LABELS_OFF_GRID": (
        {
            "en": "the labels do not lie on the voxels of this CT",
            "de": "die Labels liegen nicht auf den Voxeln dieses CTs",
        },
    ),
    "DICOM_NOTHING_TO_WRITE": (
        {
            "en": "the plan has {vertebrae} vertebrae, but no pedicle and no channel, and there are no "
            "labels and surfaces",
            "de": "der Plan hat {vertebrae} Wirbel, aber keinen Pedikel und keinen Kanal, und es gibt keine "
            "Labels und Oberflächen",
        },
    ),
    "DICOM_SEG_TILTED": (
        {
            "en": "the slices are tilted by {tilt_deg:.1f} deg and shifted by {sheared_mm:.1f} mm against a "
            "right-angled stack, allowed {max_mm:g} mm: many programs would show the segmentation beside the "
            "bone",
            "de": "die Schichten sind um {tilt_deg:.1f} Grad gekippt und um {sheared_mm:.1f} mm gegen einen "
            "rechtwinkligen Stapel verschoben, erlaubt {max_mm:g} mm: viele Programme würden die "
            "Segmentierung neben dem Knochen zeigen",
        },
    ),
    "DICOM_SOURCE_INCOMPLETE": (
        {
            "en": "{missing} of {files} files of the CT do not state their {attribute}, which objects of the "
            "same study refer to",
            "de": "{missing} von {files} Dateien des CTs nennen ihre {attribute} nicht, auf die sich Objekte "
            "derselben Studie beziehen",
        },
        {
            "en": "the header of a slice has an attribute that cannot be read",
            "de": "der Kopf einer Schicht hat ein Attribut, das nicht lesbar ist",
        },
        {
            "en": "patient or study in the headers of the CT cannot be written",
            "de": "Patient oder Studie in den Köpfen des CTs lassen sich nicht schreiben",
        },
    ),
    "DICOM_STUDIES_MIXED": (
        {
            "en": "the files of the CT belong to {studies} studies, expected 1",
            "de": "die Dateien des CTs gehören zu {studies} Studien, erwartet 1",
        },
    ),
    "RECEIVED_NOT_COMPLETE": (
        {
            "en": "the series is not complete: {files} slices have arrived, and the sender has not finished",
            "de": "die Serie ist nicht vollständig: {files} Schichten sind angekommen, und der Absender ist "
            "nicht fertig",
        },
    ),
    "RECEIVED_UNKNOWN": (
        {
            "en": "no received series has the id {series_id}",
            "de": "keine empfangene Serie hat die Kennung {series_id}",
        },
    ),
    "RECEIVER_ENDED": (
        {
            "en": "the receiver of DICOM ended {exit_reason} and is started again",
            "de": "der Empfänger für DICOM endete {exit_reason} und wird neu gestartet",
        },
    ),
    "RECEIVER_OFF": (
        {
            "en": "no series are received, because dicom.receive.port is not set",
            "de": "es werden keine Serien empfangen, weil dicom.receive.port nicht gesetzt ist",
        },
    ),
    "RECEIVE_CONTRADICTS": (
        {
            "en": "a slice was refused, because another one of the same identifier has arrived before",
            "de": "eine Schicht wurde abgelehnt, weil zuvor eine andere mit derselben Kennung angekommen ist",
        },
    ),
    "RECEIVE_DAMAGED": (
        {
            "en": "a file was refused, because it is no readable CT slice",
            "de": "eine Datei wurde abgelehnt, weil sie keine lesbare CT-Schicht ist",
        },
    ),
    "RECEIVE_FULL": (
        {
            "en": "a series was refused, because {waiting_gb:.1f} GB wait already, allowed {max_gb:g} GB",
            "de": "eine Serie wurde abgelehnt, weil schon {waiting_gb:.1f} GB warten, erlaubt {max_gb:g} GB",
        },
    ),
    "RECEIVE_INTERRUPTED": (
        {
            "en": "a connection ended before the sender had finished; its series is not complete",
            "de": "eine Verbindung endete, bevor der Absender fertig war; seine Serie ist nicht vollständig",
        },
    ),
    "RECEIVE_MANY_SERIES": (
        {
            "en": "a series was refused, because {waiting} wait already, allowed {max_series}",
            "de": "eine Serie wurde abgelehnt, weil schon {waiting} warten, erlaubt {max_series}",
        },
    ),
    "RECEIVE_NOT_WRITTEN": (
        {
            "en": "a slice was refused, because it cannot be written to the disk",
            "de": "eine Schicht wurde abgelehnt, weil sie sich nicht auf die Platte schreiben lässt",
        },
    ),
    "RECEIVE_SENDER_REFUSED": (
        {
            "en": "a connection of {title} was refused: its title or the called title is not in the "
            "settings, or there are too many connections",
            "de": "eine Verbindung von {title} wurde abgelehnt: ihr Titel oder der gerufene steht nicht in "
            "den Einstellungen, oder es gibt zu viele Verbindungen",
        },
    ),
}
