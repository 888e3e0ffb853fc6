"""Guesses: how often somebody may show a token that does not exist."""

import ipaddress
import threading
from collections.abc import Callable

from server.security.people.often import Often

WINDOW_S = 60.0
MAX_OF_ONE = 10
MAX_OF_ALL = 100
MAX_ADDRESSES = 1000
ALL = "all"


class Guesses:
    """Counts wrong tokens by address and over all. Safe to use from any thread, and waits for no disk.

    Args:
        clock: monotonic, in seconds.
        max_of_one: wrong ones of one address within `WINDOW_S`.
        max_of_all: of all addresses together, also of those that are forgotten.
    """

    def __init__(
        self,
        *,
        clock: Callable[[], float],
        max_of_one: int = MAX_OF_ONE,
        max_of_all: int = MAX_OF_ALL,
    ) -> None:
        self._clock = clock
        self._of_one = Often(most=max_of_one, window_s=WINDOW_S, max_keys=MAX_ADDRESSES)
        self._of_all = Often(most=max_of_all, window_s=WINDOW_S)
        self._turn = threading.Lock()

    def wrong(self, address: str) -> float:
        """This address has shown a token that does not exist: 0, or how long it waits until one counts.

        A try while it waits is not counted, or who goes on trying would wait for ever.
        """
        now_s, network = self._clock(), _network(address)
        with self._turn:
            wait_s = max(self._of_one.wait_s(network, now_s), self._of_all.wait_s(ALL, now_s))
            if wait_s == 0.0:
                self._of_one.count(network, now_s)
                self._of_all.count(ALL, now_s)
        return wait_s


def _network(address: str) -> str:
    """An address of the old kind; of the new kind, the network that one household or ward has to itself."""
    try:
        found = ipaddress.ip_address(address.partition("%")[0])
    except ValueError:
        return address
    if isinstance(found, ipaddress.IPv6Address) and found.ipv4_mapped is None:
        return str(ipaddress.ip_network((int(found), 64), strict=False))
    return str(found)
