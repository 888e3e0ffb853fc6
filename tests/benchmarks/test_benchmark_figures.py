"""What got worse is told, what is noise is not, and what is drawn is small."""

from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest

from tests.benchmarks.__main__ import _compared, _parser
from tests.benchmarks.dot_plots import FOLDER, Panel, Series, svg, write_plots
from tests.benchmarks.figures import (
    Figure,
    Share,
    Size,
    better_figures,
    interval,
    is_worse,
    read_figures,
    size_of,
    worse_figures,
    write_figures,
)
from tests.benchmarks.section_result import SectionResult


def errors_like(median_mm: float, *, seed: int, count: int = 24) -> Size:
    size = size_of((median_mm * np.random.default_rng(seed).lognormal(0.0, 0.7, count)).tolist())
    assert size is not None
    return size


@pytest.mark.parametrize(
    ("then", "now", "expected"),
    [
        pytest.param(Share(count=24, of=24), Share(count=9, of=24), True, id="found far less often"),
        pytest.param(Share(count=24, of=24), Share(count=22, of=24), False, id="two of 24 are chance"),
        pytest.param(Share(count=960, of=1000), Share(count=880, of=1000), True, id="80 of 1000 are not"),
        pytest.param(Share(count=9, of=24), Share(count=24, of=24), False, id="found more often"),
        pytest.param(
            Share(count=0, of=500, is_good=False),
            Share(count=60, of=500, is_good=False),
            True,
            id="mirrored more often",
        ),
        pytest.param(
            Share(count=0, of=500, is_good=False, is_strict=True),
            Share(count=1, of=500, is_good=False, is_strict=True),
            True,
            id="one wrong claim is one too many",
        ),
        pytest.param(
            Share(count=2, of=1000, is_good=False, is_strict=True),
            Share(count=1, of=500, is_good=False, is_strict=True),
            False,
            id="the same share of wrong claims in fewer images",
        ),
        pytest.param(
            Size(value=1.0, log_sd=0.1, count=24), Size(value=2.0, log_sd=0.1, count=24), True, id="doubled"
        ),
        pytest.param(
            Size(value=1.0, log_sd=0.1, count=24),
            Size(value=1.3, log_sd=0.1, count=24),
            False,
            id="in the noise",
        ),
        pytest.param(
            Size(value=1.0, log_sd=0.1, count=24), Size(value=0.1, log_sd=0.1, count=24), False, id="a tenth"
        ),
        pytest.param(Share(count=0, of=0), Share(count=0, of=9), False, id="nothing to compare with"),
        pytest.param(Share(count=285, of=285), Share(count=12, of=16), True, id="four of 16 images"),
        pytest.param(
            Share(count=285, of=285, in_a_row=4),
            Share(count=12, of=16, in_a_row=4),
            False,
            id="one of four sequences",
        ),
    ],
)
def test_a_worsening_is_distinguished_from_noise(then: Figure, now: Figure, expected: bool) -> None:
    assert is_worse(then, now) is expected


def test_runs_that_differ_by_chance_alone_are_hardly_ever_called_worse() -> None:
    called = sum(is_worse(errors_like(1.0, seed=2 * n), errors_like(1.0, seed=2 * n + 1)) for n in range(300))
    found = np.random.default_rng(1).binomial(24, 0.9, (300, 2))
    called += sum(is_worse(Share(count=int(a), of=24), Share(count=int(b), of=24)) for a, b in found)
    assert called <= 3


def test_errors_that_grew_threefold_are_called_worse_and_ones_that_shrank_better() -> None:
    then = {f"{n}": errors_like(1.0, seed=2 * n) for n in range(40)}
    now = {f"{n}": errors_like(3.0, seed=2 * n + 1) for n in range(40)}
    assert len(worse_figures(then, now)) > 30
    assert better_figures(then, now) == []
    assert len(better_figures(now, then)) > 30


def test_what_got_worse_is_said_with_both_numbers() -> None:
    then = {"A base, found": Share(count=24, of=24), "gone": Share(count=1, of=1)}
    measured = SectionResult(
        tables=[], figures={"A base, found": Share(count=8, of=24), "new": Share(count=1, of=1)}
    )
    assert _compared(then, measured) == (
        "Worse than the written table by more than the noise: 1 of 1 figures.\n"
        "- A base, found: 0.333 (8 of 24), was 1.000 (24 of 24)\n"
        "Better than the written table by more than the noise: 0 of 1 figures.\n"
    )
    assert _compared({}, measured) == ""


def test_few_numbers_have_no_spread_and_times_have_that_of_two_runs() -> None:
    assert size_of([1.0, 2.0]) is None
    steady = [1.0] * 1000
    plain, timed = size_of(steady), size_of(steady, is_time=True)
    assert plain is not None
    assert timed is not None
    assert plain.log_sd < 0.01 < timed.log_sd


def test_an_interval_contains_the_true_share_at_its_stated_rate() -> None:
    low, high = interval(24, 24, 1.96)
    assert (round(low, 2), round(high, 2)) == (0.86, 1.0)
    counts = np.random.default_rng(3).binomial(60, 0.95, 2000)
    covered = [
        interval(int(count), 60, 1.96)[0] <= 0.95 <= interval(int(count), 60, 1.96)[1] for count in counts
    ]
    assert 0.92 < np.mean(covered) < 0.99


def test_figures_are_read_as_they_were_written_and_other_sections_stay(tmp_path: Path) -> None:
    path = tmp_path / "figures.json"
    assert read_figures(path) == {}
    one: dict[str, Figure] = {"tip": Size(value=0.25, log_sd=0.125, count=24)}
    other: dict[str, Figure] = {"wrong": Share(count=0, of=9, is_good=False, is_strict=True)}
    write_figures("limits", one, path)
    write_figures("rehearsal", other, path)
    assert read_figures(path) == {"limits": one, "rehearsal": other}


def panel(values: list[float]) -> Panel:
    series = Series(name="search & step", colour="#000", values=values, ranges=[(0.5, 0.9)] * len(values))
    return Panel(title="A < B", rows=["base", "cover30"], series=[series], limits=(0.0, 1.0), band=(0.9, 1.0))


def test_a_plot_is_sound_svg_with_a_dot_for_each_number_and_none_for_none() -> None:
    drawn = ElementTree.fromstring(svg("T", [panel([0.25, float("nan")])]))  # noqa: S314, own text
    dots = [float(dot.attrib["cx"]) for dot in drawn.iter("{http://www.w3.org/2000/svg}circle")]
    assert len(dots) == 2  # the legend's and one
    one = panel([0.25, float("nan")])
    assert dots[1] == pytest.approx(one.x(0.25), abs=0.1)
    assert one.x(0.0) < one.x(0.25) < one.x(1.0) == one.x(7.0)


def test_a_logarithmic_axis_has_its_powers_of_ten_evenly_apart() -> None:
    axis = Panel(title="", rows=[], series=[], limits=(0.05, 100.0), is_log=True)
    assert axis.ticks == pytest.approx([0.1, 1.0, 10.0, 100.0])
    steps = np.diff([axis.x(tick) for tick in axis.ticks])
    np.testing.assert_allclose(steps, steps[0])


def test_plots_are_files_of_their_names(tmp_path: Path) -> None:
    write_plots({"found": svg("T", [panel([0.1, 0.2])])}, tmp_path / "plots")
    assert (tmp_path / "plots" / "found.svg").read_text(encoding="utf-8").startswith("<svg")


def test_the_written_plots_are_small() -> None:
    assert sum(path.stat().st_size for path in FOLDER.glob("*.svg")) < 100_000


@pytest.mark.parametrize("count", ["0", "-3", "many"])
def test_no_scenes_are_no_measurement(count: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        _parser().parse_args(["limits", "--n", count])
    assert f"{count} scenes, needed 1 or more" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("words", "reported"),
    [
        pytest.param(["--seed", "-1"], "'-1' is no seed, needed a whole number of 0 or more", id="a-seed"),
        pytest.param(["--seed", "x"], "'x' is no seed, needed a whole number of 0 or more", id="a-word"),
        pytest.param(["--seeds", "x"], "numbers of 0 or more, needed some as 1,2,3", id="seeds"),
        pytest.param(["--seeds", "1,-2"], "numbers of 0 or more, needed some as 1,2,3", id="one-of-two"),
        pytest.param(["--seeds", "1,"], "numbers of 0 or more, needed some as 1,2,3", id="an-open-end"),
        pytest.param(["--viewers", "0"], "numbers of 1 or more, needed some as 1,2,3", id="nobody"),
    ],
)
def test_what_is_no_number_of_its_kind_is_reported_with_its_form(
    words: list[str], reported: str, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit):
        _parser().parse_args(["limits", *words])
    assert reported in capsys.readouterr().err


def test_seeds_and_viewers_are_numbers_with_commas() -> None:
    given = _parser().parse_args(["load", "--seeds", "0, 7", "--viewers", "1,30", "--seed", "0"])
    assert (given.seeds, given.viewers, given.seed) == ((0, 7), (1, 30), 0)
