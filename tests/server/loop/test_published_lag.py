"""A moving drill is published with its possible lag; its verdict is unchanged."""

from dataclasses import replace
from functools import lru_cache
from math import isnan

import numpy as np
import pytest

from server.capture.shot import Shot
from server.config import Config, RehearsalConfig
from server.loop.tracking import Tracking
from server.setup import CaseSetup, Preparation, build_setup
from server.stream.assessment_messages import AssessmentMessage, assessment_message
from tracker.navigation import Assessment, Lag, MeasuredLatency

PERIOD_S, IMAGES, FROM_S = 1 / 30, 14, 1.0


@lru_cache(maxsize=1)
def filmed() -> tuple[Preparation, tuple[np.ndarray, ...]]:
    preparation = build_setup(Config(rehearsal=RehearsalConfig(width=640, height=360)))
    assert preparation.theatre is not None
    renderer = preparation.theatre.renderer()
    return preparation, tuple(renderer.image_at(FROM_S + number * PERIOD_S) for number in range(IMAGES))


def measured(
    p99_ms: float, *, size_wh_px: tuple[int, int] = (640, 360), image_period_ms: float = 1000.0 * PERIOD_S
) -> MeasuredLatency:
    return MeasuredLatency(p99_ms=p99_ms, size_wh_px=size_wh_px, image_period_ms=image_period_ms)


@lru_cache(maxsize=8)
def followed(latency: MeasuredLatency | None, *, at_rest: bool = False) -> tuple[Assessment, ...]:
    preparation, images = filmed()
    tracking = Tracking(preparation)
    tracking.adopt(CaseSetup(latency=latency))
    said = []
    for number in range(IMAGES):
        at_s = FROM_S + number * PERIOD_S
        image = images[0] if at_rest else images[number]
        shot = Shot(image=image, number=number, captured_at_s=at_s, source_time_s=at_s)
        one = tracking.process(shot, skipped_images=0).assessments["drill"]
        assert isinstance(one, Assessment)
        said.append(one)
    return tuple(said)


def true_speed_mm_s() -> float:
    theatre = filmed()[0].theatre
    assert theatre is not None
    tips = []
    for at_s in FROM_S + PERIOD_S * np.arange(IMAGES - 6, IMAGES):
        tool = theatre.camera_from_marker_at(float(at_s)) @ theatre.tool.marker_from_tool
        tips.append((theatre.camera_from_vertebra.inverse @ tool).translation_mm)
    return float(np.linalg.norm(tips[-1] - tips[0])) / (5 * PERIOD_S)


def last(assessments: tuple[Assessment, ...]) -> Lag:
    lag = assessments[-1].lag
    assert lag is not None
    return lag


def test_a_moving_tip_has_a_margin_of_its_speed_times_the_latency() -> None:
    lag, true_mm_s = last(followed(measured(100.0))), true_speed_mm_s()
    assert true_mm_s > 3.0
    assert true_mm_s < lag.speed_mm_s < 1.5 * true_mm_s + 3.0
    assert lag.latency_ms == 100.0
    assert lag.margin_mm == pytest.approx(0.1 * lag.speed_mm_s, abs=0.2)


def test_no_margin_is_claimed_without_a_measured_latency() -> None:
    lag = last(followed(None))
    assert lag.speed_mm_s > 0.0
    assert isnan(lag.margin_mm)
    message = assessment_message(followed(None)[-1])
    assert isinstance(message, AssessmentMessage)
    assert message.lag is not None
    assert message.lag.margin_mm is None


@pytest.mark.parametrize(
    ("latency", "is_used"),
    [
        pytest.param(measured(100.0, image_period_ms=100.0), True, id="measured at a lower rate"),
        pytest.param(measured(100.0, image_period_ms=20.0), False, id="measured at a higher rate"),
        pytest.param(measured(100.0, image_period_ms=0.0), True, id="measured at an unknown rate"),
        pytest.param(measured(100.0, size_wh_px=(320, 180)), False, id="measured with smaller images"),
    ],
)
def test_a_latency_of_other_images_makes_no_margin(latency: MeasuredLatency, is_used: bool) -> None:
    lag = last(followed(latency))
    assert lag.speed_mm_s > 0.0
    assert isnan(lag.margin_mm) is not is_used


def test_verdict_and_figures_are_as_without_it_however_late_the_picture_is() -> None:
    for late, plain in zip(followed(measured(5000.0)), followed(None), strict=True):
        assert late.verdict is plain.verdict
        assert repr(late.figures) == repr(plain.figures)
        assert repr(replace(late, lag=None)) == repr(replace(plain, lag=None))


def test_a_drill_at_rest_has_no_margin() -> None:
    assert last(followed(measured(100.0), at_rest=True)).margin_mm == 0.0
