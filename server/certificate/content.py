"""Content of a certificate: what was measured, how well, with what, and until when it is valid."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from hashlib import sha256
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, ValidationError

from server.camera_file import CameraFile, controls_values
from server.certificate.plate_file import PlateFile
from server.certificate.signature import canonical_json
from server.latency import LatencyResult
from server.tool_file import ToolFile
from tracker.accuracy import (
    AccuracyAssessment,
    DivotCapture,
    PlateScale,
    TrackedTool,
    volume_map,
)
from tracker.camera import CameraModel
from tracker.errors import InvalidInput

MAX_VALID_DAYS = 366
STANDARD = "ASTM F2554 (positional accuracy of computer assisted surgical systems), adapted to one camera"


class CertificatePart(BaseModel):
    """Base of the parts of a certificate."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)


class CertifiedFigure(CertificatePart):
    """A figure with its 95 % confidence interval; the unit is the ending of its name."""

    name: str
    value: float
    low: float
    high: float
    samples: int


class CertifiedFault(CertificatePart):
    """Estimate of a fault: its value, standard deviation and upper 95 % limit; mm for a tip, else a ratio."""

    fault: str
    value: tuple[float, ...]
    sd: float
    max_size: float
    is_found: bool
    """Whether it is significant; one that is within the limits does not prevent a certificate."""


class CertifiedDivot(CertificatePart):
    """Errors at one divot of one placement, in mm."""

    placement: str
    divot: str
    bias_mm: float
    spread_mm: float
    captures: int


class CertifiedVolume(CertificatePart):
    """Box of the captured tips in the camera's frame, and the predicted error around it."""

    min_mm: tuple[float, float, float]
    max_mm: tuple[float, float, float]
    tips_xz_mm: tuple[tuple[float, float], ...]
    map_x_mm: tuple[float, ...]
    map_z_mm: tuple[float, ...]
    map_error_95_mm: tuple[tuple[float | None, ...], ...]
    """One row for each z; null where the marker is not in view."""


class CertifiedCamera(CertificatePart):
    """The camera with its lens and calibration."""

    name: str | None
    source: str | None
    device: str
    controls: dict[str, int]
    readout_ms: float | None
    size_wh_px: tuple[int, int]
    focal_px: tuple[float, float]
    calibration_sha256: str
    """Of the canonical JSON of matrix, distortion and size_wh_px."""


class CertifiedTool(CertificatePart):
    """The tool: its marker and its tip. The test does not examine its axis."""

    marker: str
    side_mm: float
    tip_in_marker_mm: tuple[float, float, float]


class CertifiedPlate(CertificatePart):
    """The plate and its measured scale."""

    name: str
    divots: int
    sd_mm: float
    scale_x_ratio: float
    scale_y_ratio: float
    scale_sd_ratio: float
    sha256: str


class CertifiedLatency(CertificatePart):
    """Latency from light to page, as last measured with this camera; not measured by the plate."""

    median_ms: float
    p99_ms: float
    samples: int
    uncertainty_ms: float
    """Half an image period and the bound of the clock error."""
    measured_at: str


class CertifiedAudit(CertificatePart):
    """End of the audit log when the certificate was issued."""

    lines: int
    sha256: str


class Certificate(CertificatePart):
    """An accuracy certificate."""

    kind: Literal["coaxial accuracy certificate"] = "coaxial accuracy certificate"
    standard: str = STANDARD
    issued_at: datetime
    valid_until: datetime
    issued_by: Annotated[str, Field(max_length=80)]
    software_version: str
    error_95_mm: float
    """With a confidence of 95 %, 95 % of single tips are at most this far from the truth, in the volume."""
    placements: int
    divots: int
    captures: int
    figures: tuple[CertifiedFigure, ...]
    max_distance_error_mm: float
    faults: tuple[CertifiedFault, ...]
    errors_by_divot: tuple[CertifiedDivot, ...]
    volume: CertifiedVolume
    camera: CertifiedCamera
    tool: CertifiedTool
    plate: CertifiedPlate
    latency: CertifiedLatency | None
    audit: CertifiedAudit | None

    def json_values(self) -> dict[str, Any]:
        """Return the values as they are signed."""
        return self.model_dump(mode="json")


@dataclass(frozen=True, slots=True, kw_only=True)
class Issue:
    """Circumstances of the issue of a certificate."""

    at: datetime
    valid_days: int
    by: str
    software_version: str
    audit: CertifiedAudit | None
    latency: LatencyResult | None


@dataclass(frozen=True, slots=True, kw_only=True)
class ExaminedSystem:
    """Camera, tool and plate of a test.

    Attributes:
        camera: the camera, as in its file.
        marker: name of the marker on the tool.
        tool: camera, marker and tip for the assessment.
        plate: the plate, as in its file.
        scale: its measured scale; None for a printed plate that nobody measured, which is never certified.
    """

    camera: CameraFile
    marker: str
    tool: TrackedTool
    plate: PlateFile
    scale: PlateScale | None


def tracked_tool_of(camera: CameraFile, tool: ToolFile) -> TrackedTool:
    """Return camera, marker and tip of files."""
    return TrackedTool(
        camera=camera.model,
        side_mm=tool.side_mm,
        tip_in_marker_mm=np.array(tool.pivot.tip_in_marker_mm),
        tip_covariance_mm2=np.array(tool.pivot.covariance_mm2),
    )


def certificate_of(
    found: AccuracyAssessment, captures: Sequence[DivotCapture], system: ExaminedSystem, issue: Issue
) -> Certificate:
    """Return the certificate of a test without problems.

    Raises:
        InvalidInput: CERTIFICATE_REFUSED, the test has problems; CERTIFICATE_PERIOD_INVALID.
    """
    scale = system.scale
    if found.problems or scale is None:
        raise InvalidInput(
            "CERTIFICATE_REFUSED",
            f"an accuracy test with {len(found.problems)} problems is not certified",
            "Correct what the test found, and repeat it.",
            {"problems": len(found.problems)},
        )
    if not 1 <= issue.valid_days <= MAX_VALID_DAYS:
        raise InvalidInput(
            "CERTIFICATE_PERIOD_INVALID",
            f"a certificate cannot be valid for {issue.valid_days} days, allowed 1 to {MAX_VALID_DAYS}",
            "Repeat the test at least once a year.",
            {"days": issue.valid_days, "max_days": MAX_VALID_DAYS},
        )
    at = issue.at.astimezone(UTC).replace(microsecond=0)
    return Certificate(
        issued_at=at,
        valid_until=at + timedelta(days=issue.valid_days),
        issued_by=issue.by,
        software_version=issue.software_version,
        error_95_mm=round_up(found.figures.error_95_mm),
        placements=found.placements,
        divots=found.divots,
        captures=found.captures,
        figures=certified_figures(found),
        max_distance_error_mm=round(found.figures.max_distance_error_mm, 3),
        faults=certified_faults(found),
        errors_by_divot=tuple(
            CertifiedDivot(
                placement=one.placement,
                divot=one.divot,
                bias_mm=round(one.bias_mm, 3),
                spread_mm=round(one.spread_mm, 3),
                captures=one.captures,
            )
            for one in found.figures.divots
        ),
        volume=_volume(found, captures, system),
        camera=certified_camera(system.camera),
        tool=certified_tool(system.marker, system.tool),
        plate=_plate(system.plate, scale),
        latency=None if issue.latency is None else _latency(issue.latency),
        audit=issue.audit,
    )


def certified_figures(found: AccuracyAssessment) -> tuple[CertifiedFigure, ...]:
    """Return the figures of a test, also of one that is refused."""
    return tuple(
        CertifiedFigure(
            name=one.name.value,
            value=round(one.estimate.value, 4),
            low=round(one.estimate.low, 4),
            high=round(one.estimate.high, 4),
            samples=one.samples,
        )
        for one in found.figures.figures
    )


def certified_faults(found: AccuracyAssessment) -> tuple[CertifiedFault, ...]:
    """Return the estimated faults of a test, also of one that is refused."""
    return tuple(
        CertifiedFault(
            fault=one.fault.value,
            value=tuple(round(value, 6) for value in one.value),
            sd=round(one.sd, 6),
            max_size=round(one.max_size, 6),
            is_found=one.is_found,
        )
        for one in found.diagnosis.estimates
    )


def certificate_from(values: Mapping[str, Any]) -> Certificate:
    """Return a certificate from its signed values.

    Raises:
        InvalidInput: CERTIFICATE_UNREADABLE, it is of a version with other fields.
    """
    try:
        return Certificate.model_validate(values)
    except ValidationError as error:
        raise InvalidInput(
            "CERTIFICATE_UNREADABLE",
            f"the certificate has {error.error_count()} values that this version does not know",
            "Check it with the version of Coaxial that issued it.",
            {"values": error.error_count()},
        ) from None


def round_up(value_mm: float) -> float:
    """Return a bound with two decimals that is not smaller."""
    return float(np.ceil(value_mm * 100.0 - 1e-9) / 100.0)


def certified_camera(file: CameraFile) -> CertifiedCamera:
    """Return what a certificate states of a camera."""
    model = file.model
    return CertifiedCamera(
        name=file.camera_name,
        source=file.camera_source,
        device=file.device,
        controls=controls_values(file.controls),
        readout_ms=file.readout_ms,
        size_wh_px=model.size_wh_px,
        focal_px=(float(model.matrix[0, 0]), float(model.matrix[1, 1])),
        calibration_sha256=calibration_sha256(model),
    )


def calibration_sha256(model: CameraModel) -> str:
    """Return the SHA-256 of every parameter of a camera model."""
    return _sha256(
        {
            "matrix": model.matrix.tolist(),
            "distortion": model.distortion.tolist(),
            "size_wh_px": list(model.size_wh_px),
        }
    )


def certified_tool(marker: str, tool: TrackedTool) -> CertifiedTool:
    """Return what a certificate states of a tool."""
    x, y, z = tool.tip_in_marker_mm.tolist()
    return CertifiedTool(marker=marker, side_mm=tool.side_mm, tip_in_marker_mm=(x, y, z))


def _plate(plate: PlateFile, scale: PlateScale) -> CertifiedPlate:
    return CertifiedPlate(
        name=plate.name,
        divots=len(plate.divots),
        sd_mm=plate.sd_mm,
        scale_x_ratio=round(scale.x_ratio, 6),
        scale_y_ratio=round(scale.y_ratio, 6),
        scale_sd_ratio=round(scale.sd_ratio, 6),
        sha256=_sha256(plate.model_dump(mode="json")),
    )


def _latency(measured: LatencyResult) -> CertifiedLatency:
    report = measured.report
    return CertifiedLatency(
        median_ms=round(report.median_ms, 1),
        p99_ms=round(report.p99_ms, 1),
        samples=report.samples,
        uncertainty_ms=round(report.image_period_ms / 2.0 + report.clock_error_ms, 1),
        measured_at=measured.at,
    )


def _volume(
    found: AccuracyAssessment, captures: Sequence[DivotCapture], system: ExaminedSystem
) -> CertifiedVolume:
    volume = volume_map(captures, system.tool, error_95_mm=found.figures.error_95_mm)
    low, high = (
        tuple(round(float(value), 1) for value in corner)
        for corner in (found.volume_min_mm, found.volume_max_mm)
    )
    return CertifiedVolume(
        min_mm=(low[0], low[1], low[2]),
        max_mm=(high[0], high[1], high[2]),
        tips_xz_mm=tuple(
            (round(float(one.tip_in_camera_mm[0]), 1), round(float(one.tip_in_camera_mm[2]), 1))
            for one in captures
        ),
        map_x_mm=tuple(round(float(x), 1) for x in volume.x_mm),
        map_z_mm=tuple(round(float(z), 1) for z in volume.z_mm),
        map_error_95_mm=tuple(
            tuple(round(float(one), 2) if np.isfinite(one) else None for one in row)
            for row in volume.error_95_mm
        ),
    )


def _sha256(values: Mapping[str, Any]) -> str:
    return sha256(canonical_json(values)).hexdigest()
