"""Validity of a certificate: by time, and by what it was issued for."""

from collections.abc import Mapping
from dataclasses import dataclass
from datetime import UTC, datetime

import numpy as np
import numpy.typing as npt

from server.camera_file import CameraFile, controls_values
from server.certificate.content import (
    Certificate,
    CertifiedCamera,
    CertifiedTool,
    calibration_sha256,
    certificate_from,
)
from server.certificate.signature import verified_json, verified_pdf
from server.tool_file import ToolFile
from tracker.camera import CameraModel
from tracker.errors import InvalidInput

# Values are written with eight digits.
SAME_MM = 1e-5
REMEDY = "Repeat the accuracy test, and issue a new certificate."


@dataclass(frozen=True, slots=True, kw_only=True)
class VerifiedCertificate:
    """A certificate whose signature is valid, with the public key that signed it."""

    certificate: Certificate
    signer: str


@dataclass(frozen=True, slots=True, kw_only=True)
class CameraInUse:
    """A camera to compare with a certificate; a value of None is unknown, and not compared.

    Attributes:
        model: the calibration.
        name, source, device, controls, readout_ms: as in `CameraFile`.
    """

    model: CameraModel
    name: str | None = None
    source: str | None = None
    device: str | None = None
    controls: Mapping[str, int] | None = None
    readout_ms: float | None = None

    @classmethod
    def of_file(cls, file: CameraFile) -> "CameraInUse":
        """Return the camera of a camera file."""
        return cls(
            model=file.model,
            name=file.camera_name,
            source=file.camera_source,
            device=file.device or None,
            controls=controls_values(file.controls),
            readout_ms=file.readout_ms,
        )

    def differs_from(self, certified: CertifiedCamera) -> bool:
        """Return whether the certificate is of another camera, lens or calibration."""
        pairs = (
            (self.name, certified.name),
            (self.source, certified.source),
            (self.device, certified.device),
            (self.controls, certified.controls),
            (self.readout_ms, certified.readout_ms),
        )
        return calibration_sha256(self.model) != certified.calibration_sha256 or any(
            here is not None and here != there for here, there in pairs
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class ToolInUse:
    """A tool to compare with a certificate."""

    marker: str
    side_mm: float
    tip_in_marker_mm: npt.ArrayLike

    @classmethod
    def of_file(cls, file: ToolFile) -> "ToolInUse":
        """Return the tool of a tool file."""
        return cls(marker=file.marker, side_mm=file.side_mm, tip_in_marker_mm=file.pivot.tip_in_marker_mm)

    def differs_from(self, certified: CertifiedTool) -> bool:
        """Return whether the certificate is of another marker or tip."""
        here = [self.side_mm, *np.asarray(self.tip_in_marker_mm, dtype=np.float64)]
        there = [certified.side_mm, *certified.tip_in_marker_mm]
        return self.marker != certified.marker or not np.allclose(here, there, rtol=0.0, atol=SAME_MM)


@dataclass(frozen=True, slots=True, kw_only=True)
class SystemInUse:
    """What a certificate is compared with; None where it is not compared."""

    camera: CameraInUse | None = None
    tool: ToolInUse | None = None
    software_version: str | None = None


def verified(file: bytes) -> VerifiedCertificate:
    """Verify the signature of a certificate, JSON or PDF.

    Raises:
        InvalidInput: CERTIFICATE_UNREADABLE or CERTIFICATE_ALTERED.
    """
    values, signer = verified_pdf(file) if file.startswith(b"%PDF") else verified_json(file)
    return VerifiedCertificate(certificate=certificate_from(values), signer=signer)


def invalidities(certificate: Certificate, system: SystemInUse, *, now: datetime) -> list[InvalidInput]:
    """Return the reasons why a certificate is not valid now, for this system; empty if it is."""
    found = []
    now = now.astimezone(UTC)
    if now >= certificate.valid_until:
        found.append(
            InvalidInput(
                "CERTIFICATE_EXPIRED",
                f"the certificate was valid until {certificate.valid_until:%Y-%m-%d}",
                REMEDY,
                {"valid_until": certificate.valid_until},
            )
        )
    if now < certificate.issued_at:
        found.append(
            InvalidInput(
                "CERTIFICATE_FROM_THE_FUTURE",
                f"the certificate was issued at {certificate.issued_at:%Y-%m-%d %H:%M} UTC, after the time "
                "of this computer",
                "Set the clock of this computer.",
                {"issued_at": certificate.issued_at},
            )
        )
    if system.camera is not None and system.camera.differs_from(certificate.camera):
        found.append(
            InvalidInput(
                "CERTIFICATE_CAMERA_CHANGED",
                "the camera, its lens or its calibration has changed since the certificate was issued",
                REMEDY,
            )
        )
    if system.tool is not None and system.tool.differs_from(certificate.tool):
        found.append(
            InvalidInput(
                "CERTIFICATE_TOOL_CHANGED",
                "the tool, its marker or its calibration has changed since the certificate was issued",
                REMEDY,
            )
        )
    version = system.software_version
    if version is not None and version != certificate.software_version:
        found.append(
            InvalidInput(
                "CERTIFICATE_SOFTWARE_CHANGED",
                f"the certificate was issued with version {certificate.software_version[:20]} of Coaxial, in "
                f"use is {version[:20]}",
                REMEDY,
                {"certified": certificate.software_version[:20], "version": version[:20]},
            )
        )
    return found
