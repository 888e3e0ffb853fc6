"""Measurements of one screen, and tables of all screens."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Self

from tests.benchmarks.tables import NOTHING, Table, number, pair

# Requirements on a machine with two cores and no graphics card.
MIN_LIVE_RATIO, MIN_IMAGES_PER_S, MIN_WIDTH_PX, MAX_AGE_P95_MS = 0.99, 15.0, 640, 100.0
MAX_UNWATCHED_USE = 0.5


@dataclass(frozen=True, slots=True, kw_only=True)
class PageMeasurement:
    """What one screen displayed.

    Attributes:
        size_px: of the screen.
        spent_s: how long it was watched.
        live_ratio: share of time with numbers, of the time in which there could be any.
        unseen_ratio: share of time in which the marker was out of view.
        images_per_s, scene_images_per_s: of the picture, the 3-D scene.
        min_width_px: of the picture.
        small_ratio: share of time in which the picture was narrower than asked.
        ages_ms: of each picture, from its grab to its place on the page.
        message_ages_ms: of each message of `/ws/live`, from the grab of its image to its arrival in the page.
        scene_live_ratio: share of time.
        notes: share of time by what the page called slow.
        processor_use: share of a core by process.
        stage_ms: mean time of each stage of the server, of all images.
        load: of the machine, at the end.
    """

    size_px: tuple[int, int]
    spent_s: float
    live_ratio: float
    unseen_ratio: float
    images_per_s: float
    scene_images_per_s: float
    min_width_px: int
    small_ratio: float
    ages_ms: list[float]
    message_ages_ms: list[float]
    scene_live_ratio: float
    notes: Mapping[str, float]
    processor_use: Mapping[str, float]
    stage_ms: Mapping[str, float]
    load: str

    @classmethod
    def of(
        cls,
        recorded: Mapping[str, Any],
        *,
        size_px: tuple[int, int],
        processor_use: Mapping[str, float],
        stage_ms: Mapping[str, float],
        load: str,
    ) -> Self:
        """Return the measurement from the counters of `recorder.js`."""
        span_ms, numbers_ms = recorded["spanMs"], recorded["numbersMs"]
        span_s = span_ms / 1000.0
        possible_ms = numbers_ms["live"] + numbers_ms["late"]
        widths_ms = {int(width): ms for width, ms in recorded["widthMs"].items()}
        return cls(
            size_px=size_px,
            spent_s=span_s,
            live_ratio=numbers_ms["live"] / possible_ms if possible_ms > 0 else float("nan"),
            unseen_ratio=numbers_ms["unseen"] / span_ms,
            images_per_s=recorded["pictures"] / span_s,
            scene_images_per_s=recorded["sceneImages"] / span_s,
            min_width_px=recorded["minWidthPx"] or 0,
            small_ratio=sum(ms for width, ms in widths_ms.items() if width < MIN_WIDTH_PX) / span_ms,
            ages_ms=recorded["agesMs"],
            message_ages_ms=recorded["messageAgesMs"],
            scene_live_ratio=recorded["sceneMs"] / span_ms,
            notes={name: ms / span_ms for name, ms in recorded["noteMs"].items()},
            processor_use=processor_use,
            stage_ms=stage_ms,
            load=load,
        )


def report(seen: Sequence[PageMeasurement], unwatched_use: Mapping[str, float]) -> str:
    """Return the tables as Markdown; `unwatched_use` is the processor use by process without a viewer."""
    tables = (_page_table(seen), _processor_table(seen, unwatched_use), _stage_table(seen))
    return "\n".join(table.markdown for table in tables)


def _page_table(seen: Sequence[PageMeasurement]) -> Table:
    columns = [
        "screen",
        "numbers live",
        "messages/s",
        "message age ms",
        "picture images/s",
        "min width px",
        "picture age ms",
        "3-D live",
        "3-D images/s",
        "said to be slow",
        "load",
    ]
    rows = [
        [
            f"{one.size_px[0]}x{one.size_px[1]}",
            f"{100 * one.live_ratio:.1f} %",
            number(len(one.message_ages_ms) / one.spent_s, 1),
            pair(one.message_ages_ms, 95.0, 0),
            number(one.images_per_s, 1),
            f"{one.min_width_px} ({100 * one.small_ratio:.0f} % under {MIN_WIDTH_PX})",
            pair(one.ages_ms, 95.0, 0),
            f"{100 * one.scene_live_ratio:.0f} %",
            number(one.scene_images_per_s, 1),
            ", ".join(f"{name} {100 * ratio:.0f} %" for name, ratio in one.notes.items()) or NOTHING,
            one.load,
        ]
        for one in seen
    ]
    note = (
        f"Wanted: numbers live {100 * MIN_LIVE_RATIO:.0f} % of the time in which the marker is in view, "
        f"{MIN_IMAGES_PER_S:.0f} images/s, {MIN_WIDTH_PX} px, messages of {MAX_AGE_P95_MS:.0f} ms. Ages are "
        "median / 95th percentile, from the grab of an image to the page."
    )
    return Table(title="The theatre's page", columns=columns, rows=rows, note=note)


def _processor_table(seen: Sequence[PageMeasurement], unwatched_use: Mapping[str, float]) -> Table:
    names = sorted({name for one in seen for name in one.processor_use} | set(unwatched_use))
    rows = [
        [screen, *(f"{100 * use.get(name, 0.0):.0f} %" for name in names)]
        for screen, use in (
            ("no viewer", unwatched_use),
            *((f"{one.size_px[0]}x{one.size_px[1]}", one.processor_use) for one in seen),
        )
    ]
    server = sum(use for name, use in unwatched_use.items() if name.startswith("server: "))
    note = (
        f"Server without a viewer: {100 * server:.0f} % of a core, rehearsal included; wanted: "
        f"{100 * MAX_UNWATCHED_USE:.0f} %."
    )
    return Table(title="Processor use, of a core", columns=["screen", *names], rows=rows, note=note)


def _stage_table(seen: Sequence[PageMeasurement]) -> Table:
    names = list(dict.fromkeys(name for one in seen for name in one.stage_ms))
    rows = [
        [f"{one.size_px[0]}x{one.size_px[1]}"]
        + [number(one.stage_ms[name], 1) if name in one.stage_ms else NOTHING for name in names]
        for one in seen
    ]
    note = "`waiting` is from the grab of an image to the begin of its tracking."
    return Table(title="Mean time of each stage, ms", columns=["screen", *names], rows=rows, note=note)
