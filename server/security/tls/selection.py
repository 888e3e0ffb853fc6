"""Whether this server uses TLS, and with which certificate: never plain text on a shared network."""

import hashlib
import ssl
from dataclasses import dataclass
from pathlib import Path
from typing import NoReturn

from server.config import Config
from server.errors import ConfigError
from server.security.addresses import is_loopback

CERTIFICATE_REMEDY = (
    "Give certificate and key as PEM files under server.tls, the key without a password; or omit both, and "
    "the server creates its own."
)
PROXY_SPEAKS_TLS = "a proxy speaks TLS for this server"


@dataclass(frozen=True, slots=True, kw_only=True)
class Tls:
    """A usable certificate.

    Attributes:
        certificate: its PEM file.
        key: PEM file of its key.
        fingerprint: its SHA-256, in pairs with colons, as browsers show it.
        is_self_signed: whether this server made it; a browser asks whether to trust it.
    """

    certificate: Path
    key: Path
    fingerprint: str
    is_self_signed: bool


def reject_unsafe(config: Config) -> None:
    """Reject unsafe settings; call it before anything is started.

    Raises:
        ConfigError: SIGN_IN_NEEDED, TLS_HALF, OPENIGTLINK_UNENCRYPTED, TRACKER_UNENCRYPTED,
            DICOM_UNENCRYPTED, HUB_UNENCRYPTED.
    """
    host, tls = config.server.host, config.server.tls
    if config.security.sign_in == "off" and not is_loopback(_bracketed(host)):
        raise ConfigError(
            "SIGN_IN_NEEDED",
            f"security.sign_in is off, but other computers can reach server.host {host}: everybody in the "
            "network could change the plan",
            "Set security.sign_in to required, or server.host to 127.0.0.1.",
            {"host": host},
        )
    if config.security.sign_in == "off" and config.server.behind_proxy is not None:
        raise ConfigError(
            "SIGN_IN_NEEDED",
            "security.sign_in is off, but with server.behind_proxy others can reach this server through a "
            "proxy, and could change the plan",
            "Set security.sign_in to required, or server.behind_proxy to null.",
            {"behind_proxy": config.server.behind_proxy},
        )
    link = config.openigtlink
    if link.port is not None and link.unencrypted is None and not is_loopback(_bracketed(link.host)):
        raise ConfigError(
            "OPENIGTLINK_UNENCRYPTED",
            f"other computers can reach openigtlink.host {link.host}, but OpenIGTLink has neither encryption "
            "nor sign-in",
            "Set openigtlink.host to 127.0.0.1, or openigtlink.unencrypted to exactly 'anybody who reaches "
            "this port reads the poses'.",
            {"host": link.host},
        )
    tracker = config.external_tracker
    if tracker is not None and tracker.unencrypted is None and not is_loopback(_bracketed(tracker.host)):
        raise ConfigError(
            "TRACKER_UNENCRYPTED",
            f"external_tracker.host is {tracker.host}, another computer, but OpenIGTLink has neither "
            "encryption nor sign-in: whoever is on the way could change the poses",
            "Run Plus on this computer, use an SSH tunnel, or set external_tracker.unencrypted to exactly "
            "'anybody on this network can change the poses'.",
            {"host": tracker.host},
        )
    receive = config.dicom.receive
    is_plain = not receive.tls and receive.unencrypted is None
    if receive.port is not None and is_plain and not is_loopback(_bracketed(receive.host)):
        raise ConfigError(
            "DICOM_UNENCRYPTED",
            f"other computers can reach dicom.receive.host {receive.host}, but dicom.receive.tls is false: "
            "CTs would cross the network readable to anybody",
            "Set dicom.receive.tls to true, or dicom.receive.unencrypted to exactly 'anybody on this network "
            "reads the patients' data'.",
            {"host": receive.host},
        )
    hub = config.hub
    scheme, _, hub_host = (hub.url or "").partition("://")
    if scheme == "nats" and not is_loopback(hub_host):
        if hub.unencrypted is None:
            raise ConfigError(
                "HUB_UNENCRYPTED",
                f"hub.url is {hub.url}: pictures and figures of the theatre would cross the network readable "
                "to anybody",
                "Write tls:// in hub.url, or set hub.unencrypted to exactly 'anybody on this network reads "
                "the theatres'.",
                {"url": hub.url},
            )
        if hub.requests:
            raise ConfigError(
                "HUB_UNENCRYPTED",
                f"hub.requests is true, but hub.url is {hub.url} without encryption: anybody on this network "
                "could read the supervisors' sessions, and act as they may",
                "Write tls:// in hub.url, or set hub.requests to false.",
                {"url": hub.url},
            )
    if hub.requests and config.security.sign_in == "off":
        raise ConfigError(
            "SIGN_IN_NEEDED",
            "hub.requests is true, but security.sign_in is off: anybody at the hub could act in this theatre",
            "Set security.sign_in to required, or hub.requests to false.",
            {"url": hub.url},
        )
    cosign = config.supervision.cosign
    if config.security.sign_in == "off" and "required" in (cosign.plan, cosign.registration):
        raise ConfigError(
            "SIGN_IN_NEEDED",
            "supervision.cosign requires the signature of a second person, but security.sign_in is off: no "
            "signer is known to be another person, so that navigation would never start",
            "Set security.sign_in to required, or supervision.cosign to offered.",
            {"plan": cosign.plan, "registration": cosign.registration},
        )
    if (tls.certificate is None) != (tls.key is None):
        given, missing = ("certificate", "key") if tls.key is None else ("key", "certificate")
        raise ConfigError(
            "TLS_HALF",
            f"server.tls.{given} is given, but server.tls.{missing} is not",
            CERTIFICATE_REMEDY,
            {"missing": missing},
        )


def select_tls(config: Config, folder: Path) -> Tls | None:
    """Return the certificate to serve with; None without TLS: on loopback, and behind a TLS proxy.

    Args:
        config: address, and optionally a certificate.
        folder: storage of a self-signed one.

    Raises:
        ConfigError: CERTIFICATE_UNUSABLE.
        OSError: the self-signed one cannot be stored.
    """
    server = config.server
    if server.tls.certificate is not None and server.tls.key is not None:
        return _own(server.tls.certificate, server.tls.key)
    if is_loopback(_bracketed(server.host)) or server.behind_proxy == PROXY_SPEAKS_TLS:
        return None
    return _self_signed(folder, server.host)


def select_dicom_tls(config: Config, folder: Path) -> Tls | None:
    """Return the certificate to receive DICOM with; None without TLS.

    Raises:
        ConfigError: CERTIFICATE_UNUSABLE.
        OSError: the self-signed one cannot be stored.
    """
    given, receive = config.server.tls, config.dicom.receive
    if not receive.tls:
        return None
    if given.certificate is not None and given.key is not None:
        return _own(given.certificate, given.key)
    return _self_signed(folder / "dicom", receive.host)


def _self_signed(folder: Path, host: str) -> Tls:
    # Imported on demand: most servers listen on loopback.
    from server.security.tls.self_signed import load_or_create  # noqa: PLC0415

    made = load_or_create(folder, host=host)
    return Tls(
        certificate=made.certificate,
        key=made.key,
        fingerprint=fingerprint_of(made.certificate.read_text(encoding="ascii")),
        is_self_signed=True,
    )


def fingerprint_of(pem: str) -> str:
    """Return the SHA-256 of the first certificate in a PEM text, as browsers show it."""
    first = pem[pem.index("-----BEGIN CERTIFICATE-----") :].split("-----END CERTIFICATE-----", maxsplit=1)[0]
    der = ssl.PEM_cert_to_DER_cert(f"{first}-----END CERTIFICATE-----\n")
    return ":".join(f"{byte:02X}" for byte in hashlib.sha256(der).digest())


def _own(certificate: Path, key: Path) -> Tls:
    """Return a given certificate, if it can be served."""
    for file, what in ((certificate, "certificate"), (key, "key")):
        try:
            text = file.read_text(encoding="utf-8")
        except OSError as error:
            _reject_certificate(
                f"the TLS {what} {file} cannot be read: {(error.strerror or str(error)).lower()}", file
            )
        except UnicodeDecodeError:
            _reject_certificate(f"the TLS {what} {file} is no PEM file", file)
        if "-----BEGIN" not in text:
            _reject_certificate(f"the TLS {what} {file} is no PEM file", file)
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
    try:
        # Otherwise the password of a key would be requested on the terminal.
        context.load_cert_chain(certificate, key, password=_no_password)
        fingerprint = fingerprint_of(certificate.read_text(encoding="utf-8"))
    except _PasswordRequired:
        _reject_certificate(f"the TLS key {key} is protected by a password", key)
    except ssl.SSLError as error:
        mismatch = "MISMATCH" in (error.reason or "")
        problem = f"does not match the key {key}" if mismatch else "cannot be used with its key"
        _reject_certificate(
            f"the TLS certificate {certificate} {problem} ({error.reason or error})", certificate
        )
    except ValueError:
        _reject_certificate(f"there is no certificate in {certificate}", certificate)
    return Tls(certificate=certificate, key=key, fingerprint=fingerprint, is_self_signed=False)


class _PasswordRequired(Exception):
    """The key is encrypted with a password."""


def _no_password() -> NoReturn:
    raise _PasswordRequired


def _reject_certificate(message: str, file: Path) -> NoReturn:
    raise ConfigError("CERTIFICATE_UNUSABLE", message, CERTIFICATE_REMEDY, {"file": str(file)})


def _bracketed(host: str) -> str:
    return f"[{host}]" if ":" in host and not host.startswith("[") else host
