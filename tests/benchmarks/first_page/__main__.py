"""Frame rate and latency of the theatre page in a browser without a graphics card, on this machine.

python -m tests.benchmarks.first_page [--seconds 60] [--sizes 1920x1080,390x844]

Starts a server with the rehearsal at its defaults and a headless Chromium (`COAXIAL_CHROMIUM`) that draws by
the processor, watches the real page from inside it, and prints a table. Its figures are of this machine and
moment: the load stands beside them.
"""

import argparse
import os
import sys
import time
from pathlib import Path

from playwright.sync_api import Browser, sync_playwright

from tests.benchmarks.first_page.processes import processor_time, processor_use
from tests.benchmarks.first_page.report import PageMeasurement, report
from tests.benchmarks.first_page.stages import mean_stage_ms, stage_sums
from tests.benchmarks.machine import machine_line
from tests.benchmarks.options import BenchmarkOptions
from tests.benchmarks.running_server import RunningServer, running_server
from tests.conftest import FLAGS, chromium_path

RATE_HZ = 30.0
SIZES = "1920x1080,1180x820,390x844"
PATIENCE_MS = 90_000
RECORDER = Path(__file__).with_name("recorder.js")
# Of an ordinary start: Chromium then puts the page together by SwiftShader too, which costs more.
PLAIN_FLAGS = ("--no-sandbox",)


def main(arguments: list[str] | None = None) -> None:
    """Measure the page at each screen size, and print the tables."""
    given = _parser().parse_args(arguments)
    flags = PLAIN_FLAGS if given.plain else FLAGS
    sys.stdout.write(f"{machine_line()} Load before: {_load()}.\n\n")
    seen = []
    with (
        running_server(BenchmarkOptions(), seed=1, live_rate_hz=RATE_HZ) as server,
        sync_playwright() as playwright,
    ):
        browser = playwright.chromium.launch(executable_path=chromium_path(), headless=True, args=list(flags))
        for width_px, height_px in given.sizes:
            seen.append(_watch(browser, server, (width_px, height_px), given))
        browser.close()
    sys.stdout.write(report(seen))


def _watch(
    browser: Browser, server: RunningServer, size_px: tuple[int, int], given: argparse.Namespace
) -> PageMeasurement:
    """Measure one screen, starting when its page has settled."""
    width_px, height_px = size_px
    context = browser.new_context(viewport={"width": width_px, "height": height_px}, locale="en-GB")
    context.add_init_script(path=RECORDER)
    page = context.new_page()
    page.goto(f"http://127.0.0.1:{server.port}/theatre")
    page.wait_for_selector('[data-testid="video"][data-live="true"]', timeout=PATIENCE_MS)
    page.wait_for_timeout(1000 * given.settling_seconds)
    began_s, before = time.monotonic(), processor_time(server.pid, os.getpid())
    stages = stage_sums(server.port)
    page.evaluate("coaxialRecorder.begin()")
    page.wait_for_timeout(1000 * given.seconds)
    recorded = page.evaluate("coaxialRecorder.seen()")
    stage_ms = mean_stage_ms(stages, stage_sums(server.port))
    after, spent_s = processor_time(server.pid, os.getpid()), time.monotonic() - began_s
    if given.screenshots is not None:
        given.screenshots.mkdir(parents=True, exist_ok=True)
        page.screenshot(path=given.screenshots / f"first-page-{width_px}x{height_px}.png")
    context.close()
    return PageMeasurement.of(
        recorded,
        size_px=size_px,
        processor_use=processor_use(before, after, spent_s),
        stage_ms=stage_ms,
        load=_load(),
    )


def _load() -> str:
    return f"{os.getloadavg()[0]:.1f}"


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m tests.benchmarks.first_page", description=__doc__)
    parser.add_argument("--seconds", type=float, default=60.0, help="how long each screen is watched")
    parser.add_argument("--settling-seconds", type=float, default=10.0, help="after the first picture")
    parser.add_argument("--sizes", type=_sizes, default=_sizes(SIZES), help=f"of screens, as {SIZES}")
    parser.add_argument("--plain", action="store_true", help="Chromium's own way to put the page together")
    parser.add_argument("--screenshots", type=Path, default=None, help="folder for one picture a screen")
    return parser


def _sizes(text: str) -> list[tuple[int, int]]:
    sizes = []
    for word in text.split(","):
        width, _, height = word.partition("x")
        if not (width.isdecimal() and height.isdecimal()):
            raise argparse.ArgumentTypeError(f"'{word}' is no size, needed width x height as 1920x1080")
        sizes.append((int(width), int(height)))
    return sizes


if __name__ == "__main__":
    main()
