"""A camera file with a wrong focal length: an alarm with its error, from the views of a drill that moves."""

from dataclasses import replace

import numpy as np
import pytest

from server.alarms import AlarmService
from server.capture.shot import Shot
from server.config import Config, RehearsalConfig
from server.live import ProcessState, ProcessStatus, SourceState, SourceStatus
from server.loop.tracking import Tracking
from server.setup import build_setup
from server.texts import alarm_text
from tracker.camera import CameraModel
from tracker.geometry import angle_between_deg
from tracker.navigation.alarms import Alarm, Condition
from tracker.rehearsal.theatre import Theatre

RUNS = SourceStatus(name="camera 0", state=SourceState.RUNNING)
WORKS = ProcessStatus(state=ProcessState.RUNNING)
MIN_TURN_DEG, VIEW_INTERVAL_S = 8.5, 0.3


def _different_views_s(theatre: Theatre) -> list[float]:
    """Return times at which the marker faces different directions."""
    times_s, normals = [], list[np.ndarray]()
    for at_s in np.arange(0.0, theatre.cycle_s, 0.1).tolist():
        normal = theatre.camera_from_marker_at(at_s).rotation[:, 2]
        if all(angle_between_deg(normal, one) > MIN_TURN_DEG for one in normals):
            times_s.append(at_s)
            normals.append(normal)
    return times_s


def _alarms(stated_error: float) -> list[Alarm]:
    """Return the alarms after different views, where the stated focal length is wrong by this ratio."""
    preparation = build_setup(Config(rehearsal=RehearsalConfig(scene="pivot")))
    theatre, camera = preparation.theatre, preparation.camera
    assert theatre is not None
    assert camera is not None
    matrix = np.array(camera.matrix)
    matrix[[0, 1], [0, 1]] *= 1.0 + stated_error
    stated = CameraModel(matrix=matrix, distortion=camera.distortion, size_wh_px=camera.size_wh_px)
    tracking, renderer = Tracking(replace(preparation, camera=stated)), theatre.renderer()
    now_s, alarms = 0.0, list[Alarm]()
    service = AlarmService(Config(), clock=lambda: now_s)
    for number, at_s in enumerate(_different_views_s(theatre)):
        now_s = number * VIEW_INTERVAL_S
        shot = Shot(image=renderer.image_at(at_s), number=number, captured_at_s=now_s, source_time_s=at_s)
        snapshot = tracking.process(shot, skipped_images=0)
        alarms = list(service.observe(snapshot, RUNS, WORKS).alarms)
    return [one for one in alarms if one.condition is Condition.FOCAL_LENGTH_DOUBTFUL]


def test_a_focal_length_that_the_views_of_the_drill_contradict_is_alarmed_with_its_error() -> None:
    (alarm,) = _alarms(0.03)
    assert alarm.measure is not None
    # The distortion belongs to the true focal length, and takes a part of the error.
    assert alarm.measure.value == pytest.approx(3.0, abs=0.6)
    sentence = alarm_text(alarm, unix_offset_s=0.0).sentence
    amount = f"{alarm.measure.value:.1f}"
    assert f"differ by {amount} %, limit 1.0 %" in sentence["en"]
    assert f"um {amount.replace('.', ',')} % ab, Grenze 1,0 %" in sentence["de"]


def test_a_true_focal_length_is_not_alarmed() -> None:
    assert _alarms(0.0) == []
