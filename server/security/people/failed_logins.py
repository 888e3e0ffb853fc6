"""Rate limit of failed sign-ins."""

import ipaddress
import threading
from collections.abc import Callable

from server.security.people.rate_limiter import RateLimiter

WINDOW_S = 60.0
MAX_PER_ADDRESS = 10
MAX_TOTAL = 100
MAX_ADDRESSES = 1000
ALL = "all"


class FailedLogins:
    """Counts unknown tokens by address and in total. Thread-safe; does not wait for the disk.

    Args:
        clock: monotonic, in seconds.
        max_per_address: failures of one address within `WINDOW_S`.
        max_total: failures of all addresses together, also of those that are dropped.
    """

    def __init__(
        self,
        *,
        clock: Callable[[], float],
        max_per_address: int = MAX_PER_ADDRESS,
        max_total: int = MAX_TOTAL,
    ) -> None:
        self._clock = clock
        self._per_address = RateLimiter(max_count=max_per_address, window_s=WINDOW_S, max_keys=MAX_ADDRESSES)
        self._total = RateLimiter(max_count=max_total, window_s=WINDOW_S)
        self._lock = threading.Lock()

    def wrong(self, address: str) -> float:
        """Count an unknown token of this address; return 0, or the waiting time until one counts again.

        Attempts during the waiting time are not counted, or repeated attempts would extend it forever.
        """
        now_s, network = self._clock(), _network(address)
        with self._lock:
            wait_s = max(self._per_address.wait_s(network, now_s), self._total.wait_s(ALL, now_s))
            if wait_s == 0.0:
                self._per_address.count(network, now_s)
                self._total.count(ALL, now_s)
        return wait_s


def _network(address: str) -> str:
    """Return an IPv4 address, or the /64 network of an IPv6 address, which belongs to one site."""
    try:
        found = ipaddress.ip_address(address.partition("%")[0])
    except ValueError:
        return address
    if isinstance(found, ipaddress.IPv6Address) and found.ipv4_mapped is None:
        return str(ipaddress.ip_network((int(found), 64), strict=False))
    return str(found)
