"""Guesses: how often somebody may show a token that does not exist."""

import ipaddress
import threading
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field

WINDOW_S = 60.0
MOST_OF_ONE = 10
MOST_OF_ALL = 100
MOST_ADDRESSES = 1000


@dataclass(slots=True, kw_only=True)
class Guesses:
    """Counts wrong tokens by address and over all. Safe to use from any thread, and waits for no disk.

    Attributes:
        clock: monotonic, in seconds.
        most_of_one: wrong ones of one address within `WINDOW_S`.
        most_of_all: of all addresses together.
    """

    clock: Callable[[], float]
    most_of_one: int = MOST_OF_ONE
    most_of_all: int = MOST_OF_ALL
    _by_address: dict[str, deque[float]] = field(default_factory=dict)
    _all: deque[float] = field(default_factory=deque)
    _turn: threading.Lock = field(default_factory=threading.Lock)

    def wrong(self, address: str) -> float:
        """This address has shown a token that does not exist: 0, or how long it waits until one counts.

        A try while it waits is not counted, or who goes on trying would wait for ever.
        """
        now_s, network = self.clock(), _network(address)
        with self._turn:
            wait_s = self._wait_s(network, now_s)
            if wait_s == 0.0:
                self._count(network, now_s)
        return wait_s

    def _wait_s(self, network: str, now_s: float) -> float:
        own = self._by_address.get(network, deque())
        return max(_wait_s(own, self.most_of_one, now_s), _wait_s(self._all, self.most_of_all, now_s))

    def _count(self, network: str, now_s: float) -> None:
        if network not in self._by_address and len(self._by_address) >= MOST_ADDRESSES:
            # The one that guessed first is let go; what all do together is counted all the same.
            del self._by_address[next(iter(self._by_address))]
        own = self._by_address.setdefault(network, deque(maxlen=self.most_of_one))
        own.append(now_s)
        self._all.append(now_s)
        while len(self._all) > self.most_of_all:
            self._all.popleft()


def _wait_s(times: deque[float], most: int, now_s: float) -> float:
    if len(times) < most:
        return 0.0
    return max(0.0, times[-most] + WINDOW_S - now_s)


def _network(address: str) -> str:
    """An address of the old kind; of the new kind, the network that one household or ward has to itself."""
    try:
        found = ipaddress.ip_address(address.partition("%")[0])
    except ValueError:
        return address
    if isinstance(found, ipaddress.IPv6Address) and found.ipv4_mapped is None:
        return str(ipaddress.ip_network((int(found), 64), strict=False))
    return str(found)
