"""Benchmarks: error of each pose against the rehearsal's truth, and time of each stage, as Markdown tables.

python -m tests.benchmarks [rehearsal | overlay | server] [--write]
"""

import argparse
import sys

from tests.benchmarks.asked import Asked
from tests.benchmarks.machine import machine_line
from tests.benchmarks.readme import write_section
from tests.benchmarks.sections import SECTIONS
from tracker.errors import NavigationError


def main(arguments: list[str] | None = None) -> None:
    """Measure what was asked for, print it, and write it into the README if that was asked for too."""
    given = _parser().parse_args(arguments)
    asked = Asked(
        seeds=given.seeds,
        seconds=given.seconds,
        rate_hz=given.rate,
        live_seconds=given.live_seconds,
        noise=given.noise,
        blur=given.blur,
        clutter=given.clutter,
        light=given.light,
    )
    for name in SECTIONS if given.what == "all" else (given.what,):
        try:
            tables = SECTIONS[name](asked)
        except NavigationError as error:
            sys.stderr.write(f"Error: {error}\n")
            sys.exit(2)
        content = "\n".join([_said_of(asked), *(table.markdown for table in tables)])
        sys.stdout.write(f"## {name}\n\n{content}\n")
        sys.stdout.flush()
        if given.write:
            write_section(name, content)


def _parser() -> argparse.ArgumentParser:
    default = Asked()
    parser = argparse.ArgumentParser(prog="python -m tests.benchmarks", description=__doc__)
    parser.add_argument("what", nargs="?", choices=["all", *SECTIONS], default="all")
    parser.add_argument("--seeds", type=_seeds, default=default.seeds, help="theatres, as 1,2,3")
    parser.add_argument("--seconds", type=float, default=default.seconds, help="of each theatre, offline")
    parser.add_argument("--rate", type=float, default=default.rate_hz, help="images a second, offline")
    parser.add_argument("--live-seconds", type=float, default=default.live_seconds, help="of the live server")
    for name in ("noise", "blur", "clutter", "light"):
        parser.add_argument(f"--{name}", type=float, default=1.0, help="0 none, 1 good, 10 very hard")
    parser.add_argument("--write", action="store_true", help="write the tables into the README")
    return parser


def _seeds(text: str) -> tuple[int, ...]:
    return tuple(int(seed) for seed in text.split(","))


def _said_of(asked: Asked) -> str:
    seeds = ", ".join(map(str, asked.seeds))
    return (
        f"{machine_line()} Seeds {seeds} (a server plays the first); offline {asked.seconds:g} s each at "
        f"{asked.rate_hz:g} Hz; noise {asked.noise:g}, blur {asked.blur:g}, clutter {asked.clutter:g}, "
        f"light {asked.light:g}.\n"
    )


if __name__ == "__main__":
    main()
