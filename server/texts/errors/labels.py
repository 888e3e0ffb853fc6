"""Messages of errors of labels of vertebrae, by code."""

from collections.abc import Mapping

from server.texts.language import Text

LABELS: Mapping[str, tuple[Text, ...]] = {
    "LABELS_DAMAGED": (
        {
            "en": "the file of the labels in the case is damaged",
            "de": "die Datei der Labels im Fall ist beschädigt",
        },
    ),
    "LABELS_NOT_STORED": (
        {
            "en": "the open case has no labels of vertebrae for its CT",
            "de": "der geöffnete Fall hat keine Labels der Wirbel für sein CT",
        },
    ),
    "LABELS_MISSING": (
        {
            "en": "{used} of {files} files are segmentations of vertebrae, expected 1 to {max_used}",
            "de": "{used} von {files} Dateien sind Segmentierungen von Wirbeln, erwartet 1 bis {max_used}",
        },
        {
            "en": "none of the {segments} segments is named after a vertebra by its code or label",
            "de": "keines der {segments} Segmente ist durch Code oder Label nach einem Wirbel benannt",
        },
    ),
    "LABEL_NAMES_INVALID": (
        {
            "en": "the names state {levels} levels for {labels} labels; each level can have one label",
            "de": "die Namen nennen {levels} Höhen für {labels} Labels; jede Höhe kann ein Label haben",
        },
        {
            "en": "'{part}' does not state a number from 1 to {max_number} with its level",
            "de": "„{part}“ nennt keine Zahl von 1 bis {max_number} mit ihrer Höhe",
        },
    ),
    "LABEL_UNKNOWN": (
        {
            "en": "the file does not name its labels, and {unknown} of {labels} are not in the table of "
            "TotalSegmentator v2: {listed}",
            "de": "die Datei benennt ihre Labels nicht, und {unknown} von {labels} stehen nicht in der "
            "Tabelle von TotalSegmentator v2: {listed}",
        },
    ),
    "LABELS_NOT_INTEGER": (
        {
            "en": "the values lie between {low} and {high}, labels between 0 and {max_number}; this looks "
            "like an image",
            "de": "die Werte liegen zwischen {low} und {high}, Labels zwischen 0 und {max_number}; das sieht "
            "nach einem Bild aus",
        },
        {
            "en": "the labels are not whole numbers (up to {off:.3f} beside one), as if this were an image "
            "or had been interpolated",
            "de": "die Labels sind keine ganzen Zahlen (bis zu {off:.3f} daneben), als wäre dies ein Bild "
            "oder interpoliert",
        },
    ),
    "LABELS_EMPTY": (
        {
            "en": "the segmentation has no vertebra in the CT",
            "de": "die Segmentierung hat keinen Wirbel im CT",
        },
    ),
    "LABEL_VOLUME_ODD": (
        {
            "en": "the label {level} has {volume_ml:.1f} ml, plausible for a vertebra are {min_ml:g} to "
            "{max_ml:g} ml",
            "de": "das Label {level} hat {volume_ml:.1f} ml, plausibel für einen Wirbel sind {min_ml:g} bis "
            "{max_ml:g} ml",
        },
    ),
    "LABELS_NOT_ON_BONE": (
        {
            "en": "the labels do not lie on bone: inside of them the CT has {contrast_hu:.0f} HU more than "
            "around them, expected {min_contrast_hu:.0f} or more",
            "de": "die Labels liegen nicht auf Knochen: in ihnen hat das CT {contrast_hu:.0f} HU mehr als um "
            "sie herum, erwartet {min_contrast_hu:.0f} oder mehr",
        },
        {
            "en": "the labels lie beside the bone: shifted by {shift_mm:g} mm, the CT inside of them is "
            "{gain_hu:.0f} HU denser, allowed {max_gain_hu:.0f}",
            "de": "die Labels liegen neben dem Knochen: um {shift_mm:g} mm verschoben ist das CT in ihnen um "
            "{gain_hu:.0f} HU dichter, erlaubt {max_gain_hu:.0f}",
        },
    ),
    "LABELS_OUTSIDE_CT": (
        {
            "en": "{inside:.0%} of the labels ({stated_ml:.0f} ml) lie in the CT, expected {min_inside:.0%} "
            "or more",
            "de": "{inside:.0%} der Labels ({stated_ml:.0f} ml) liegen im CT, erwartet {min_inside:.0%} oder "
            "mehr",
        },
    ),
    "LABELS_OVERLAP": (
        {
            "en": "{overlap_ml:.1f} ml belong to two vertebrae, allowed {allowed_ml:.1f} ml",
            "de": "{overlap_ml:.1f} ml gehören zu zwei Wirbeln, erlaubt {allowed_ml:.1f} ml",
        },
    ),
    "SEGMENTATION_UNREADABLE": (
        {
            "en": "the DICOM segmentation cannot be read: {segmentation_problem}",
            "de": "die DICOM-Segmentierung ist nicht lesbar: {segmentation_problem}",
        },
    ),
    "SEGMENTATION_GEOMETRY": (
        {
            "en": "the frames of the segmentation do not lie on one grid: {off:.2f} of a slice beside it, "
            "{off_mm:.2f} mm within a slice",
            "de": "die Bilder der Segmentierung liegen nicht auf einem Gitter: {off:.2f} einer Schicht "
            "daneben, {off_mm:.2f} mm innerhalb einer Schicht",
        },
    ),
    "LEVEL_WITHOUT_LABEL": (
        {
            "en": "the segmentation has no label {level}, only {listed}",
            "de": "die Segmentierung hat kein Label {level}, nur {listed}",
        },
    ),
    "LABEL_WITHOUT_PEDICLES": (
        {
            "en": "the pedicles cannot be found in the label {level}: {label_problem}",
            "de": "die Pedikel sind im Label {level} nicht zu finden: {label_problem}",
        },
    ),
    "PEDICLE_DOUBTFUL": (
        {
            "en": "{pedicle_part} lies {off_mm:.1f} mm {label_side} of the surface of the label {level}, "
            "allowed {limit_mm:.1f} mm",
            "de": "{pedicle_part} liegt {off_mm:.1f} mm {label_side} der Oberfläche des Labels {level}, "
            "erlaubt {limit_mm:.1f} mm",
        },
    ),
    "LEVEL_DOUBTFUL": (
        {
            "en": "the pedicle is measured for {planned}, but its isthmus lies in the label {prevailing}, "
            "{steps} levels away",
            "de": "der Pedikel ist für {planned} gemessen, aber seine Engstelle liegt im Label {prevailing}, "
            "{steps} Höhen entfernt",
        },
        {
            "en": "the labels are out of order: from the head down they are {named} by name, but {placed} by "
            "position",
            "de": "die Labels stehen nicht in der richtigen Reihenfolge: vom Kopf abwärts sind sie nach "
            "Namen {named}, nach der Lage aber {placed}",
        },
        {
            "en": "{upper} and {lower} are {named} levels apart by name, but their labels lie "
            "{distance_mm:.0f} mm apart, about {placed} levels; allowed are {min_mm:.0f} to {max_mm:.0f} mm",
            "de": "{upper} und {lower} liegen nach Namen {named} Höhen auseinander, ihre Labels aber "
            "{distance_mm:.0f} mm, etwa {placed} Höhen; erlaubt sind {min_mm:.0f} bis {max_mm:.0f} mm",
        },
        {
            "en": "the channel {channel} is planned for {planned}, but {share:.0f} % of its length lies in "
            "the label {prevailing}, {steps} levels away, and {own:.0f} % in {planned}",
            "de": "der Kanal {channel} ist für {planned} geplant, aber {share:.0f} % seiner Länge liegen im "
            "Label {prevailing}, {steps} Höhen entfernt, und {own:.0f} % in {planned}",
        },
    ),
}
