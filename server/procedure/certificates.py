"""Whether the accuracy of the tools in use is certified, by the certificates of this installation."""

from dataclasses import dataclass
from typing import TypeVar

from server.certificate import (
    CameraInUse,
    Certificate,
    InstalledCertificates,
    SystemInUse,
    ToolInUse,
    certificate_pdf,
    invalidities,
)
from server.clock import Clock, utc_now
from server.live import LiveHub
from server.procedure.divot_capture import reject_uncalibrated
from server.procedure.markers import MarkerStep
from server.store import NotFound
from tracker.errors import InvalidInput
from tracker.navigation import NavigationSnapshot
from tracker.pose import ToolModel

Missing = TypeVar("Missing", NotFound, InvalidInput)


@dataclass(frozen=True, slots=True, kw_only=True)
class ToolCertification:
    """Whether one tool in use is certified.

    Attributes:
        tool: name of the tool.
        marker: name of its marker.
        certificate: the installed certificate of this marker, valid or not; None without one.
        problem: why the tool is not certified; None if it is.
    """

    tool: str
    marker: str
    certificate: Certificate | None
    problem: InvalidInput | None


class CertificateStep:
    """Compares the installed certificates with camera and tools of the newest image. Thread-safe.

    Args:
        hub: the live images.
        installed: the certificates.
        markers: the tracked markers, with their sides.
        software_version: version of this program.
        clock: wall clock, in UTC.
    """

    def __init__(
        self,
        *,
        hub: LiveHub,
        installed: InstalledCertificates,
        markers: MarkerStep,
        software_version: str,
        clock: Clock = utc_now,
    ) -> None:
        self._hub = hub
        self._installed = installed
        self._markers = markers
        self._software_version = software_version
        self._clock = clock

    def tools(self) -> tuple[ToolCertification, ...]:
        """Return the tools in use, by name; empty before the first image.

        Raises:
            StoreError: the certificates cannot be read.
        """
        newest = self._hub.newest
        if newest is None or newest.snapshot is None:
            return ()
        snapshot, device = newest.snapshot, newest.source.device
        certificates = {one.certificate.tool.marker: one.certificate for one in self._installed.all()}
        sides_mm = {known.name: known.side_mm for known in self._markers.known()}
        found = []
        for name, tool in sorted(snapshot.setup.tools.items()):
            certificate, side_mm = certificates.get(tool.marker), sides_mm.get(tool.marker)
            problem = self._problem(certificate, snapshot, tool, side_mm=side_mm, device=device)
            found.append(
                ToolCertification(tool=name, marker=tool.marker, certificate=certificate, problem=problem)
            )
        return tuple(found)

    def install(self, file: bytes) -> None:
        """Install a certificate. Raises as `InstalledCertificates.install`."""
        self._installed.install(file)

    def signed_json(self, marker: str) -> bytes:
        """Return the installed certificate of a marker as JSON.

        Raises:
            NotFound: CERTIFICATE_MISSING.
        """
        self._certificate(marker)
        return self._installed.signed_json(marker)

    def signed_pdf(self, marker: str) -> bytes:
        """Return the installed certificate of a marker as PDF, with the JSON attached.

        Raises:
            NotFound: CERTIFICATE_MISSING.
        """
        certificate = self._certificate(marker)
        return certificate_pdf(certificate, self._installed.signed_json(marker), self._installed.key)

    def _certificate(self, marker: str) -> Certificate:
        found = self._installed.of(marker)
        if found is None:
            raise _missing(NotFound, marker)
        return found.certificate

    def _problem(
        self,
        certificate: Certificate | None,
        snapshot: NavigationSnapshot,
        tool: ToolModel,
        *,
        side_mm: float | None,
        device: str,
    ) -> InvalidInput | None:
        if certificate is None:
            return _missing(InvalidInput, tool.marker)
        try:
            reject_uncalibrated(snapshot)
        except InvalidInput as error:
            return error
        system = SystemInUse(
            camera=CameraInUse(model=snapshot.setup.camera, device=device or None),
            # A side that is not known equals no other.
            tool=ToolInUse(
                marker=tool.marker,
                side_mm=-1.0 if side_mm is None else side_mm,
                tip_in_marker_mm=tool.marker_from_tool.translation_mm,
            ),
            software_version=self._software_version,
        )
        return next(iter(invalidities(certificate, system, now=self._clock())), None)


def _missing(kind: type[Missing], marker: str) -> Missing:
    return kind(
        "CERTIFICATE_MISSING",
        f"no accuracy certificate is installed for the marker '{marker[:40]}'",
        "Do the accuracy test, and install its certificate.",
        {"marker": marker[:40]},
    )
