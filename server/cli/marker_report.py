"""Report of a marker as table and JSON, and an image of the most similar place in the background."""

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

from server.cli.background import BackgroundImages
from tracker.design import FalseScore, MarkerAssessment, rectified
from tracker.geometry import Array
from tracker.marker import MarkerModel, ScoreSettings

WIDTH_WITHOUT_TERMINAL = 110
INSET_PX, GAP_PX = 240, 12
ORANGE_BGR = (0, 140, 255)


@dataclass(frozen=True, slots=True, kw_only=True)
class Report:
    """Report of a marker.

    Attributes:
        name: Name of the marker.
        side_mm: Its side.
        assessment: Its scores.
        settings: Acceptance thresholds of the tracker.
        film: Background images; None without a background.
        files: Files that were written.
        made: Design parameters by option name.
    """

    name: str
    side_mm: float
    assessment: MarkerAssessment
    settings: ScoreSettings
    film: BackgroundImages | None
    files: tuple[str, ...]
    made: Mapping[str, int]


def print_report(report: Report) -> None:
    """Print the table, the verdict, the pose accuracy, and what was not measured."""
    assessment, settings, film = report.assessment, report.settings, report.film
    console = Console(file=sys.stdout, width=None if sys.stdout.isatty() else WIDTH_WITHOUT_TERMINAL)
    table = Table(title=f"marker {report.name}, {report.side_mm:g} mm", title_justify="left")
    table.add_column("place without the marker")
    table.add_column(f"score\n(accepted from {settings.accept_score_ratio:.2f})", justify="right")
    table.add_column(f"edges inside\n(from {settings.accept_inner_coverage_ratio:.2f})", justify="right")
    table.add_column(f"target score\n(from {settings.accept_target_score_ratio:.2f})", justify="right")
    table.add_column("")
    table.add_row("rotated by 90, 180, 270°, 27 px", *_columns(assessment.rotated))
    table.add_row("mirrored, 27 px", *_columns(assessment.mirrored))
    if film is not None:
        for place in assessment.nearest[:1]:
            table.add_row(f"closest square, image {film.numbers[place.image_index]}", *_columns(place.score))
        found = assessment.search
        verdict = f"DETECTED in {len(found.claims)}" if found.claims else "detected in none"
        table.add_row(
            f"search of {assessment.images} images",
            f"{found.best_score_ratio:.2f}",
            "-",
            "-",
            verdict,
        )
    console.print(table)
    for sentence in _sentences(report):
        console.print(sentence, highlight=False, markup=False)


def report_json(report: Report) -> str:
    """Return the figures as one JSON object."""
    assessment, film = report.assessment, report.film
    precision = assessment.precision
    values: dict[str, Any] = {
        "name": report.name,
        "side_mm": report.side_mm,
        **report.made,
        "unique": assessment.unique,
        "best_false_score_ratio": assessment.best_false_score_ratio,
        "accept_score_ratio": report.settings.accept_score_ratio,
        "accept_inner_coverage_ratio": report.settings.accept_inner_coverage_ratio,
        "accept_target_score_ratio": report.settings.accept_target_score_ratio,
        "turned": _score(assessment.rotated),
        "mirrored": _score(assessment.mirrored),
        "own_correlation": assessment.own_correlation,
        "tilt_sd_deg": precision.tilt_sd_deg,
        "plain_tilt_sd_deg": precision.plain_tilt_sd_deg,
        "distance_sd_ratio": precision.distance_sd_ratio,
        "plain_distance_sd_ratio": precision.plain_distance_sd_ratio,
        "background": None,
        "files": list(report.files),
    }
    if film is not None:
        values["background"] = {
            "name": film.name,
            "images": assessment.images,
            "best_search_score_ratio": assessment.search.best_score_ratio,
            "claims": [
                {
                    "image_number": film.numbers[claim.image_index],
                    "corners_px": claim.corners_px.tolist(),
                    "score_ratio": claim.score_ratio,
                }
                for claim in assessment.search.claims
            ],
            "closest": [
                {
                    "image_number": film.numbers[place.image_index],
                    "corners_px": place.corners_px.tolist(),
                    "correlation": place.correlation,
                    **_score(place.score),
                }
                for place in assessment.nearest
            ],
        }
    return json.dumps(values, allow_nan=False)


def closest_picture(
    model: MarkerModel, assessment: MarkerAssessment, film: BackgroundImages
) -> npt.NDArray[np.uint8] | None:
    """Draw the most similar place of the background, its rectified image, and the marker.

    False detections of the tracker come first. Returns None if the background has no square.
    """
    place: tuple[int, Array] | None = None
    if assessment.search.claims:
        place = assessment.search.claims[0].image_index, assessment.search.claims[0].corners_px
    elif assessment.nearest:
        place = assessment.nearest[0].image_index, assessment.nearest[0].corners_px
    if place is None:
        return None
    image, corners = film.background.images[place[0]], place[1]
    drawn = np.asarray(cv2.cvtColor(image, cv2.COLOR_GRAY2BGR), dtype=np.uint8)
    outline = np.rint(corners * 16.0).astype(np.int32)
    cv2.polylines(drawn, [outline], True, ORANGE_BGR, 2, cv2.LINE_AA, shift=4)
    # The first side is the upper side of the marker.
    cv2.polylines(drawn, [outline[:2]], False, ORANGE_BGR, 5, cv2.LINE_AA, shift=4)
    inside = rectified(image, corners, side_px=INSET_PX)
    marker = cv2.resize(model.square, (INSET_PX, INSET_PX), interpolation=cv2.INTER_AREA)
    height = max(drawn.shape[0], 2 * INSET_PX + 3 * GAP_PX)
    canvas = np.full((height, drawn.shape[1] + INSET_PX + 2 * GAP_PX, 3), 255, np.uint8)
    canvas[: drawn.shape[0], : drawn.shape[1]] = drawn
    left = drawn.shape[1] + GAP_PX
    for row, part in enumerate((inside, marker)):
        top = GAP_PX + row * (INSET_PX + GAP_PX)
        canvas[top : top + INSET_PX, left : left + INSET_PX] = part[..., None]
    return canvas


def _sentences(report: Report) -> list[str]:
    assessment, precision = report.assessment, report.assessment.precision
    sentences = [
        f"Best false score {assessment.best_false_score_ratio:.2f}, "
        + (
            "but no place reaches all thresholds: score, inner edges and target score."
            if assessment.unique
            else "A FALSE DETECTION REACHES ALL THRESHOLDS."
        ),
        "Lower bound of the pose error at 27 px width, 30° tilt and usual noise: "
        f"tilt {precision.tilt_sd_deg:.2f}° ({precision.tilt_gain:.1f} times better than a plain square), "
        f"distance {100 * precision.distance_sd_ratio:.2f} % ({precision.distance_gain:.1f} times).",
    ]
    if assessment.search.claims:
        sentences.append(
            "The tracker detects the marker in the background: either the images contain the marker, or an "
            "object that cannot be distinguished from it."
        )
    if report.film is None:
        sentences.append("No background was given: the marker was only compared with itself.")
    return sentences


def _columns(score: FalseScore) -> tuple[str, str, str, str]:
    reached = "FALSE MATCH" if score.accepted else ""
    ratios = (score.score_ratio, score.inner_coverage_ratio, score.target_score_ratio)
    total, inner, target = (f"{ratio:.2f}" for ratio in ratios)
    return total, inner, target, reached


def _score(score: FalseScore) -> dict[str, Any]:
    return {
        "score_ratio": score.score_ratio,
        "inner_coverage_ratio": score.inner_coverage_ratio,
        "target_score_ratio": score.target_score_ratio,
        "accepted": score.accepted,
    }
