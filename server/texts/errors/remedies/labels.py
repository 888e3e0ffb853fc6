"""Remedies of errors of labels of vertebrae."""

from server.texts.language import Text

LABELS: tuple[Text, ...] = (
    {"en": "Click into the pedicle on the CT.", "de": "Im CT in den Pedikel klicken."},
    {
        "en": "Look at the label and the pedicle on the CT; measure again, or give its numbers by hand.",
        "de": "Label und Pedikel im CT ansehen; neu messen, oder seine Zahlen von Hand eingeben.",
    },
    {"en": "Send the segmentation again.", "de": "Die Segmentierung erneut senden."},
    {"en": "Send a segmentation of this CT.", "de": "Eine Segmentierung dieses CTs senden."},
    {
        "en": "State the level of each label as number:level, for example 29:L3,28:L4.",
        "de": "Die Höhe jedes Labels als Zahl:Höhe angeben, zum Beispiel 29:L3,28:L4.",
    },
    {
        "en": "State the level of each segment as number:level, for example 1:L3,2:L4.",
        "de": "Die Höhe jedes Segments als Zahl:Höhe angeben, zum Beispiel 1:L3,2:L4.",
    },
    {"en": "Give the segmentation, not the CT.", "de": "Die Segmentierung geben, nicht das CT."},
    {
        "en": "Give the segmentation as labels, resampled by nearest neighbour if at all.",
        "de": "Die Segmentierung als Labels geben, wenn überhaupt mit nächstem Nachbarn umgerechnet.",
    },
    {
        "en": "Give a segmentation of vertebrae C1 to S1; state their names if the file has none.",
        "de": "Eine Segmentierung der Wirbel C1 bis S1 geben; ihre Namen angeben, wenn die Datei keine hat.",
    },
    {
        "en": "Check the segmentation and the names of its labels.",
        "de": "Die Segmentierung und die Namen ihrer Labels prüfen.",
    },
    {
        "en": "Segment this CT again, or give the segmentation of this CT; it must have the same patient "
        "coordinates.",
        "de": "Dieses CT erneut segmentieren, oder die Segmentierung dieses CTs geben; sie muss dieselben "
        "Patientenkoordinaten haben.",
    },
    {
        "en": "Give one segmentation, in which each voxel has one label.",
        "de": "Eine Segmentierung geben, in der jedes Voxel ein Label hat.",
    },
    {
        "en": "Give one NIfTI file with all labels, the files vertebrae_L3.nii.gz and so on of "
        "TotalSegmentator, or a DICOM SEG.",
        "de": "Eine NIfTI-Datei mit allen Labels geben, die Dateien vertebrae_L3.nii.gz und so weiter von "
        "TotalSegmentator, oder ein DICOM SEG.",
    },
    {
        "en": "Export the segmentation again as binary, uncompressed DICOM SEG, or as NIfTI.",
        "de": "Die Segmentierung erneut als binäres, unkomprimiertes DICOM SEG oder als NIfTI exportieren.",
    },
    {
        "en": "Compare the names of the labels with the CT, and segment or name them again.",
        "de": "Die Namen der Labels mit dem CT vergleichen und neu segmentieren oder benennen.",
    },
    {
        "en": "Count the vertebrae on the CT. Rename the vertebra or correct its channel, or replace the "
        "labels if they are wrong.",
        "de": "Die Wirbel im CT zählen. Den Wirbel umbenennen oder seinen Kanal berichtigen, oder die Labels "
        "ersetzen, wenn sie falsch sind.",
    },
)
