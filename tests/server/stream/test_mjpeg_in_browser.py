"""MJPEG in a real browser, which displays a part only when the next one begins."""

import time
from collections.abc import Callable

import numpy as np
import pytest
from fastapi import FastAPI
from playwright.sync_api import Browser

from server.live import Instant, LiveHub
from server.overlay import encode_jpeg
from tracker.navigation import NavigationSnapshot

pytestmark = pytest.mark.browser

# Whether the picture has this brightness.
IS_SHOWN = """bright => {
    const img = document.querySelector('img')
    if (!img || !img.naturalWidth) return false
    const canvas = new OffscreenCanvas(1, 1).getContext('2d')
    canvas.drawImage(img, 0, 0, 1, 1)
    return Math.abs(canvas.getImageData(0, 0, 1, 1).data[0] - bright) < 8
}"""


def test_the_browser_shows_an_image_without_waiting_for_the_next(
    browser: Browser,
    hub: LiveHub,
    patient_app: FastAPI,
    serve: Callable[[FastAPI], int],
    snapshot_of: Callable[..., NavigationSnapshot],
    instant_of: Callable[..., Instant],
) -> None:
    # No card during this test: it would be a next part and hide that the browser waits for one.
    port = serve(patient_app)

    def publish(sequence: int, bright: int) -> None:
        snapshot = snapshot_of(size_wh_px=(64, 36), captured_at_s=time.monotonic())
        jpeg = encode_jpeg(np.full((36, 64, 3), bright, np.uint8), 90)
        hub.publish(instant_of(sequence, snapshot=snapshot, jpeg=jpeg))

    publish(0, 40)
    page = browser.new_page()
    page.goto(f"http://127.0.0.1:{port}/api/docs")
    page.evaluate("document.body.innerHTML = '<img src=/video/main.mjpg>'")
    page.wait_for_function(IS_SHOWN, arg=40, timeout=9_000)
    publish(1, 220)
    page.wait_for_function(IS_SHOWN, arg=220, timeout=9_000)
