"""Benchmarks of accuracy and speed: the tracker beside other detectors and the Cramer-Rao bound, as Markdown.

python -m tests.benchmarks [SECTION ...] [--write]; the sections are those of `sections.py`.
"""

import argparse
import sys
from collections.abc import Mapping

from tests.benchmarks.dot_plots import write_plots
from tests.benchmarks.figures import Figure, better_figures, read_figures, worse_figures, write_figures
from tests.benchmarks.machine import machine_line
from tests.benchmarks.options import BenchmarkOptions
from tests.benchmarks.readme import write_section
from tests.benchmarks.section_result import SectionResult
from tests.benchmarks.sections import SECTIONS
from tracker.errors import NavigationError

# Sections whose tables state what was measured.
ALONE = dict.fromkeys(("boards", "calibration", "ct", "pedicles"), "")


def main(arguments: list[str] | None = None) -> None:
    """Run the selected sections, print the tables, and write them into the README on request."""
    given = _parser().parse_args(arguments)
    options = BenchmarkOptions(
        seeds=given.seeds,
        seconds=given.seconds,
        rate_hz=given.rate,
        live_seconds=given.live_seconds,
        noise=given.noise,
        blur=given.blur,
        clutter=given.clutter,
        light=given.light,
        rigs=given.rigs,
        conditions=given.conditions,
        images=given.n,
        seed=given.seed,
        runs=given.runs,
        viewers=given.viewers,
    )
    written = read_figures()
    for name in SECTIONS if given.what == "all" else (given.what,):
        try:
            measured = SECTIONS[name](options)
        except NavigationError as error:
            sys.stderr.write(f"Error: {error}\n")
            sys.exit(2)
        said = {
            "limits": options.limits_summary,
            "tools": options.tools_summary,
            "load": options.load_summary,
            **ALONE,
        }.get(name, options.theatres_summary)
        content = "\n".join([f"{machine_line()} {said}\n", *(table.markdown for table in measured.tables)])
        sys.stdout.write(f"## {name}\n\n{content}\n{_compared(written.get(name, {}), measured)}\n")
        sys.stdout.flush()
        if given.write:
            _write(name, content, measured)


def _parser() -> argparse.ArgumentParser:
    default = BenchmarkOptions()
    parser = argparse.ArgumentParser(prog="python -m tests.benchmarks", description=__doc__)
    parser.add_argument("what", nargs="?", choices=["all", *SECTIONS], default="all")
    parser.add_argument("--seeds", type=_seeds, default=default.seeds, help="theatres, as 1,2,3")
    parser.add_argument("--seconds", type=float, default=default.seconds, help="of each theatre, offline")
    parser.add_argument("--rate", type=float, default=default.rate_hz, help="images a second, offline")
    parser.add_argument("--live-seconds", type=float, default=default.live_seconds, help="of the live server")
    for name in ("noise", "blur", "clutter", "light"):
        parser.add_argument(f"--{name}", type=float, default=1.0, help="0 none, 1 good, 10 very hard")
    parser.add_argument("--rigs", default=default.rigs, help="cameras of the limits, as A or AB")
    parser.add_argument("--conditions", type=_names, default=(), help="of the limits, as base,cover10")
    parser.add_argument(
        "--n", type=_count, default=default.images, help="scenes of each condition of the limits"
    )
    parser.add_argument("--seed", type=_seed, default=default.seed, help="of the first scene of the limits")
    parser.add_argument("--runs", type=int, default=default.runs, help="calibrations of each kind of tool")
    parser.add_argument("--viewers", type=_viewers, default=default.viewers, help="of the load, as 1,10,30")
    parser.add_argument("--write", action="store_true", help="write the tables into the README")
    return parser


def _compared(then: Mapping[str, Figure], measured: SectionResult) -> str:
    """Return the figures that got worse or better than the written ones by more than the noise."""
    both = sum(name in then for name in measured.figures)
    if not both:
        return ""
    lines = []
    for word, some in (
        ("Worse", worse_figures(then, measured.figures)),
        ("Better", better_figures(then, measured.figures)),
    ):
        lines.append(f"{word} than the written table by more than the noise: {len(some)} of {both} figures.")
        lines += [f"- {line}" for line in some]
    return "\n".join([*lines, ""])


def _write(name: str, content: str, measured: SectionResult) -> None:
    if not measured.is_complete:
        sys.stderr.write("Not written: only a part was measured. Leave out --rigs and --conditions.\n")
        return
    write_section(name, content)
    write_plots(measured.plots)
    if measured.figures:
        write_figures(name, measured.figures)


def _count(text: str) -> int:
    if not text.isdecimal() or int(text) < 1:
        raise argparse.ArgumentTypeError(f"{text} scenes, needed 1 or more")
    return int(text)


def _names(text: str) -> tuple[str, ...]:
    return tuple(name.strip() for name in text.split(",") if name.strip())


def _seed(text: str) -> int:
    if not text.isdecimal():
        raise argparse.ArgumentTypeError(f"'{text}' is no seed, needed a whole number of 0 or more")
    return int(text)


def _seeds(text: str) -> tuple[int, ...]:
    return _numbers(text, minimum=0)


def _viewers(text: str) -> tuple[int, ...]:
    return _numbers(text, minimum=1)


def _numbers(text: str, *, minimum: int) -> tuple[int, ...]:
    numbers = [int(word) if word.strip().isdecimal() else -1 for word in text.split(",")]
    if min(numbers) < minimum:
        raise argparse.ArgumentTypeError(
            f"'{text}' has something else than whole numbers of {minimum} or more, needed some as 1,2,3"
        )
    return tuple(numbers)


if __name__ == "__main__":
    main()
