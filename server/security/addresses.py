"""Addresses by which others reach this server."""

import ipaddress
import socket
from urllib.parse import urlsplit

# TEST-NET-3 (RFC 5737). Nothing is sent: a connected UDP socket only selects the outgoing address.
DOCUMENTATION_ADDRESS = ("203.0.113.1", 9)


def is_loopback(host: str) -> bool:
    """Return whether a host, with or without a port, is this computer alone."""
    try:
        name = urlsplit(f"//{host}").hostname or ""
    except ValueError:
        return False
    try:
        return ipaddress.ip_address(name).is_loopback
    except ValueError:
        return name == "localhost" or name.endswith(".localhost")


def link_name(address: str) -> str:
    """Return the host part of a link for a listening address; a wildcard becomes a reachable address."""
    if address in {"0.0.0.0", "::"}:  # noqa: S104  compared with, not listened on
        address = outbound_address() or "127.0.0.1"
    return f"[{address}]" if ":" in address else address


def outbound_address() -> str | None:
    """Return this machine's address on its outward network; None without a network."""
    try:
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as asking:
            asking.connect(DOCUMENTATION_ADDRESS)
            return str(asking.getsockname()[0])
    except OSError:
        return None


def link_host(host: str, *, listens_everywhere: bool) -> str:
    """Return the host of a link for others: as requested, unless that is a loopback address only.

    Args:
        host: the `Host` header of the request.
        listens_everywhere: whether the server listens on all addresses.
    """
    if not listens_everywhere or not is_loopback(host):
        return host
    address, port = outbound_address(), urlsplit(f"//{host}").port
    if address is None:
        return host
    return address if port is None else f"{address}:{port}"
