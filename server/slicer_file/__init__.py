"""Files of 3D Slicer as bytes: markups (`.mrk.json`) and linear transforms of ITK (`.tfm`)."""

from server.slicer_file.markups import (
    Markup,
    MarkupKind,
    is_markups_name,
    markups_from_bytes,
    markups_to_bytes,
)
from server.slicer_file.plan_markups import (
    channel_markup,
    landmarks_from_markups,
    line_from_markups,
    plan_markups,
    screw_markup,
)
from server.slicer_file.transform import fixed_from_moving_in_itk, is_itk_name, itk_text

__all__ = [
    "Markup",
    "MarkupKind",
    "channel_markup",
    "fixed_from_moving_in_itk",
    "is_itk_name",
    "is_markups_name",
    "itk_text",
    "landmarks_from_markups",
    "line_from_markups",
    "markups_from_bytes",
    "markups_to_bytes",
    "plan_markups",
    "screw_markup",
]
