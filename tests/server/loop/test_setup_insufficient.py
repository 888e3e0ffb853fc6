"""Good drilling in the rehearsal with good and bad registration: the headline separates set-up from image."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from server.alarms import AlarmService
from server.capture.shot import Shot
from server.config import Config
from server.live import ProcessState, ProcessStatus, SourceState, SourceStatus
from server.loop.tracking import Tracking
from server.setup import CaseSetup, Preparation, build_setup
from server.texts import headline_of
from tracker.navigation import Assessment, FigureName, Verdict
from tracker.navigation.alarms import Condition
from tracker.navigation.uncertainty import PedicleTolerance
from tracker.plan import Channel
from tracker.registration import Method, Registration

# The drill is well inside the bone, and its marker is in view.
BEGIN_S, RATE_HZ, IMAGES = 14.0, 10.0, 8
CONFIG = Config.model_validate({"rehearsal": {"seed": 3, "skill": "good", "width": 960, "height": 540}})


@cache
def filmed() -> tuple[Preparation, tuple[np.ndarray, ...]]:
    preparation = build_setup(CONFIG)
    assert preparation.theatre is not None
    renderer = preparation.theatre.renderer()
    return preparation, tuple(renderer.image_at(BEGIN_S + number / RATE_HZ) for number in range(IMAGES))


@pytest.mark.parametrize(
    ("registered_sd_mm", "tolerance_mm", "verdict", "condition"),
    [
        # 95 % of a round normal distribution of 0.45 mm are within 1.11 mm.
        pytest.param(0.45, 0.5, Verdict.SETUP_INSUFFICIENT, Condition.SETUP_INSUFFICIENT, id="the-set-up"),
        pytest.param(0.0, 0.02, Verdict.UNCERTAIN, Condition.POSE_UNCERTAIN, id="the-image"),
        pytest.param(0.0, 3.0, None, None, id="neither"),
    ],
)
def test_headline_and_alarm_of_good_drilling_name_what_is_uncertain(
    registered_sd_mm: float, tolerance_mm: float, verdict: Verdict | None, condition: Condition | None
) -> None:
    preparation, images = filmed()
    theatre, channel, known = preparation.theatre, preparation.channel, preparation.registration
    assert theatre is not None
    assert isinstance(channel, Channel)
    assert isinstance(known, Registration)
    bone = preparation.drill_reference_for(channel)
    shift = np.diag([registered_sd_mm**2] * 3 + [0.0] * 3)
    tracking = Tracking(preparation)
    tracking.adopt(
        CaseSetup(
            channel=channel,
            registration=replace(known, method=Method.POINTS, covariance=shift),
            drill_reference=replace(
                bone, tolerance=PedicleTolerance(tolerance_mm=tolerance_mm, lever_mm=18.0)
            ),
            registered_from_s=0.0,
        )
    )
    now = [BEGIN_S]
    alarms = AlarmService(CONFIG, clock=lambda: now[0])
    source = SourceStatus(name="rehearsal", state=SourceState.RUNNING)
    process = ProcessStatus(state=ProcessState.RUNNING)
    verdicts: set[Verdict] = set()
    conditions: set[Condition] = set()
    for number in range(IMAGES):
        now[0] = now_s = BEGIN_S + number / RATE_HZ
        shot = Shot(image=images[number], number=number, captured_at_s=now_s, source_time_s=now_s)
        snapshot = tracking.process(shot, skipped_images=0, clock=lambda: now[0])
        picture = alarms.observe(snapshot, source, process)
        conditions |= {one.condition for one in picture.alarms}
        assessment = snapshot.assessments[theatre.tool.name]
        if not isinstance(assessment, Assessment):
            # A single image does not yet resolve the planar pose ambiguity.
            continue
        headline = headline_of(snapshot, picture)
        assert headline.verdict is assessment.verdict
        assert assessment.figures[FigureName.ERROR].value >= assessment.min_error_95_mm
        verdicts.add(assessment.verdict)
        if verdict is Verdict.SETUP_INSUFFICIENT:
            assert headline.title["en"].startswith("SET-UP INSUFFICIENT ±1.")
            assert "at best 1.11 mm" in headline.detail["en"]
    of_error = {Condition.SETUP_INSUFFICIENT, Condition.POSE_UNCERTAIN}
    assert conditions & of_error == ({condition} if condition is not None else set())
    if verdict is not None:
        assert verdicts == {verdict}
    else:
        assert verdicts
        assert not verdicts & {Verdict.UNCERTAIN, Verdict.SETUP_INSUFFICIENT}
