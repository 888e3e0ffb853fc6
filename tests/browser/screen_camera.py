"""A camera that looks at the screen of a page: pictures of it as MJPEG over HTTP, with a known delay."""

import base64
import contextlib
import time
from collections import deque
from http.server import BaseHTTPRequestHandler
from typing import Any

import cv2
import numpy as np
from playwright.sync_api import Error as PlaywrightError
from playwright.sync_api import Page

from tests.server.capture.http_image_server import ImageServer

SIZE_WH_PX = (640, 400)
# Slow enough for a busy machine to deliver every image.
RATE_HZ = 6.0
HEAD = b"--x\r\nContent-Type: image/jpeg\r\nContent-Length: %d\r\n\r\n"
# Number of stored pictures of the screen; at 60 Hz, more than any delay of a test.
REMEMBERED = 240


class ScreenCamera(ImageServer):
    """Streams what the screen showed `delay_s` ago; grey before it watches a page.

    Attributes:
        delay_s: delay from the screen to the stream; may be changed while running.
        covered: whether the lens is covered.

    """

    def __init__(self) -> None:
        self.delay_s = 0.0
        self.covered = False
        self._seen: deque[tuple[float, bytes]] = deque(maxlen=REMEMBERED)
        super().__init__(_Stream)

    @property
    def address(self) -> str:
        """Address for `camera.source`."""
        return f"http://127.0.0.1:{self.server_address[1]}/screen.mjpg"

    def look_at(self, page: Page) -> None:
        """Capture the page with each refresh, as composed by the browser."""
        line = page.context.new_cdp_session(page)

        def take(shown: dict[str, Any]) -> None:
            ago_s = time.time() - float(shown["metadata"]["timestamp"])
            self._seen.append((time.monotonic() - ago_s, base64.b64decode(shown["data"])))
            # The last capture may be pending while the page is closed.
            with contextlib.suppress(PlaywrightError):
                line.send("Page.screencastFrameAck", {"sessionId": shown["sessionId"]})

        line.on("Page.screencastFrame", take)
        width, height = SIZE_WH_PX
        line.send(
            "Page.startScreencast", {"format": "jpeg", "quality": 80, "maxWidth": width, "maxHeight": height}
        )

    def image(self, number: int) -> bytes:
        """JPEG of the current image; no two are equal, as from a sensor."""
        seen_s = time.monotonic() - self.delay_s
        picture = next((jpeg for at_s, jpeg in reversed(self._seen.copy()) if at_s <= seen_s), None)
        image = np.full((SIZE_WH_PX[1], SIZE_WH_PX[0], 3), 90, np.uint8)
        if picture is not None and not self.covered:
            decoded = cv2.imdecode(np.frombuffer(picture, np.uint8), cv2.IMREAD_COLOR)
            if decoded is not None:
                image = np.ascontiguousarray(cv2.resize(decoded, SIZE_WH_PX), np.uint8)
        image[:8, :8] = 16 * (number % 16)
        return cv2.imencode(".jpg", image, [cv2.IMWRITE_JPEG_QUALITY, 85])[1].tobytes()


class _Stream(BaseHTTPRequestHandler):
    def log_message(self, format: str, *args: object) -> None:  # noqa: A002  the base's name
        del format, args

    def do_GET(self) -> None:
        camera = self.server
        assert isinstance(camera, ScreenCamera)
        self.send_response(200)
        self.send_header("Content-Type", "multipart/x-mixed-replace; boundary=x")
        self.end_headers()
        number, due_s = 0, time.monotonic()
        try:
            while not camera.ended.wait(max(0.0, due_s - time.monotonic())):
                content = camera.image(number)
                self.wfile.write(HEAD % len(content) + content + b"\r\n")
                number += 1
                due_s = max(due_s + 1.0 / RATE_HZ, time.monotonic())
        except OSError:
            pass
