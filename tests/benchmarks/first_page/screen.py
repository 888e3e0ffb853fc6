"""The theatre page on one screen, watched from inside it."""

import os
import time
from pathlib import Path

from playwright.sync_api import Browser

from tests.benchmarks.first_page.processes import processor_time, processor_use
from tests.benchmarks.first_page.report import PageMeasurement
from tests.benchmarks.first_page.stages import mean_stage_ms, stage_sums
from tests.benchmarks.running_server import RunningServer

PATIENCE_MS = 90_000
RECORDER = Path(__file__).with_name("recorder.js")


def measured_screen(
    browser: Browser,
    server: RunningServer,
    size_px: tuple[int, int],
    *,
    seconds: float,
    settling_s: float,
    screenshots: Path | None = None,
) -> PageMeasurement:
    """Return what a screen of this size displays, from `settling_s` after its first picture on.

    Args:
        browser: draws the page.
        server: of the page, without sign-in.
        size_px: width and height.
        seconds: how long it is watched.
        settling_s: time in which the page finds what this machine can draw.
        screenshots: folder for a picture of the page at the end.
    """
    width_px, height_px = size_px
    context = browser.new_context(viewport={"width": width_px, "height": height_px}, locale="en-GB")
    context.add_init_script(path=RECORDER)
    page = context.new_page()
    page.goto(f"http://127.0.0.1:{server.port}/theatre")
    page.wait_for_selector('[data-testid="video"][data-live="true"]', timeout=PATIENCE_MS)
    page.wait_for_timeout(1000 * settling_s)
    began_s, before = time.monotonic(), processor_time(server.pid, os.getpid())
    stages = stage_sums(server.port)
    page.evaluate("coaxialRecorder.begin()")
    page.wait_for_timeout(1000 * seconds)
    recorded = page.evaluate("coaxialRecorder.seen()")
    stage_ms = mean_stage_ms(stages, stage_sums(server.port))
    after, spent_s = processor_time(server.pid, os.getpid()), time.monotonic() - began_s
    if screenshots is not None:
        screenshots.mkdir(parents=True, exist_ok=True)
        page.screenshot(path=screenshots / f"first-page-{width_px}x{height_px}.png")
    context.close()
    return PageMeasurement.of(
        recorded,
        size_px=size_px,
        processor_use=processor_use(before, after, spent_s),
        stage_ms=stage_ms,
        load=load_text(),
    )


def unwatched_use(server: RunningServer, *, seconds: float, settling_s: float) -> dict[str, float]:
    """Return the share of one core by process of a server that nobody watches, after its first images."""
    time.sleep(settling_s)
    began_s, before = time.monotonic(), processor_time(server.pid, os.getpid())
    time.sleep(seconds)
    after = processor_time(server.pid, os.getpid())
    return processor_use(before, after, time.monotonic() - began_s)


def load_text() -> str:
    """Return the machine's load of the last minute."""
    return f"{os.getloadavg()[0]:.1f}"
