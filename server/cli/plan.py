"""`coaxial plan measure`: reads a CT, has a pedicle measured, and says the numbers."""

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import typer

from server.cli.options import Given, config_from_options
from server.imaging import read_ct
from tracker.errors import InvalidInput, PlanError
from tracker.plan import (
    Channel,
    PedicleMeasure,
    ScrewCatalogue,
    ScrewPlan,
    Volume,
    channel_from_measure,
    measure_pedicle,
    plan_screw,
    propose_screw,
)
from tracker.plan.document import plain

MACHINE_KEYS = ("width_mm", "height_mm", "transverse_deg", "sagittal_deg", "length_mm")
FRAME = (
    "patient LPS; transverse_deg positive to the middle, sagittal_deg positive to the head, going forwards"
)


@dataclass(frozen=True, slots=True, kw_only=True)
class MeasureOrder:
    """What was typed."""

    ct: Path
    side: str
    seed_lps_mm: str
    series: str | None = None
    config: Path | None = None


def measure_in_file(order: MeasureOrder, *, as_json: bool) -> None:
    """Measure one pedicle and write its numbers to standard output.

    Raises:
        InvalidInput: SEED_INVALID, SIDE_INVALID, or a code beginning with CT_.
        PlanError: the click holds no pedicle that can be measured.
    """
    seed = seed_from_text(order.seed_lps_mm)
    settings = config_from_options(Given(config=order.config)).plan
    catalogue = ScrewCatalogue(
        diameters_mm=tuple(settings.screw_diameters_mm), lengths_mm=tuple(settings.screw_lengths_mm)
    )
    ct = read_ct(order.ct, series=order.series)
    measure = measure_pedicle(ct.volume, seed, order.side)
    warnings = [*ct.warnings, *measure.warnings]
    channel, screw = None, None
    try:
        channel = channel_from_measure(order.side, measure, front_margin_mm=settings.front_margin_mm)
        screw = _screw(
            ct.volume, channel, measure, catalogue, settings.wall_margin_mm, settings.front_margin_mm
        )
    except PlanError as error:
        # The pedicle is measured all the same; that no screw fits belongs to its numbers.
        warnings.append(error.message)
    if as_json:
        typer.echo(json.dumps(_mapping(measure, channel, screw, warnings)))
    else:
        typer.echo("\n".join(_lines(measure, screw, warnings)))


def seed_from_text(text: str) -> tuple[float, float, float]:
    """The point of `x,y,z`, with commas or spaces.

    Raises:
        InvalidInput: SEED_INVALID.
    """
    try:
        x, y, z = (float(word) for word in text.replace(",", " ").split())
    except ValueError as error:
        raise InvalidInput(
            "SEED_INVALID",
            f"--seed-lps-mm is '{text}', needed three numbers",
            "Give x,y,z in mm, as --seed-lps-mm=-12.5,40,-803.",
            {"seed_lps_mm": text},
        ) from error
    return x, y, z


def _screw(
    volume: Volume,
    channel: Channel,
    measure: PedicleMeasure,
    catalogue: ScrewCatalogue,
    wall_margin_mm: float,
    front_margin_mm: float,
) -> ScrewPlan:
    diameter, length = propose_screw(
        channel, measure, catalogue, wall_margin_mm=wall_margin_mm, front_margin_mm=front_margin_mm
    )
    return plan_screw(volume, channel, measure, diameter_mm=diameter, length_mm=length)


def _mapping(
    measure: PedicleMeasure, channel: Channel | None, screw: ScrewPlan | None, warnings: list[str]
) -> dict[str, Any]:
    whole = plain(measure)
    return {
        "side": measure.side,
        **{key: whole[key] for key in MACHINE_KEYS},
        "isthmus_lps_mm": whole["isthmus_lps_mm"],
        "axis_lps": whole["axis_lps"],
        "entry_lps_mm": whole["entry_lps_mm"],
        "front_lps_mm": whole["front_lps_mm"],
        "seed_lps_mm": whole["seed_lps_mm"],
        "cortex_mm": whole["cortex_mm"],
        "sd": whole["sd"],
        "angles_against": FRAME,
        "channel": None if channel is None else plain(channel),
        "screw": None if screw is None else plain(screw),
        "warnings": warnings,
    }


def _lines(measure: PedicleMeasure, screw: ScrewPlan | None, warnings: list[str]) -> list[str]:
    sd = measure.sd
    x, y, z = measure.isthmus_lps_mm
    lines = [
        f"{measure.side.capitalize()} pedicle, at its isthmus ({x:.1f}, {y:.1f}, {z:.1f} mm LPS)",
        f"  width       {measure.width_mm:6.2f} mm   (sd {sd.width_mm:.2f})",
        f"  height      {measure.height_mm:6.2f} mm   (sd {sd.height_mm:.2f})",
        f"  transverse  {measure.transverse_deg:6.1f} deg  (sd {sd.transverse_deg:.1f}), + to the middle",
        f"  sagittal    {measure.sagittal_deg:6.1f} deg  (sd {sd.sagittal_deg:.1f}), + to the head",
        f"  length      {measure.length_mm:6.1f} mm   (sd {sd.length_mm:.1f}), entry to front wall",
        "  Angles stand against the patient's axes (LPS), going forwards.",
    ]
    if screw is not None:
        room, left = screw.clearance, screw.tolerance
        lines += [
            f"Screw {screw.diameter_mm:g} x {screw.length_mm:g} mm: grade {room.grade.value}",
            f"  clearance   medial {room.medial_mm:.1f}, lateral {room.lateral_mm:.1f}, "
            f"superior {room.superior_mm:.1f}, inferior {room.inferior_mm:.1f}, "
            f"front {room.anterior_mm:.1f} mm",
            f"  bone        {screw.bone.mean_hu:.0f} HU along it, least {screw.bone.min_hu:.0f} HU",
            f"  tolerance   {left.max_offset_mm:.1f} mm at the entry or {left.max_angle_deg:.1f} deg, "
            f"or {left.both_mm:.1f} mm with {left.both_deg:.1f} deg",
        ]
    return [*lines, *(f"Note: {warning.removesuffix('.')}." for warning in warnings)]
