"""`coaxial certify plate` and `coaxial certify issue`."""

import json
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import typer

from server.camera_file import CameraFile, read_camera_file
from server.capture.address import source_from_text
from server.certificate import (
    Certificate,
    CertifiedAudit,
    ExaminedSystem,
    Issue,
    SigningKey,
    certificate_pdf,
    certified_faults,
    certified_figures,
    examine,
    fault_rows,
    figure_rows,
    printed_plate,
    printed_sheet,
    text_of_plate_file,
    tracked_tool_of,
)
from server.cli.board_options import size_of
from server.cli.certify_captures import load_captures, load_plate_file
from server.cli.output import problem_values, write_atomically
from server.clock import utc_now
from server.home_folder import home_folder
from server.latency import LatencyResult
from server.pose_file import Unit
from server.printing import pdf_from_sheet, svg_from_sheet
from server.security.audit.files import read_head_of
from server.store.latency_file import LatencyFile
from server.tool_file import load_tool_file
from tracker.accuracy import AccuracyAssessment, AccuracyLimits
from tracker.errors import InvalidInput

REJECTED = 1


@dataclass(frozen=True, slots=True, kw_only=True)
class PlateOptions:
    """Options of `coaxial certify plate`."""

    output: Path
    size: str
    pitch_mm: float
    name: str
    sd_mm: float
    paper: str


@dataclass(frozen=True, slots=True, kw_only=True)
class IssueOptions:
    """Options of `coaxial certify issue`."""

    captures: Path
    plate: Path
    camera: Path
    tool: Path
    rulers_mm: str | None
    ruler_sd_mm: float
    output: Path | None
    valid_days: int
    max_error_mm: float
    by: str
    unit: str
    version: str


def write_plate(options: PlateOptions) -> None:
    """Write the page and the plate file.

    Raises:
        InvalidInput: BOARD_FILE_UNKNOWN, OUTPUT_NOT_WRITABLE, PLATE_INVALID, PLATE_TOO_LARGE.
    """
    kind = options.output.suffix.lower()
    if kind not in (".pdf", ".svg"):
        raise InvalidInput(
            "BOARD_FILE_UNKNOWN",
            f"the file type of {options.output} is neither .pdf nor .svg",
            "Name the file with --output plate.pdf or --output plate.svg.",
            {"file": str(options.output)},
        )
    columns, rows = size_of("--size", options.size)
    file = printed_plate(columns, rows, pitch_mm=options.pitch_mm, name=options.name, sd_mm=options.sd_mm)
    sheet = printed_sheet(file, paper=options.paper)
    write_atomically(
        options.output, pdf_from_sheet(sheet) if kind == ".pdf" else svg_from_sheet(sheet).encode()
    )
    definition = options.output.with_suffix(".yaml")
    write_atomically(definition, text_of_plate_file(file).encode())
    typer.echo(
        f"Wrote {options.output}: {columns}x{rows} divots, pitch {options.pitch_mm:g} mm, and {definition}.\n"
        "Print it at 100 %, glue it flat on a rigid board, and measure both rulers."
    )


def issue_certificate(options: IssueOptions, *, as_json: bool) -> int:
    """Assess the captures, print the result, and write the certificate. Return 0, or 1 if it is refused.

    Raises:
        NavigationError: a file cannot be read or written, or the captures do not suffice.
    """
    camera, tool_file = read_camera_file(options.camera), load_tool_file(options.tool)
    plate_file = load_plate_file(options.plate)
    system = ExaminedSystem(
        camera=camera,
        marker=tool_file.marker,
        tool=tracked_tool_of(camera, tool_file),
        plate=plate_file,
        scale=plate_file.scale(_rulers(options.rulers_mm), sd_mm=options.ruler_sd_mm),
    )
    captures = load_captures(options.captures, tool_file, system.tool, unit=Unit(options.unit))
    home = home_folder()
    issue = Issue(
        at=utc_now(),
        valid_days=options.valid_days,
        by=options.by[:80],
        software_version=options.version,
        audit=_audit(home),
        latency=_latency(home, camera),
    )
    found = examine(captures, system, issue, limits=AccuracyLimits(max_error_95_mm=options.max_error_mm))
    certificate = found.certificate
    written = [] if certificate is None else _write(certificate, options.output)
    _print(found.assessment, certificate, written, as_json=as_json)
    return REJECTED if certificate is None else 0


def _write(certificate: Certificate, output: Path | None) -> list[Path]:
    if output is None:
        return []
    key = SigningKey(home_folder())
    signed = key.signed_json(certificate.json_values())
    pdf = certificate_pdf(certificate, signed, key)
    paths = [output.with_name(f"{output.name}.json"), output.with_name(f"{output.name}.pdf")]
    for path, content in zip(paths, (signed, pdf), strict=True):
        write_atomically(path, content)
    return paths


def _print(
    found: AccuracyAssessment, certificate: Certificate | None, written: Sequence[Path], *, as_json: bool
) -> None:
    if as_json:
        typer.echo(
            json.dumps(
                {
                    "certified": certificate is not None,
                    "problems": [problem_values(one) for one in found.problems],
                    **_values(found),
                    "certificate": None if certificate is None else certificate.json_values(),
                    "written": [str(path) for path in written],
                },
                allow_nan=False,
            )
        )
    else:
        for line in _lines(found):
            typer.echo(line)
        if certificate is not None:
            typer.echo(
                f"Certified to {certificate.error_95_mm:.2f} mm until {certificate.valid_until:%Y-%m-%d}."
            )
        for path in written:
            typer.echo(f"Wrote {path}.")
    if certificate is None:
        for problem in found.problems:
            typer.echo(f"Not certified: {problem.message}.\n{problem.remedy}", err=True)


def _values(found: AccuracyAssessment) -> dict[str, Any]:
    return {
        "error_95_mm": found.figures.error_95_mm,
        "figures": [one.model_dump(mode="json") for one in certified_figures(found)],
        "faults": [one.model_dump(mode="json") for one in certified_faults(found)],
    }


def _lines(found: AccuracyAssessment) -> list[str]:
    figures, faults = certified_figures(found), certified_faults(found)
    return [
        f"{found.captures} captures of {found.divots} divots in {found.placements} placements",
        f"95 % of single tips are within {found.figures.error_95_mm:.2f} mm (confidence 95 %)",
        *(f"{title}: {value} ({interval})" for title, value, interval, _ in figure_rows(figures)),
        *(
            f"{title}: {value} ({sd}), {'found' if fault.is_found else f'excluded above {limit}'}"
            for fault, (title, value, sd, limit) in zip(faults, fault_rows(faults), strict=True)
        ),
    ]


def _rulers(text: str | None) -> tuple[float, float] | None:
    if text is None:
        return None
    try:
        x, y = (float(word) for word in text.replace(",", " ").split())
    except ValueError:
        raise InvalidInput(
            "PLATE_RULERS_INVALID",
            f"--rulers-mm is '{text[:40]}'",
            "Give the lengths of the rulers across and down the page in mm, as --rulers-mm 99.9,100.1.",
        ) from None
    return x, y


def _audit(home: Path) -> CertifiedAudit | None:
    head = read_head_of(home)
    return None if head is None else CertifiedAudit(lines=head.count, sha256=head.sum)


def _latency(home: Path, camera: CameraFile) -> LatencyResult | None:
    if camera.camera_source is None or not home.exists():
        return None
    # Latencies are stored by the name of the source, as `defaults_from_config` does.
    return LatencyFile(home).of(source_from_text(camera.camera_source).name)
