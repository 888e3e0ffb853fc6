"""Frame rate and latency of the theatre page in a browser without a graphics card, on this machine.

python -m tests.benchmarks.first_page [--seconds 60] [--sizes 1920x1080,390x844]

Starts a server with the rehearsal at its defaults, measures its processor time without a viewer, then opens
the page in a headless Chromium (`COAXIAL_CHROMIUM`) that draws without a graphics card, measures inside the
page, and prints tables. The figures are valid for this machine and moment: the load is printed beside them.
"""

import argparse
import sys
from pathlib import Path

from playwright.sync_api import sync_playwright

from tests.benchmarks.first_page.report import report
from tests.benchmarks.first_page.screen import load_text, measured_screen, unwatched_use
from tests.benchmarks.machine import machine_line
from tests.benchmarks.options import BenchmarkOptions
from tests.benchmarks.running_server import running_server
from tests.conftest import FLAGS, chromium_path

RATE_HZ = 30.0
SIZES = "1920x1080,1180x820,390x844"
# Of an ordinary start: Chromium then puts the page together by SwiftShader too, which costs more.
PLAIN_FLAGS = ("--no-sandbox",)


def main(arguments: list[str] | None = None) -> None:
    """Measure the page at each screen size, and print the tables."""
    given = _parser().parse_args(arguments)
    flags = PLAIN_FLAGS if given.plain else FLAGS
    sys.stdout.write(f"{machine_line()} Load before: {load_text()}.\n\n")
    seen = []
    with (
        running_server(BenchmarkOptions(), seed=1, live_rate_hz=RATE_HZ) as server,
        sync_playwright() as playwright,
    ):
        unwatched = unwatched_use(server, seconds=given.seconds, settling_s=given.settling_seconds)
        browser = playwright.chromium.launch(executable_path=chromium_path(), headless=True, args=list(flags))
        for size_px in given.sizes:
            one = measured_screen(
                browser,
                server,
                size_px,
                seconds=given.seconds,
                settling_s=given.settling_seconds,
                screenshots=given.screenshots,
            )
            seen.append(one)
        browser.close()
    sys.stdout.write(report(seen, unwatched))


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
