"""Conversion of a plan to markups of 3D Slicer, and of markups to landmarks and channel ends."""

from collections.abc import Iterator, Sequence

import numpy as np

from server.slicer_file.markups import Markup, MarkupKind
from tracker.errors import InvalidInput
from tracker.geometry import Array
from tracker.plan import Channel, Landmark, PlanDocument, PlannedChannel, VertebraPlan

ENTRY, TARGET, SCREW_TIP = "entry", "target", "screw tip"
# In LPS, y points posteriorly, so that the anterior end of a line has the smaller y.
POSTERIOR = 1
# The direction of a line nearly in a coronal plane is ambiguous.
MIN_FORWARD_MM = 5.0


def plan_markups(plan: PlanDocument) -> tuple[Markup, ...]:
    """Return a point list for the landmarks of each vertebra, and a line for each channel and screw.

    A line runs from the entry point to the target, or to the tip of the screw.
    """
    return tuple(markup for vertebra in plan.vertebrae for markup in _of_vertebra(vertebra))


def channel_markup(channel: Channel) -> Markup:
    """Return the line of a channel, from entry to target."""
    return _line(
        f"{channel.name} channel",
        channel.entry_in_vertebra_mm,
        channel.target_in_vertebra_mm,
        (ENTRY, TARGET),
        f"diameter {2.0 * channel.radius_mm:.1f} mm, length {channel.length_mm:.1f} mm",
    )


def screw_markup(channel: Channel, *, diameter_mm: float, length_mm: float) -> Markup:
    """Return the line of a screw that starts at the entry point of its channel."""
    tip_mm = channel.entry_in_vertebra_mm + length_mm * channel.axis_in_vertebra
    size = f"{diameter_mm:g} x {length_mm:g} mm"
    return _line(
        f"{channel.name} screw {size}", channel.entry_in_vertebra_mm, tip_mm, (ENTRY, SCREW_TIP), size
    )


def landmarks_from_markups(markups: Sequence[Markup], *, name: str) -> tuple[Landmark, ...]:
    """Return the points of the only point list as landmarks.

    Args:
        markups: Markups of one file.
        name: Name of the file, for messages.

    Raises:
        InvalidInput: LANDMARKS_MISSING, there is no point list, or several; LANDMARKS_UNNAMED.
        PlanError: LANDMARK_INVALID.
    """
    markup = _only(markups, MarkupKind.POINTS, "point list", "LANDMARKS_MISSING", name)
    unnamed = [number for number, label in enumerate(markup.labels, start=1) if not label.strip()]
    if unnamed:
        raise InvalidInput(
            "LANDMARKS_UNNAMED",
            f"{name} has {len(unnamed)} points without a label, the first is point {unnamed[0]}",
            "Give each control point the name of its landmark in 3D Slicer.",
            {"file": name, "unnamed": len(unnamed), "first": unnamed[0]},
        )
    return tuple(
        Landmark(name=label.strip(), point_lps_mm=point)
        for label, point in zip(markup.labels, markup.points_lps_mm, strict=True)
    )


def line_from_markups(markups: Sequence[Markup], *, name: str) -> tuple[Array, Array]:
    """Return entry and target (3,) in LPS mm of the only line.

    The first point is the entry, unless the labels state otherwise. Without labels, a line that does not run
    in the anterior direction is rejected, because an inverted channel would pass every later check.

    Raises:
        InvalidInput: CHANNEL_LINE_MISSING, there is no line, or several; CHANNEL_DIRECTION_UNKNOWN.
    """
    markup = _only(markups, MarkupKind.LINE, "line", "CHANNEL_LINE_MISSING", name)
    labels = [label.strip().casefold() for label in markup.labels]
    first, second = markup.points_lps_mm
    if labels in ([ENTRY, TARGET], [TARGET, ENTRY]):
        return (first, second) if labels[0] == ENTRY else (second, first)
    forward_mm = float(first[POSTERIOR] - second[POSTERIOR])
    if forward_mm < MIN_FORWARD_MM:
        raise InvalidInput(
            "CHANNEL_DIRECTION_UNKNOWN",
            f"the line in {name} runs {forward_mm:.1f} mm anteriorly from its first point to its second; the "
            f"first point counts as the entry from {MIN_FORWARD_MM:g} mm on",
            f"Label the two control points '{ENTRY}' and '{TARGET}' in 3D Slicer, or place the entry first.",
            {
                "file": name,
                "forward_mm": forward_mm,
                "min_forward_mm": MIN_FORWARD_MM,
                "entry_label": ENTRY,
                "target_label": TARGET,
            },
        )
    return first, second


def _of_vertebra(vertebra: VertebraPlan) -> Iterator[Markup]:
    if vertebra.landmarks:
        yield Markup(
            kind=MarkupKind.POINTS,
            name=f"{vertebra.name} landmarks",
            points_lps_mm=np.array([one.point_lps_mm for one in vertebra.landmarks]),
            labels=tuple(one.name for one in vertebra.landmarks),
        )
    for planned in vertebra.channels:
        yield from _of_channel(planned)


def _of_channel(planned: PlannedChannel) -> Iterator[Markup]:
    yield channel_markup(planned.channel)
    for screw in planned.screws:
        yield screw_markup(planned.channel, diameter_mm=screw.diameter_mm, length_mm=screw.length_mm)


def _line(name: str, first: Array, second: Array, labels: tuple[str, str], description: str) -> Markup:
    return Markup(
        kind=MarkupKind.LINE,
        name=name,
        points_lps_mm=np.array([first, second]),
        labels=labels,
        description=description,
    )


def _only(markups: Sequence[Markup], kind: MarkupKind, what: str, code: str, name: str) -> Markup:
    found = [one for one in markups if one.kind is kind]
    if len(found) != 1:
        raise InvalidInput(
            code,
            f"{name} has {len(found)} markups of the kind {what}, expected 1",
            f"Save only this {what} as Markups JSON (.mrk.json).",
            {"file": name, "found": len(found)},
        )
    return found[0]
