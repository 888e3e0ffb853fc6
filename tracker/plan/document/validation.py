"""Validation of an imported plan before anything is computed from it."""

from collections.abc import Iterator

import numpy as np

from tracker.errors import PlanError
from tracker.geometry import Array
from tracker.plan.channel import Channel
from tracker.plan.document.corrections import CORRECTABLE
from tracker.plan.document.records import PlanDocument, VertebraPlan
from tracker.plan.landmark import Landmark
from tracker.plan.pedicle import PedicleMeasure
from tracker.plan.reference_slice import ReferenceSlice

MAX_VERTEBRAE, MAX_NAME_LENGTH = 30, 40
# A channel name is composed of vertebra and side.
MAX_CHANNEL_NAME_LENGTH = MAX_NAME_LENGTH + len(" right")
MAX_WARNINGS, MAX_WARNING_LENGTH = 50, 500
MAX_LANDMARKS, MAX_LANDMARK_NAME_LENGTH = 40, 60
OUTLINE_POINTS = (6, 5000)
MAX_COORDINATE_MM = 10_000.0
MAX_CHANNEL_MM, MAX_RADIUS_MM = 150.0, 20.0


def validate_plan(plan: PlanDocument) -> None:
    """Reject a plan whose numbers are impossible for a spine.

    Raises:
        PlanError: PLAN_INVALID.
    """
    for where, what in _violations(plan):
        raise PlanError(
            "PLAN_INVALID",
            f"the plan cannot be used: {where} {what}",
            "Export the plan again from the program in which it was made.",
            {"where": where, "plan_place": where, "plan_fault": what},
        )


def _violations(plan: PlanDocument) -> Iterator[tuple[str, str]]:
    if len(plan.vertebrae) > MAX_VERTEBRAE:
        yield "plan", f"has {len(plan.vertebrae)} vertebrae, allowed {MAX_VERTEBRAE}"
        return
    for n, vertebra in enumerate(plan.vertebrae):
        where = f"vertebra {n + 1}"
        if not _is_name(vertebra.name) or "/" in vertebra.name or vertebra.name in {".", ".."}:
            # The name is part of URLs.
            yield (
                where,
                f"has a name of {len(vertebra.name)} letters, allowed 1 to {MAX_NAME_LENGTH} printable ones "
                "without a slash, and more than dots",
            )
        yield from _in_vertebra(vertebra, where)


def _in_vertebra(vertebra: VertebraPlan, where: str) -> Iterator[tuple[str, str]]:
    for record in vertebra.pedicles:
        yield from _in_measure(record.measured, f"{where}, {record.measured.side} pedicle,")
    for planned in vertebra.channels:
        yield from _in_channel(planned.channel, f"{where}, {planned.side} channel,")
    for reference in vertebra.references:
        yield from _in_reference(reference, f"{where}, reference slice,")
    if len(vertebra.landmarks) > MAX_LANDMARKS:
        yield where, f"has {len(vertebra.landmarks)} landmarks, allowed {MAX_LANDMARKS}"
    for n, landmark in enumerate(vertebra.landmarks):
        yield from _in_landmark(landmark, f"{where}, landmark {n + 1},")


def _in_measure(measure: PedicleMeasure, where: str) -> Iterator[tuple[str, str]]:
    for name in ("isthmus_lps_mm", "axis_lps", "entry_lps_mm", "front_lps_mm", "seed_lps_mm"):
        yield from _is_shaped(getattr(measure, name), (3,), f"{where} {name}")
    few, many = OUTLINE_POINTS
    outline = measure.outline_lps_mm
    if outline.ndim != 2 or outline.shape[1] != 3 or not few <= outline.shape[0] <= many:
        yield where, f"outline_lps_mm has shape {outline.shape}, needed {few} to {many} points"
    else:
        yield from _is_shaped(outline, outline.shape, f"{where} outline_lps_mm")
    if measure.axis_lps.shape == (3,) and abs(np.linalg.norm(measure.axis_lps) - 1.0) > 1e-6:
        yield where, f"axis_lps has length {np.linalg.norm(measure.axis_lps):.3f}, needed 1"
    for name, (low, high) in CORRECTABLE.items():
        value = getattr(measure, name)
        # A measured value may lie slightly beyond the range of manual corrections.
        room = 0.5 * (high - low)
        if not (low - room <= value <= high + room) or (name.endswith("_mm") and value <= 0.0):
            yield where, f"{name} is {value:g}, allowed {low:g} to {high:g}"
    if len(measure.warnings) > MAX_WARNINGS or any(
        len(one.code + one.message + one.remedy) > MAX_WARNING_LENGTH for one in measure.warnings
    ):
        yield (
            where,
            f"has more than {MAX_WARNINGS} warnings, or one of more than {MAX_WARNING_LENGTH} letters",
        )


def _in_channel(channel: Channel, where: str) -> Iterator[tuple[str, str]]:
    yield from _is_shaped(channel.entry_in_vertebra_mm, (3,), where)
    yield from _is_shaped(channel.target_in_vertebra_mm, (3,), where)
    if not _is_name(channel.name, MAX_CHANNEL_NAME_LENGTH):
        yield (
            where,
            f"has a name of {len(channel.name)} letters, allowed 1 to {MAX_CHANNEL_NAME_LENGTH} "
            "printable ones",
        )
    if channel.length_mm > MAX_CHANNEL_MM or channel.radius_mm > MAX_RADIUS_MM:
        yield (
            where,
            f"is {channel.length_mm:.0f} mm long with radius {channel.radius_mm:.0f} mm, allowed "
            f"{MAX_CHANNEL_MM:.0f} and {MAX_RADIUS_MM:.0f} mm",
        )


def _in_reference(reference: ReferenceSlice, where: str) -> Iterator[tuple[str, str]]:
    names = [line.name for line in reference.lines]
    if sorted(names) != ["left", "middle", "right"]:
        yield where, f"has lines {[name[:10] for name in names[:5]]}, needed middle, left and right"
    if len(reference.paths) > 2:
        yield where, f"has {len(reference.paths)} paths, allowed 2"
    for line in (*reference.lines, *reference.paths):
        yield from _is_shaped(line.ends_lps_mm, (2, 3), where)
        yield from _is_shaped(line.ends_px, (2, 2), where)


def _in_landmark(landmark: Landmark, where: str) -> Iterator[tuple[str, str]]:
    yield from _is_shaped(landmark.point_lps_mm, (3,), where)
    if not _is_name(landmark.name, MAX_LANDMARK_NAME_LENGTH):
        yield (
            where,
            f"has a name of {len(landmark.name)} letters, allowed 1 to {MAX_LANDMARK_NAME_LENGTH} printable "
            "ones",
        )


def _is_shaped(array: Array, shape: tuple[int, ...], where: str) -> Iterator[tuple[str, str]]:
    if array.shape != shape:
        yield where, f"has shape {array.shape}, needed {shape}"
    elif np.abs(array).max() > MAX_COORDINATE_MM:
        yield where, f"contains {np.abs(array).max():g}, allowed up to {MAX_COORDINATE_MM:g}"


def _is_name(name: str, longest: int = MAX_NAME_LENGTH) -> bool:
    return bool(name.strip()) and len(name) <= longest and name.isprintable()
