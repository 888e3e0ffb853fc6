"""`coaxial plan measure`: measure a pedicle on a CT."""

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import typer

from server.cli.markups_output import write_markups
from server.cli.options import SettingOptions, config_from_options
from server.cli.output import problem_values, remark_text
from server.imaging.ct_reader import read_ct
from server.slicer_file import channel_markup, screw_markup
from tracker.errors import InvalidInput, PlanError, Remark
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
FRAME = "patient LPS, looking anteriorly; transverse_deg positive medially, sagittal_deg positive cranially"


@dataclass(frozen=True, slots=True, kw_only=True)
class MeasureOptions:
    """Options of `coaxial plan measure`."""

    ct: Path
    side: str
    seed_lps_mm: str
    series: str | None = None
    config: Path | None = None
    markups: Path | None = None


def measure_in_file(options: MeasureOptions, *, as_json: bool) -> None:
    """Measure one pedicle and write its numbers to standard output, and its channel to a file of markups.

    Raises:
        InvalidInput: SEED_INVALID, SIDE_INVALID, or a code beginning with CT_.
        PlanError: no pedicle can be measured at this point; or, with a file of markups, it has no channel.
    """
    seed = seed_from_text(options.seed_lps_mm)
    settings = config_from_options(SettingOptions(config=options.config)).plan
    catalogue = ScrewCatalogue(
        diameters_mm=tuple(settings.screw_diameters_mm), lengths_mm=tuple(settings.screw_lengths_mm)
    )
    ct = read_ct(options.ct, series=options.series)
    measure = measure_pedicle(ct.volume, seed, options.side)
    warnings = [*ct.warnings, *measure.warnings]
    channel, screw = None, None
    try:
        channel = channel_from_measure(options.side, measure, front_margin_mm=settings.front_margin_mm)
        screw = _screw(
            ct.volume, channel, measure, catalogue, settings.wall_margin_mm, settings.front_margin_mm
        )
    except PlanError as error:
        if channel is None and options.markups is not None:
            raise
        # The measurement is valid although no screw fits.
        warnings.append(Remark(code=error.code, message=error.message, remedy=error.remedy))
    if channel is not None and options.markups is not None:
        lines = [channel_markup(channel)]
        if screw is not None:
            lines.append(screw_markup(channel, diameter_mm=screw.diameter_mm, length_mm=screw.length_mm))
        write_markups(options.markups, lines)
    if as_json:
        typer.echo(json.dumps(_mapping(measure, channel, screw, warnings)))
    else:
        typer.echo("\n".join(_lines(measure, screw, warnings)))


def seed_from_text(text: str) -> tuple[float, float, float]:
    """Parse `x,y,z`, separated by commas or spaces.

    Raises:
        InvalidInput: SEED_INVALID.
    """
    try:
        x, y, z = (float(word) for word in text.replace(",", " ").split())
    except ValueError as error:
        raise InvalidInput(
            "SEED_INVALID",
            f"--seed-lps-mm is '{text}', expected three numbers",
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
    measure: PedicleMeasure, channel: Channel | None, screw: ScrewPlan | None, warnings: list[Remark]
) -> dict[str, Any]:
    values = plain(measure)
    return {
        "side": measure.side,
        **{key: values[key] for key in MACHINE_KEYS},
        "isthmus_lps_mm": values["isthmus_lps_mm"],
        "axis_lps": values["axis_lps"],
        "entry_lps_mm": values["entry_lps_mm"],
        "front_lps_mm": values["front_lps_mm"],
        "seed_lps_mm": values["seed_lps_mm"],
        "cortex_mm": values["cortex_mm"],
        "sd": values["sd"],
        "angles_against": FRAME,
        "channel": None if channel is None else plain(channel),
        "screw": None if screw is None else plain(screw),
        "warnings": [problem_values(one) for one in warnings],
    }


def _lines(measure: PedicleMeasure, screw: ScrewPlan | None, warnings: list[Remark]) -> list[str]:
    sd = measure.sd
    x, y, z = measure.isthmus_lps_mm
    lines = [
        f"{measure.side.capitalize()} pedicle, at its isthmus ({x:.1f}, {y:.1f}, {z:.1f} mm LPS)",
        f"  width       {measure.width_mm:6.2f} mm   (sd {sd.width_mm:.2f})",
        f"  height      {measure.height_mm:6.2f} mm   (sd {sd.height_mm:.2f})",
        f"  transverse  {measure.transverse_deg:6.1f} deg  (sd {sd.transverse_deg:.1f}), + medial",
        f"  sagittal    {measure.sagittal_deg:6.1f} deg  (sd {sd.sagittal_deg:.1f}), + cranial",
        f"  length      {measure.length_mm:6.1f} mm   (sd {sd.length_mm:.1f}), to the anterior cortex",
        "  Angles are relative to the patient axes (LPS), looking anteriorly.",
    ]
    if screw is not None:
        clearance, tolerance = screw.clearance, screw.tolerance
        lines += [
            f"Screw {screw.diameter_mm:g} x {screw.length_mm:g} mm: grade {clearance.grade.value}",
            f"  clearance   medial {clearance.medial_mm:.1f}, lateral {clearance.lateral_mm:.1f}, "
            f"superior {clearance.superior_mm:.1f}, inferior {clearance.inferior_mm:.1f}, "
            f"anterior {clearance.anterior_mm:.1f} mm",
            f"  bone        {screw.bone.mean_hu:.0f} HU mean, minimum {screw.bone.min_hu:.0f} HU",
            f"  tolerance   {tolerance.max_offset_mm:.1f} mm at the entry or "
            f"{tolerance.max_angle_deg:.1f} deg, "
            f"or {tolerance.both_mm:.1f} mm with {tolerance.both_deg:.1f} deg",
        ]
    return [*lines, *(f"Note: {remark_text(one)}" for one in warnings)]
