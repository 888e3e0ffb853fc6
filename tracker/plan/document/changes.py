"""Edit operations on a plan; each returns a new plan with all dependent values recomputed."""

import dataclasses
from collections.abc import Mapping, Sequence

import numpy as np
import numpy.typing as npt

from tracker.errors import PlanError
from tracker.geometry import Array
from tracker.plan.channel import Channel
from tracker.plan.document.corrections import PedicleRecord
from tracker.plan.document.records import PlanDocument, PlannedChannel, VertebraPlan
from tracker.plan.landmark import Landmark, reject_landmarks_outside
from tracker.plan.pedicle import PedicleMeasure, Side
from tracker.plan.reference_slice import AHEAD_MM, MAX_BEHIND_ENTRY_MM, ReferenceSlice, draw_reference
from tracker.plan.screw import ScrewPlan, channel_from_measure, plan_screw
from tracker.plan.volume import Volume


def vertebra_named(plan: PlanDocument, name: str) -> VertebraPlan:
    """Return one vertebra of the plan.

    Raises:
        PlanError: VERTEBRA_UNKNOWN.
    """
    for vertebra in plan.vertebrae:
        if vertebra.name == name:
            return vertebra
    names = ", ".join(one.name for one in plan.vertebrae) or "none"
    raise PlanError(
        "VERTEBRA_UNKNOWN",
        f"the plan has no vertebra '{name[:40]}', it has {names}",
        "Add it to the plan, or name one that is there.",
        {"name": name[:40], "existing": names},
    )


def pedicle_of(vertebra: VertebraPlan, side: Side) -> PedicleRecord:
    """Return the pedicle of a side.

    Raises:
        PlanError: PEDICLE_MISSING.
    """
    record = vertebra.pedicle(side)
    if record is not None:
        return record
    raise PlanError(
        "PEDICLE_MISSING",
        f"the {side} pedicle of {vertebra.name} is not measured",
        "Click into it first.",
        {"vertebra": vertebra.name, "side": side},
    )


def channel_of(vertebra: VertebraPlan, side: Side) -> PlannedChannel:
    """Return the channel of a side.

    Raises:
        PlanError: CHANNEL_MISSING.
    """
    for planned in vertebra.channels:
        if planned.side == side:
            return planned
    raise PlanError(
        "CHANNEL_MISSING",
        f"{vertebra.name} has no {side} channel",
        "Lay the channel first, from the measured pedicle or by hand.",
        {"vertebra": vertebra.name, "side": side},
    )


def with_vertebra(plan: PlanDocument, name: str) -> PlanDocument:
    """Return the plan with one more vertebra.

    Raises:
        PlanError: PLAN_INVALID, there is one of this name; VERTEBRA_INVALID.
    """
    return dataclasses.replace(plan, vertebrae=(*plan.vertebrae, VertebraPlan(name=name)))


def without_vertebra(plan: PlanDocument, name: str) -> PlanDocument:
    """Return the plan without this vertebra.

    Raises:
        PlanError: VERTEBRA_UNKNOWN.
    """
    gone = vertebra_named(plan, name)
    return dataclasses.replace(plan, vertebrae=tuple(one for one in plan.vertebrae if one is not gone))


def with_measure(
    plan: PlanDocument, name: str, measure: PedicleMeasure, *, volume: Volume, front_margin_mm: float
) -> PlanDocument:
    """Return the plan with a new pedicle measurement; earlier corrections of it are discarded."""
    vertebra = vertebra_named(plan, name)
    changed = _with_pedicle(vertebra, PedicleRecord(measured=measure))
    return _with(plan, _with_updated_channel(changed, measure.side, volume, front_margin_mm))


def with_corrections(
    plan: PlanDocument,
    name: str,
    side: Side,
    corrected: Mapping[str, float],
    *,
    volume: Volume,
    front_margin_mm: float,
) -> PlanDocument:
    """Return the plan with these corrections of the measured values; an empty mapping removes all.

    Raises:
        PlanError: VERTEBRA_UNKNOWN, PEDICLE_MISSING, CORRECTION_INVALID.
    """
    vertebra = vertebra_named(plan, name)
    record = dataclasses.replace(pedicle_of(vertebra, side), corrected=dict(corrected))
    return _with(plan, _with_updated_channel(_with_pedicle(vertebra, record), side, volume, front_margin_mm))


def with_channel(
    plan: PlanDocument,
    name: str,
    side: Side,
    channel: Channel | None,
    *,
    volume: Volume,
    front_margin_mm: float,
) -> PlanDocument:
    """Return the plan with a manual channel, or with that of the measured pedicle; keeps the screw.

    Raises:
        PlanError: VERTEBRA_UNKNOWN, PEDICLE_MISSING, CHANNEL_INVALID, CHANNEL_OUTSIDE_CT.
    """
    vertebra = vertebra_named(plan, name)
    by_hand = channel is not None
    if channel is None:
        measure = pedicle_of(vertebra, side).used
        channel = channel_from_measure(channel_name(name, side), measure, front_margin_mm=front_margin_mm)
    screws = tuple(screw for one in vertebra.channels if one.side == side for screw in one.screws)
    planned = PlannedChannel(side=side, channel=channel, by_hand=by_hand, screws=screws)
    return _with(plan, _with_updated_channel(_with_channel(vertebra, planned), side, volume, front_margin_mm))


def without_channel(plan: PlanDocument, name: str, side: Side, *, volume: Volume) -> PlanDocument:
    """Return the plan without a channel on this side.

    Raises:
        PlanError: VERTEBRA_UNKNOWN, CHANNEL_MISSING.
    """
    vertebra = vertebra_named(plan, name)
    gone = channel_of(vertebra, side)
    left = tuple(one for one in vertebra.channels if one is not gone)
    return _with(plan, _redrawn(dataclasses.replace(vertebra, channels=left), volume))


def with_screw(
    plan: PlanDocument, name: str, side: Side, size_mm: tuple[float, float] | None, *, volume: Volume
) -> PlanDocument:
    """Return the plan with a screw of this size in the channel, or without a screw.

    Raises:
        PlanError: VERTEBRA_UNKNOWN, CHANNEL_MISSING, PEDICLE_MISSING, SCREW_INVALID.
    """
    vertebra = vertebra_named(plan, name)
    planned = channel_of(vertebra, side)
    screws: tuple[ScrewPlan, ...] = ()
    if size_mm is not None:
        measure = pedicle_of(vertebra, side).used
        screws = (plan_screw(volume, planned.channel, measure, diameter_mm=size_mm[0], length_mm=size_mm[1]),)
    return _with(plan, _with_channel(vertebra, dataclasses.replace(planned, screws=screws)))


def with_reference(
    plan: PlanDocument,
    name: str,
    *,
    volume: Volume,
    slice_index: int,
    middle_lps_mm: npt.ArrayLike,
    apart_mm: float,
) -> PlanDocument:
    """Return the plan with the vertebra's reference slice, its three lines and the channel paths.

    Raises:
        PlanError: VERTEBRA_UNKNOWN, SLICE_OUTSIDE_CT, LINES_INVALID.
    """
    vertebra = vertebra_named(plan, name)
    reference = draw_reference(
        volume,
        slice_index=slice_index,
        middle_lps_mm=middle_lps_mm,
        apart_mm=apart_mm,
        channels=[one.channel for one in vertebra.channels],
    )
    return _with(plan, dataclasses.replace(vertebra, references=(reference,)))


def with_landmarks(
    plan: PlanDocument, name: str, landmarks: Sequence[Landmark], *, volume: Volume
) -> PlanDocument:
    """Return the plan with these landmarks instead of the present ones; empty removes all.

    Raises:
        PlanError: VERTEBRA_UNKNOWN, LANDMARK_TWICE, LANDMARK_OUTSIDE_CT.
    """
    changed = dataclasses.replace(vertebra_named(plan, name), landmarks=tuple(landmarks))
    reject_landmarks_outside(changed.landmarks, volume)
    return _with(plan, changed)


def recomputed(plan: PlanDocument, *, volume: Volume) -> PlanDocument:
    """Return an imported plan with all dependent values recomputed.

    Grades, clearances, bone density, tolerances and lines are recomputed from pedicles, channels and the
    sizes of the screws on this CT.

    Raises:
        PlanError: CHANNEL_OUTSIDE_CT, LANDMARK_OUTSIDE_CT, PEDICLE_MISSING, SLICE_OUTSIDE_CT, LINES_INVALID,
            SCREW_INVALID.
    """
    vertebrae = []
    for vertebra in plan.vertebrae:
        reject_landmarks_outside(vertebra.landmarks, volume)
        changed = vertebra
        for planned in vertebra.channels:
            reject_outside(planned.channel, volume)
            changed = _with_screw_recomputed(changed, planned.side, volume)
        vertebrae.append(_redrawn(changed, volume))
    return dataclasses.replace(plan, vertebrae=tuple(vertebrae))


def reject_outside(channel: Channel, volume: Volume) -> None:
    """Reject a channel that does not lie in the CT: it was planned on another one.

    Raises:
        PlanError: CHANNEL_OUTSIDE_CT.
    """
    ends = np.stack([channel.entry_in_vertebra_mm, channel.target_in_vertebra_mm])
    if not volume.contains(ends).all():
        raise PlanError(
            "CHANNEL_OUTSIDE_CT",
            f"channel '{channel.name}' runs from {_formatted(ends[0])} to {_formatted(ends[1])} mm, "
            "which is not all within the CT",
            "Give its ends in mm of this CT (LPS).",
            {
                "entry_lps_mm": ends[0].tolist(),
                "target_lps_mm": ends[1].tolist(),
                "channel": channel.name,
                "entry": _formatted(ends[0]),
                "target": _formatted(ends[1]),
            },
        )


def middle_of(reference: ReferenceSlice) -> Array:
    """Return the point (3,) that the middle line passes through."""
    start, end = next(line for line in reference.lines if line.name == "middle").ends_lps_mm
    return np.asarray(start + AHEAD_MM / (AHEAD_MM + MAX_BEHIND_ENTRY_MM) * (end - start))


def channel_name(vertebra: str, side: Side) -> str:
    """Return the display name of a channel."""
    return f"{vertebra} {side}"


def _with_updated_channel(
    vertebra: VertebraPlan, side: Side, volume: Volume, front_margin_mm: float
) -> VertebraPlan:
    """Return the vertebra with channel, screw and paths recomputed after a change of the pedicle."""
    planned = next((one for one in vertebra.channels if one.side == side), None)
    if planned is None:
        return vertebra
    if not planned.by_hand:
        measure = pedicle_of(vertebra, side).used
        channel = channel_from_measure(planned.channel.name, measure, front_margin_mm=front_margin_mm)
        planned = dataclasses.replace(planned, channel=channel)
    reject_outside(planned.channel, volume)
    return _redrawn(_with_screw_recomputed(_with_channel(vertebra, planned), side, volume), volume)


def _with_screw_recomputed(vertebra: VertebraPlan, side: Side, volume: Volume) -> VertebraPlan:
    planned = channel_of(vertebra, side)
    screws = tuple(
        plan_screw(
            volume,
            planned.channel,
            pedicle_of(vertebra, side).used,
            diameter_mm=screw.diameter_mm,
            length_mm=screw.length_mm,
        )
        for screw in planned.screws
    )
    return _with_channel(vertebra, dataclasses.replace(planned, screws=screws))


def _redrawn(vertebra: VertebraPlan, volume: Volume) -> VertebraPlan:
    references = tuple(
        draw_reference(
            volume,
            slice_index=one.slice_index,
            middle_lps_mm=middle_of(one),
            apart_mm=one.apart_mm,
            channels=[planned.channel for planned in vertebra.channels],
        )
        for one in vertebra.references
    )
    return dataclasses.replace(vertebra, references=references)


def _with_pedicle(vertebra: VertebraPlan, record: PedicleRecord) -> VertebraPlan:
    others = tuple(one for one in vertebra.pedicles if one.measured.side != record.measured.side)
    return dataclasses.replace(vertebra, pedicles=(*others, record))


def _with_channel(vertebra: VertebraPlan, planned: PlannedChannel) -> VertebraPlan:
    others = tuple(one for one in vertebra.channels if one.side != planned.side)
    return dataclasses.replace(vertebra, channels=(*others, planned))


def _with(plan: PlanDocument, vertebra: VertebraPlan) -> PlanDocument:
    return dataclasses.replace(
        plan, vertebrae=tuple(vertebra if one.name == vertebra.name else one for one in plan.vertebrae)
    )


def _formatted(point: Array) -> str:
    return "(" + ", ".join(f"{value:.1f}" for value in point) + ")"
