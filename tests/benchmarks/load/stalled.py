"""A viewer that asks and then takes nothing, and how long the server puts up with it."""

import select
import socket
import threading
import time

from tests.benchmarks.load.crowd import GRANT_FRAME, THIN_BUFFER_BYTES, UPGRADE

PATIENCE_S = 20.0


class Stalled:
    """Opens `/ws/view`, grants one image, and never reads on; a thread waits for the end of the line.

    Attributes:
        let_go_after_s: from its question to the end of its line; None while that stands.
    """

    def __init__(self, port: int) -> None:
        self.let_go_after_s: float | None = None
        self._line = socket.socket()
        self._line.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, THIN_BUFFER_BYTES // 4)
        self._line.connect(("127.0.0.1", port))
        self._line.sendall(f"GET /ws/view?size=full HTTP/1.1\r\nHost: 127.0.0.1\r\n{UPGRADE}\r\n".encode())
        self._line.recv(64)
        self._line.sendall(GRANT_FRAME)
        self._asked_s = time.monotonic()
        self._waiting = threading.Thread(target=self._wait, daemon=True)
        self._waiting.start()

    def close(self) -> None:
        """Go, and know how it ended."""
        self._waiting.join(PATIENCE_S)
        self._line.close()

    def _wait(self) -> None:
        poller = select.poll()
        poller.register(self._line, select.POLLHUP | select.POLLERR)
        if poller.poll(PATIENCE_S * 1e3):
            self.let_go_after_s = time.monotonic() - self._asked_s
