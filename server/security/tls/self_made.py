"""A certificate that the server makes for itself: for its own names, kept until one of them changes."""

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

from server.security.audit.whole import write_private
from server.security.reach import own_address
from server.store.home import sync_folder

CERTIFICATE_FILE, KEY_FILE = "certificate.pem", "key.pem"
# Browsers refuse certificates that hold for longer, though not yet self-made ones.
LASTS = timedelta(days=397)
RENEWED_BEFORE_ITS_END = timedelta(days=30)
# Clocks of tablets are wrong by minutes.
SLACK = timedelta(hours=1)


@dataclass(frozen=True, slots=True, kw_only=True)
class SelfMade:
    """Where the certificate and its key lie."""

    certificate: Path
    key: Path


def kept_or_made(
    folder: Path, *, host: str, clock: Callable[[], datetime] = lambda: datetime.now(tz=UTC)
) -> SelfMade:
    """The certificate of this folder; a new one where there is none, it ends soon, or a name is missing.

    Raises:
        OSError: it cannot be kept.
    """
    folder.mkdir(mode=0o700, parents=True, exist_ok=True)
    found = SelfMade(certificate=folder / CERTIFICATE_FILE, key=folder / KEY_FILE)
    names, addresses = own_names(host)
    now = clock()
    if not _still_fits(found, names, addresses, now):
        _make(found, names, addresses, now)
        sync_folder(folder)
    return found


def own_names(host: str) -> tuple[list[str], list[str]]:
    """The names and addresses by which this machine is called."""
    machine = socket.gethostname().lower()
    names = ["localhost", machine, f"{machine.split('.')[0]}.local"]
    addresses = ["127.0.0.1", "::1"]
    outward = own_address()
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


def _still_fits(found: SelfMade, names: list[str], addresses: list[str], now: datetime) -> bool:
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
        and certificate.not_valid_before_utc <= now < certificate.not_valid_after_utc - RENEWED_BEFORE_ITS_END
        and set(names) <= set(named.get_values_for_type(x509.DNSName))
        and set(addresses) <= {str(one) for one in named.get_values_for_type(x509.IPAddress)}
    )


def _make(found: SelfMade, names: list[str], addresses: list[str], now: datetime) -> None:
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
        .not_valid_before(now - SLACK)
        .not_valid_after(now + LASTS)
        .add_extension(x509.SubjectAlternativeName(alternatives), critical=False)
        .add_extension(x509.BasicConstraints(ca=False, path_length=None), critical=True)
        .add_extension(x509.ExtendedKeyUsage([ExtendedKeyUsageOID.SERVER_AUTH]), critical=False)
        .sign(key, hashes.SHA256())
    )
    locked = serialization.NoEncryption()
    pem = serialization.Encoding.PEM
    # The key first: a certificate without its key is made anew at the next start.
    write_private(found.key, key.private_bytes(pem, serialization.PrivateFormat.PKCS8, locked))
    write_private(found.certificate, certificate.public_bytes(pem))
