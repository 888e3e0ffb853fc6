"""By which address others reach this server."""

import ipaddress
import socket
from urllib.parse import urlsplit

# In a network that is nobody's. Nothing is sent: the system only says by which of its addresses it would.
NOWHERE = ("203.0.113.1", 9)


def is_loopback(host: str) -> bool:
    """Whether a host, with or without a port, leads to this computer alone."""
    try:
        name = urlsplit(f"//{host}").hostname or ""
    except ValueError:
        return False
    try:
        return ipaddress.ip_address(name).is_loopback
    except ValueError:
        return name == "localhost" or name.endswith(".localhost")


def shown_name(address: str) -> str:
    """How an address that is listened on is written into a link: for all of them, one that others reach."""
    if address in {"0.0.0.0", "::"}:  # noqa: S104  compared with, not listened on
        address = own_address() or "127.0.0.1"
    return f"[{address}]" if ":" in address else address


def own_address() -> str | None:
    """This machine's address in the network that leads outside; None where there is no network."""
    try:
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as asking:
            asking.connect(NOWHERE)
            return str(asking.getsockname()[0])
    except OSError:
        return None


def shown_host(host: str, *, listens_everywhere: bool) -> str:
    """The host for a link that others open: as it was asked for, unless that leads nowhere but here.

    Args:
        host: the `Host` of the request.
        listens_everywhere: the server has other addresses, too.
    """
    if not listens_everywhere or not is_loopback(host):
        return host
    address, port = own_address(), urlsplit(f"//{host}").port
    if address is None:
        return host
    return address if port is None else f"{address}:{port}"
