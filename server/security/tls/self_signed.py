"""A self-signed certificate for the server's own names, stored until one of them changes."""

import ipaddress
import socket
from collections.abc import Callable
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from pathlib import Path

from cryptography import x509
from cryptography.exceptions import InvalidSignature
from cryptography.hazmat.primitives import hashes, serialization
from cryptography.hazmat.primitives.asymmetric import ec
from cryptography.x509.oid import ExtendedKeyUsageOID, NameOID

from server.disk import sync_path
from server.security.addresses import outbound_address
from server.store.private_file import write_private

CERTIFICATE_FILE, KEY_FILE = "certificate.pem", "key.pem"
# Browsers reject certificates with a longer validity, though not yet self-signed ones.
VALID_FOR = timedelta(days=397)
RENEWED_BEFORE_EXPIRY = timedelta(days=30)
# Clocks of tablets are off by minutes.
CLOCK_TOLERANCE = timedelta(hours=1)


@dataclass(frozen=True, slots=True, kw_only=True)
class SelfSignedCertificate:
    """Files of the certificate and its key."""

    certificate: Path
    key: Path


def load_or_create(
    folder: Path, *, host: str, clock: Callable[[], datetime] = lambda: datetime.now(tz=UTC)
) -> SelfSignedCertificate:
    """Return the certificate of this folder; make a new one if it is missing, expires soon, or lacks a name.

    Raises:
        OSError: it cannot be stored.
    """
    folder.mkdir(mode=0o700, parents=True, exist_ok=True)
    found = SelfSignedCertificate(certificate=folder / CERTIFICATE_FILE, key=folder / KEY_FILE)
    names, addresses = own_names(host)
    now = clock()
    if not _is_usable(found, names, addresses, now):
        _make(found, names, addresses, now)
        sync_path(folder)
    return found


def own_names(host: str) -> tuple[list[str], list[str]]:
    """Return the names and addresses of this machine."""
    machine = socket.gethostname().lower()
    names = ["localhost", machine, f"{machine.split('.')[0]}.local"]
    addresses = ["127.0.0.1", "::1"]
    outward = outbound_address()
    for one in (host.lower(), outward):
        if one is None:
            continue
        try:
            address = ipaddress.ip_address(one)
        except ValueError:
            names.append(one)
        else:
            if not address.is_unspecified:
                addresses.append(str(address))
    return list(dict.fromkeys(names)), list(dict.fromkeys(addresses))


def _is_usable(found: SelfSignedCertificate, names: list[str], addresses: list[str], now: datetime) -> bool:
    try:
        certificate = x509.load_pem_x509_certificate(found.certificate.read_bytes())
        key = serialization.load_pem_private_key(found.key.read_bytes(), password=None)
        if found.key.stat().st_mode & 0o077:
            # Somebody else may have read it.
            return False
        certificate.verify_directly_issued_by(certificate)
        named = certificate.extensions.get_extension_for_class(x509.SubjectAlternativeName).value
    except (OSError, ValueError, TypeError, InvalidSignature, x509.ExtensionNotFound):
        return False
    raw = serialization.Encoding.DER, serialization.PublicFormat.SubjectPublicKeyInfo
    return (
        key.public_key().public_bytes(*raw) == certificate.public_key().public_bytes(*raw)
        and certificate.not_valid_before_utc <= now < certificate.not_valid_after_utc - RENEWED_BEFORE_EXPIRY
        and set(names) <= set(named.get_values_for_type(x509.DNSName))
        and set(addresses) <= {str(one) for one in named.get_values_for_type(x509.IPAddress)}
    )


def _make(found: SelfSignedCertificate, names: list[str], addresses: list[str], now: datetime) -> None:
    key = ec.generate_private_key(ec.SECP256R1())
    subject = x509.Name([x509.NameAttribute(NameOID.COMMON_NAME, f"Coaxial on {names[1]}"[:64])])
    alternatives: list[x509.GeneralName] = [x509.DNSName(name) for name in names]
    alternatives += [x509.IPAddress(ipaddress.ip_address(address)) for address in addresses]
    certificate = (
        x509.CertificateBuilder()
        .subject_name(subject)
        .issuer_name(subject)
        .public_key(key.public_key())
        .serial_number(x509.random_serial_number())
        .not_valid_before(now - CLOCK_TOLERANCE)
        .not_valid_after(now + VALID_FOR)
        .add_extension(x509.SubjectAlternativeName(alternatives), critical=False)
        .add_extension(x509.BasicConstraints(ca=False, path_length=None), critical=True)
        .add_extension(x509.ExtendedKeyUsage([ExtendedKeyUsageOID.SERVER_AUTH]), critical=False)
        .sign(key, hashes.SHA256())
    )
    locked = serialization.NoEncryption()
    pem = serialization.Encoding.PEM
    # The key first: a certificate without its key is remade at the next start.
    write_private(found.key, key.private_bytes(pem, serialization.PrivateFormat.PKCS8, locked))
    write_private(found.certificate, certificate.public_bytes(pem))
