"""The figures of a marker: as a table, as JSON, and as a picture of where the background comes closest."""

import json
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import cv2
import numpy as np
import numpy.typing as npt
from rich.console import Console
from rich.table import Table

from server.cli.background import Film
from tracker.design import FalseScore, Judgement, flattened
from tracker.geometry import Array
from tracker.marker import MarkerModel, ScoreSettings

WIDTH_WITHOUT_TERMINAL = 110
INSET_PX, GAP_PX = 240, 12
ORANGE_BGR = (0, 140, 255)


@dataclass(frozen=True, slots=True, kw_only=True)
class Report:
    """What is told of a marker.

    Attributes:
        name: of the marker.
        side_mm: its side.
        judgement: its figures.
        settings: what the tracker accepts.
        film: the background, None without one.
        files: that were written.
        made: what it was made from, by the option's name.
    """

    name: str
    side_mm: float
    judgement: Judgement
    settings: ScoreSettings
    film: Film | None
    files: tuple[str, ...]
    made: Mapping[str, int]


def told(report: Report) -> None:
    """Print the table, and in a sentence each: the verdict, the pose, and what was not measured."""
    judgement, settings, film = report.judgement, report.settings, report.film
    console = Console(file=sys.stdout, width=None if sys.stdout.isatty() else WIDTH_WITHOUT_TERMINAL)
    table = Table(title=f"marker {report.name}, {report.side_mm:g} mm", title_justify="left")
    table.add_column("where the marker is not")
    table.add_column(f"score\n(accepted from {settings.accept_score_ratio:.2f})", justify="right")
    table.add_column(f"edges inside\n(from {settings.accept_inner_coverage_ratio:.2f})", justify="right")
    table.add_column(f"target score\n(from {settings.accept_target_score_ratio:.2f})", justify="right")
    table.add_column("")
    table.add_row("itself turned, 27 px wide", *_columns(judgement.turned))
    table.add_row("its mirror image, 27 px wide", *_columns(judgement.mirrored))
    if film is not None:
        for place in judgement.nearest[:1]:
            table.add_row(f"closest square, image {film.numbers[place.image_index]}", *_columns(place.score))
        found = judgement.search
        verdict = f"CLAIMED in {len(found.claims)}" if found.claims else "claimed in none"
        table.add_row(
            f"search of {judgement.images} images",
            f"{found.best_score_ratio:.2f}",
            "-",
            "-",
            verdict,
        )
    console.print(table)
    for sentence in _sentences(report):
        console.print(sentence, highlight=False, markup=False)


def json_of(report: Report) -> str:
    """The figures as one JSON object."""
    judgement, film = report.judgement, report.film
    precision = judgement.precision
    whole: dict[str, Any] = {
        "name": report.name,
        "side_mm": report.side_mm,
        **report.made,
        "unique": judgement.unique,
        "best_false_score_ratio": judgement.best_false_score_ratio,
        "accept_score_ratio": report.settings.accept_score_ratio,
        "accept_inner_coverage_ratio": report.settings.accept_inner_coverage_ratio,
        "accept_target_score_ratio": report.settings.accept_target_score_ratio,
        "turned": _score(judgement.turned),
        "mirrored": _score(judgement.mirrored),
        "own_correlation": judgement.own_correlation,
        "tilt_sd_deg": precision.tilt_sd_deg,
        "plain_tilt_sd_deg": precision.plain_tilt_sd_deg,
        "distance_sd_ratio": precision.distance_sd_ratio,
        "plain_distance_sd_ratio": precision.plain_distance_sd_ratio,
        "background": None,
        "files": list(report.files),
    }
    if film is not None:
        whole["background"] = {
            "name": film.name,
            "images": judgement.images,
            "best_search_score_ratio": judgement.search.best_score_ratio,
            "claims": [
                {
                    "image_number": film.numbers[claim.image_index],
                    "corners_px": claim.corners_px.tolist(),
                    "score_ratio": claim.score_ratio,
                }
                for claim in judgement.search.claims
            ],
            "closest": [
                {
                    "image_number": film.numbers[place.image_index],
                    "corners_px": place.corners_px.tolist(),
                    "correlation": place.correlation,
                    **_score(place.score),
                }
                for place in judgement.nearest
            ],
        }
    return json.dumps(whole, allow_nan=False)


def closest_picture(model: MarkerModel, judgement: Judgement, film: Film) -> npt.NDArray[np.uint8] | None:
    """Where the background comes closest, outlined in its image; beside it the same flattened, and the model.

    A place that the tracker claims comes before any other. None where the background has no square at all.
    """
    place: tuple[int, Array] | None = None
    if judgement.search.claims:
        place = judgement.search.claims[0].image_index, judgement.search.claims[0].corners_px
    elif judgement.nearest:
        place = judgement.nearest[0].image_index, judgement.nearest[0].corners_px
    if place is None:
        return None
    image, corners = film.background.images[place[0]], place[1]
    drawn = np.asarray(cv2.cvtColor(image, cv2.COLOR_GRAY2BGR), dtype=np.uint8)
    outline = np.rint(corners * 16.0).astype(np.int32)
    cv2.polylines(drawn, [outline], True, ORANGE_BGR, 2, cv2.LINE_AA, shift=4)
    # The first side is the marker's upper one.
    cv2.polylines(drawn, [outline[:2]], False, ORANGE_BGR, 5, cv2.LINE_AA, shift=4)
    inside = flattened(image, corners, side_px=INSET_PX)
    marker = cv2.resize(model.square, (INSET_PX, INSET_PX), interpolation=cv2.INTER_AREA)
    height = max(drawn.shape[0], 2 * INSET_PX + 3 * GAP_PX)
    whole = np.full((height, drawn.shape[1] + INSET_PX + 2 * GAP_PX, 3), 255, np.uint8)
    whole[: drawn.shape[0], : drawn.shape[1]] = drawn
    left = drawn.shape[1] + GAP_PX
    for row, part in enumerate((inside, marker)):
        top = GAP_PX + row * (INSET_PX + GAP_PX)
        whole[top : top + INSET_PX, left : left + INSET_PX] = part[..., None]
    return whole


def _sentences(report: Report) -> list[str]:
    judgement, precision = report.judgement, report.judgement.precision
    sentences = [
        f"Best false score {judgement.best_false_score_ratio:.2f}, "
        + (
            "but nothing reaches all that is accepted: score, edges inside and target score together."
            if judgement.unique
            else "SOMETHING REACHES ALL THAT IS ACCEPTED."
        ),
        "Pose where it is 27 px wide, tilted by 30°, the best any method can do at ordinary noise: "
        f"tilt {precision.tilt_sd_deg:.2f}° ({precision.tilt_gain:.1f} times surer than a plain square), "
        f"distance {100 * precision.distance_sd_ratio:.2f} % ({precision.distance_gain:.1f} times).",
    ]
    if judgement.search.claims:
        sentences.append(
            "The tracker claims the marker in the background: either it is in those images itself, or they "
            "show something that cannot be told from it."
        )
    if report.film is None:
        sentences.append("No background was given: it was compared with itself alone.")
    return sentences


def _columns(score: FalseScore) -> tuple[str, str, str, str]:
    reached = "TAKEN FOR IT" if score.accepted else ""
    ratios = (score.score_ratio, score.inner_coverage_ratio, score.target_score_ratio)
    whole, inner, target = (f"{ratio:.2f}" for ratio in ratios)
    return whole, inner, target, reached


def _score(score: FalseScore) -> dict[str, Any]:
    return {
        "score_ratio": score.score_ratio,
        "inner_coverage_ratio": score.inner_coverage_ratio,
        "target_score_ratio": score.target_score_ratio,
        "accepted": score.accepted,
    }
