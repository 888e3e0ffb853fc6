"""Parsing of the address of a source, without opening the source."""

import re
from dataclasses import dataclass
from enum import StrEnum
from urllib.parse import urlsplit

from server.plugins import SOURCE_PREFIX

INDUSTRIAL_SCHEMES = ("basler", "genicam")
STREAM_SCHEMES = ("rtsp", "rtsps", "rtmp", "http", "https", "udp", "tcp")


class SourceKind(StrEnum):
    """Kinds of sources."""

    REHEARSAL = "rehearsal"
    OPENIGTLINK = "openigtlink"  # an external tracker, which sends poses and no images
    PHONE = "phone"  # phone or tablet, whose page sends the images of its camera
    LOCAL_CAMERA = "local camera"
    INDUSTRIAL_CAMERA = "industrial camera"
    STREAM = "stream"
    PLUGIN = "plugin"  # source of another package
    PATH = "path"  # video file or folder, decided when it is opened, because it may not exist yet


@dataclass(frozen=True, slots=True, kw_only=True)
class SourceAddress:
    """A requested source of images.

    Attributes:
        kind: Its kind.
        text: The text with any password; never displayed.
        name: Display name: the text with passwords masked.
    """

    kind: SourceKind
    text: str
    name: str


def source_from_text(text: str | int) -> SourceAddress:
    """Parse a source: rehearsal, openigtlink, phone, camera, stream, plug-in, or path."""
    plain = str(text).strip()
    if plain.lower() == "openigtlink":
        return SourceAddress(kind=SourceKind.OPENIGTLINK, text="openigtlink", name="openigtlink")
    if plain.lower() == "rehearsal":
        return SourceAddress(kind=SourceKind.REHEARSAL, text="rehearsal", name="rehearsal")
    if plain.lower() == "phone":
        return SourceAddress(kind=SourceKind.PHONE, text="phone", name="phone")
    if plain.isascii() and plain.isdecimal():
        return SourceAddress(
            kind=SourceKind.LOCAL_CAMERA, text=plain, name=f"camera {plain.lstrip('0') or '0'}"
        )
    if re.match(r"^/dev/", plain):
        return SourceAddress(kind=SourceKind.LOCAL_CAMERA, text=plain, name=plain)
    library, colon, serial = plain.partition(":")
    if colon and library.lower() in INDUSTRIAL_SCHEMES:
        text = f"{library.lower()}:{serial.strip()}"
        return SourceAddress(kind=SourceKind.INDUSTRIAL_CAMERA, text=text, name=text)
    if plain.startswith(SOURCE_PREFIX):
        # The address after the second colon may contain a password.
        name = ":".join(plain.split(":", 2)[:2])
        return SourceAddress(kind=SourceKind.PLUGIN, text=plain, name=name)
    scheme = plain.partition("://")[0].lower()
    if "://" in plain and scheme in STREAM_SCHEMES:
        return SourceAddress(kind=SourceKind.STREAM, text=plain, name=mask_secrets(plain))
    return SourceAddress(kind=SourceKind.PATH, text=plain, name=plain)


def mask_secrets(address: str) -> str:
    """Return an address with its credentials and secret query parameters replaced by ***.

    A user name is shown only if a password follows, because alone it may be the secret. If a password
    contains / ? or #, which end the host part of the address early, everything before the @ is masked.
    """
    try:
        parts = urlsplit(address)
    except ValueError:
        return f"{address.partition('://')[0]}://***"
    place = parts.netloc
    if "@" in place:
        login, _, host = place.rpartition("@")
        user, colon, _ = login.partition(":")
        place = f"{user}:***@{host}" if colon else f"***@{host}"
    elif "@" in address:
        return f"{parts.scheme}://***@{_without_secrets(address.rpartition('@')[2])}"
    return parts._replace(netloc=place, query=_without_secrets(parts.query)).geturl()


def _without_secrets(query: str) -> str:
    return re.sub(r"(?i)\b([^=&]*(?:pass|pwd|token|key|secret|auth|sig)[^=&]*)=[^&]*", r"\1=***", query)
