"""A viewer that requests an image and stops reading, and how long the server tolerates it."""

import select
import socket
import threading
import time

from tests.benchmarks.load.viewer_process import CREDIT_FRAME, SLOW_BUFFER_BYTES, UPGRADE

PATIENCE_S = 20.0


class StalledViewer:
    """Opens `/ws/view`, sends credit for one image, and never reads; a thread waits for the disconnect.

    Attributes:
        disconnected_after_s: from its request to the disconnect; None before.

    """

    def __init__(self, port: int) -> None:
        self.disconnected_after_s: float | None = None
        self._socket = socket.socket()
        self._socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, SLOW_BUFFER_BYTES // 4)
        self._socket.connect(("127.0.0.1", port))
        self._socket.sendall(f"GET /ws/view?size=full HTTP/1.1\r\nHost: 127.0.0.1\r\n{UPGRADE}\r\n".encode())
        self._socket.recv(64)
        self._socket.sendall(CREDIT_FRAME)
        self._requested_s = time.monotonic()
        self._waiting = threading.Thread(target=self._wait, daemon=True)
        self._waiting.start()

    def close(self) -> None:
        """Wait for the disconnect and close the socket."""
        self._waiting.join(PATIENCE_S)
        self._socket.close()

    def _wait(self) -> None:
        poller = select.poll()
        poller.register(self._socket, select.POLLHUP | select.POLLERR)
        if poller.poll(PATIENCE_S * 1e3):
            self.disconnected_after_s = time.monotonic() - self._requested_s
