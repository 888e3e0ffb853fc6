"""Certificates that are installed in the home folder, one for each marker of a tool."""

import re
from pathlib import Path

import structlog

from server.certificate.signature import SigningKey, existing_signer, json_of
from server.certificate.validity import VerifiedCertificate, verified
from server.disk import sync_path
from server.store import translate_errors
from server.store.private_file import write_private
from tracker.errors import InvalidInput

FOLDER = "certificates"
# Names of markers, see `server.config.Name`; a name of a file must not lead out of the folder.
MARKER = re.compile(r"[A-Za-z0-9][A-Za-z0-9_-]{0,39}")
_log = structlog.get_logger(__name__)


class InstalledCertificates:
    """The newest certificate of each marker, as it was signed.

    Only certificates of this installation's key are accepted: anybody can sign others.

    Args:
        home: the home folder.
    """

    def __init__(self, home: Path) -> None:
        self._home = home
        self._folder = home / FOLDER

    def install(self, file: bytes) -> VerifiedCertificate:
        """Install a certificate, JSON or PDF; the one of the same marker is replaced.

        Raises:
            InvalidInput: CERTIFICATE_UNREADABLE, CERTIFICATE_ALTERED or CERTIFICATE_SIGNER_UNKNOWN.
            StoreError: it cannot be stored.
        """
        found = verified(file)
        marker = found.certificate.tool.marker
        if found.signer != existing_signer(self._home) or not MARKER.fullmatch(marker):
            raise InvalidInput(
                "CERTIFICATE_SIGNER_UNKNOWN",
                "the certificate is not signed by this installation",
                "Issue it with COAXIAL_HOME set to the folder of this server.",
                {"signer": found.signer},
            )
        with translate_errors(self._home):
            self._folder.mkdir(mode=0o700, exist_ok=True)
            write_private(self._file(marker), json_of(file))
            sync_path(self._folder)
        return found

    def all(self) -> tuple[VerifiedCertificate, ...]:
        """Return all certificates, by the name of the marker; damaged ones are logged and left out.

        Raises:
            StoreError: the folder cannot be read.
        """
        found = []
        signer = existing_signer(self._home)
        with translate_errors(self._home):
            files = sorted(self._folder.glob("*.json")) if self._folder.exists() else []
            contents = [(file, file.read_bytes()) for file in files]
        for file, content in contents:
            try:
                one = verified(content)
            except InvalidInput as error:
                _log.error("a certificate is damaged; install it again", file=str(file), code=error.code)
                continue
            if one.signer == signer and self._file(one.certificate.tool.marker) == file:
                found.append(one)
        return tuple(found)

    def of(self, marker: str) -> VerifiedCertificate | None:
        """Return the certificate of a marker; None if there is none.

        Raises:
            StoreError: the folder cannot be read.
        """
        return next((one for one in self.all() if one.certificate.tool.marker == marker), None)

    def signed_json(self, marker: str) -> bytes:
        """Return the file of an installed certificate."""
        with translate_errors(self._home):
            return self._file(marker).read_bytes()

    @property
    def key(self) -> SigningKey:
        """The key of this installation."""
        return SigningKey(self._home)

    def _file(self, marker: str) -> Path:
        return self._folder / f"{marker}.json"
