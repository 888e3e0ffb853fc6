"""`coaxial certify check`: verify a certificate, here or elsewhere."""

import json
from dataclasses import dataclass
from pathlib import Path

import typer

from server.camera_file import read_camera_file
from server.certificate import (
    CameraInUse,
    SystemInUse,
    ToolInUse,
    VerifiedCertificate,
    existing_signer,
    invalidities,
    verified,
)
from server.certificate.signature import MAX_BYTES, REMEDY
from server.cli.output import problem_values
from server.clock import utc_now
from server.home_folder import home_folder
from server.tool_file import load_tool_file
from tracker.errors import InvalidInput

NOT_VALID = 1


@dataclass(frozen=True, slots=True, kw_only=True)
class CheckOptions:
    """Options of `coaxial certify check`."""

    file: Path
    signer: str | None
    camera: Path | None
    tool: Path | None
    version: str


def check_certificate(options: CheckOptions, *, as_json: bool) -> int:
    """Print the result of all checks. Return the exit status: 0, or 1 if the certificate is not valid.

    Raises:
        InvalidInput: the file is no certificate, was altered, or another file cannot be read.
    """
    found = read_certificate(options.file)
    certificate = found.certificate
    system = SystemInUse(
        camera=None if options.camera is None else CameraInUse.of_file(read_camera_file(options.camera)),
        tool=None if options.tool is None else ToolInUse.of_file(load_tool_file(options.tool)),
        software_version=None if options.camera is None and options.tool is None else options.version,
    )
    problems = [
        *_signer_problems(found.signer, options.signer),
        *invalidities(certificate, system, now=utc_now()),
    ]
    if as_json:
        typer.echo(
            json.dumps(
                {
                    "valid": not problems,
                    "problems": [problem_values(one) for one in problems],
                    "signer": found.signer,
                    "certificate": certificate.json_values(),
                }
            )
        )
    else:
        typer.echo(
            f"Unaltered. Certified to {certificate.error_95_mm:.2f} mm until "
            f"{certificate.valid_until:%Y-%m-%d}, issued {certificate.issued_at:%Y-%m-%d} by "
            f"{certificate.issued_by or 'a person without a name'}, Coaxial {certificate.software_version}"
        )
        typer.echo(
            f"Marker {certificate.tool.marker}, {certificate.tool.side_mm:g} mm; signer {found.signer}"
        )
        typer.echo("NOT VALID." if problems else "Valid.")
    for problem in problems:
        typer.echo(f"Not valid: {problem.message}.\n{problem.remedy}", err=True)
    return NOT_VALID if problems else 0


def read_certificate(path: Path) -> VerifiedCertificate:
    """Read a certificate, JSON or PDF, and verify its signature.

    Raises:
        InvalidInput: CERTIFICATE_UNREADABLE or CERTIFICATE_ALTERED.
    """
    try:
        if path.stat().st_size > MAX_BYTES:
            raise InvalidInput(
                "CERTIFICATE_UNREADABLE",
                f"{path} is no certificate: it has more than {MAX_BYTES / 1e6:.0f} MB",
                REMEDY,
                {"file": str(path)},
            )
        return verified(path.read_bytes())
    except OSError as error:
        raise InvalidInput(
            "CERTIFICATE_UNREADABLE",
            f"{path} cannot be read: {(error.strerror or str(error)).lower()}",
            REMEDY,
            {"file": str(path)},
        ) from error


def _signer_problems(signer: str, expected: str | None) -> list[InvalidInput]:
    known = expected.strip().lower() if expected is not None else existing_signer(home_folder())
    if known == signer:
        return []
    return [
        InvalidInput(
            "CERTIFICATE_SIGNER_UNKNOWN",
            "it is signed by an unknown key" if known is None else "it is signed by another key",
            "Get the public key of the issuer in another way ('coaxial certify signer' prints it there), and "
            "give it with --signer.",
            {"signer": signer},
        )
    ]
