"""Validity of a certificate: by time, and by what it was issued for."""

from dataclasses import dataclass
from datetime import UTC, datetime

from server.camera_file import CameraFile
from server.certificate.content import Certificate, certificate_from, certified_camera, certified_tool
from server.certificate.signature import verified_json, verified_pdf
from server.tool_file import ToolFile
from tracker.errors import InvalidInput

REMEDY = "Repeat the accuracy test, and issue a new certificate."


@dataclass(frozen=True, slots=True, kw_only=True)
class VerifiedCertificate:
    """A certificate whose signature is valid, with the public key that signed it."""

    certificate: Certificate
    signer: str


@dataclass(frozen=True, slots=True, kw_only=True)
class SystemInUse:
    """What a certificate is compared with; None where it is not compared."""

    camera: CameraFile | None = None
    tool: ToolFile | None = None
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
    if system.camera is not None and certified_camera(system.camera).sha256 != certificate.camera.sha256:
        found.append(
            InvalidInput(
                "CERTIFICATE_CAMERA_CHANGED",
                "the camera, its lens or its calibration has changed since the certificate was issued",
                REMEDY,
            )
        )
    if system.tool is not None and certified_tool(system.tool).sha256 != certificate.tool.sha256:
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
