"""Phrases in errors of tools, their poses and their clocks."""

from collections.abc import Mapping

from server.texts.language import Text

TOOL: Mapping[str, tuple[Text, ...]] = {
    "axis_place": (
        {
            "en": "defined in the settings and in {file}",
            "de": "in den Einstellungen und in {file} angegeben",
        },
        {
            "en": "not defined",
            "de": "nicht angegeben",
        },
    ),
    "spans": (
        {
            "en": "{first} from {first_from_s} to {first_to_s} s and {second} from {second_from_s} to "
            "{second_to_s} s",
            "de": "{first} von {first_from_s} bis {first_to_s} s und {second} von {second_from_s} bis "
            "{second_to_s} s",
        },
    ),
    "motion": (
        {
            "en": "rotation",
            "de": "Drehung",
        },
        {
            "en": "translation",
            "de": "Verschiebung",
        },
    ),
    "series_problem": (
        {
            "en": "{field} is not an array {shape} of finite numbers",
            "de": "{field} ist kein Array {shape} endlicher Zahlen",
        },
        {
            "en": "the time after {before_s} s is {after_s} s, which is not later",
            "de": "die Zeit nach {before_s} s ist {after_s} s, das ist nicht später",
        },
    ),
    "pose_problem": (
        {
            "en": "its shape is {shape}, needed (4, 4)",
            "de": "ihre Form ist {shape}, nötig (4, 4)",
        },
        {
            "en": "{count} of its numbers are not finite",
            "de": "{count} ihrer Zahlen sind nicht endlich",
        },
        {
            "en": "it is transposed: its translation is in the last row",
            "de": "sie ist transponiert: ihre Verschiebung steht in der letzten Zeile",
        },
        {
            "en": "its last row is {row}, needed 0 0 0 1",
            "de": "ihre letzte Zeile ist {row}, nötig 0 0 0 1",
        },
        {
            "en": "the length of its quaternion is {length}, needed 1",
            "de": "die Länge ihres Quaternions ist {length}, nötig 1",
        },
        {
            "en": "its rotation is a reflection (its determinant is negative)",
            "de": "ihre Drehung ist eine Spiegelung (die Determinante ist negativ)",
        },
        {
            "en": "it scales by {scale}, needed 1",
            "de": "sie skaliert um {scale}, nötig 1",
        },
        {
            "en": "its rotation deviates from orthonormal by {off}, allowed {allowed}",
            "de": "ihre Drehung weicht um {off} von orthonormal ab, erlaubt {allowed}",
        },
    ),
    "near_poses": (
        {
            "en": "all",
            "de": "allen",
        },
        {
            "en": "{near} of {poses}",
            "de": "{near} von {poses}",
        },
    ),
}
