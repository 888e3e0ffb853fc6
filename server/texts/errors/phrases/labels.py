"""Phrases in errors of labels of vertebrae."""

from collections.abc import Mapping

from server.texts.language import Text

LABELS: Mapping[str, tuple[Text, ...]] = {
    "pedicle_part": (
        {"en": "the entry", "de": "der Eintritt"},
        {"en": "the front wall", "de": "die vordere Wand"},
        {"en": "the wall at the isthmus", "de": "die Wand an der Engstelle"},
    ),
    "label_side": ({"en": "outside", "de": "außerhalb"}, {"en": "inside", "de": "innerhalb"}),
    "label_problem": (
        {
            "en": "no canal lies between a body and an arch",
            "de": "zwischen Wirbelkörper und Bogen liegt kein Kanal",
        },
        {
            "en": "nothing connects body and arch on the {side} side",
            "de": "auf der Seite {side} verbindet nichts Wirbelkörper und Bogen",
        },
        {
            "en": "it does not reach from a body backwards",
            "de": "es reicht nicht von einem Wirbelkörper nach hinten",
        },
    ),
    "segmentation_problem": (
        {"en": "it is truncated or damaged", "de": "sie ist abgeschnitten oder beschädigt"},
        {"en": "its {mib} MiB exceed {max_mib} MiB", "de": "ihre {mib} MiB überschreiten {max_mib} MiB"},
        {"en": "it is deflated", "de": "sie ist als Ganzes komprimiert (Deflate)"},
        {"en": "it is compressed as {syntax}", "de": "sie ist komprimiert als {syntax}"},
        {
            "en": "its type is {kind}, not BINARY with one bit a pixel",
            "de": "ihre Art ist {kind}, nicht BINARY mit einem Bit je Pixel",
        },
        {
            "en": "it states {frames} frames, allowed are 1 to {max_frames} with a position each",
            "de": "sie nennt {frames} Bilder, erlaubt sind 1 bis {max_frames} mit je einer Position",
        },
        {"en": "it has no pixels", "de": "sie hat keine Pixel"},
        {"en": "it lacks a part of its pixels", "de": "ihr fehlt ein Teil ihrer Pixel"},
        {"en": "a frame has no position", "de": "ein Bild hat keine Position"},
        {"en": "no frame belongs to a vertebra", "de": "kein Bild gehört zu einem Wirbel"},
        {
            "en": "it does not state direction and size of its pixels",
            "de": "sie nennt Richtung und Größe ihrer Pixel nicht",
        },
        {
            "en": "direction or size of its pixels is not valid",
            "de": "Richtung oder Größe ihrer Pixel ist ungültig",
        },
        {
            "en": "the distance between its slices is not valid",
            "de": "der Abstand ihrer Schichten ist ungültig",
        },
    ),
}
