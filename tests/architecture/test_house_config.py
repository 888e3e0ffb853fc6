"""A setting has one default, which config.yaml shows, the tracker repeats and the server passes on."""

from collections.abc import Mapping
from dataclasses import asdict, fields
from pathlib import Path
from typing import get_args

import pytest
import yaml

from server.alarms.service import alarm_limits
from server.config import Config, RehearsalBoard, RehearsalScene, RehearsalSkill
from server.point_limits import point_gate, point_settings
from server.procedure.registration.capture_settings import capture_settings
from server.setup import drill_limits
from tracker.marker import ScoreSettings
from tracker.navigation import DrillLimits, Setup
from tracker.navigation.alarms import AlarmLimits
from tracker.plan.screw.channel import FRONT_MARGIN_MM
from tracker.plan.screw.proposal import WALL_MARGIN_MM
from tracker.pose import SmoothingSettings
from tracker.pose.tool import ToolGate
from tracker.registration.capture import CaptureSettings
from tracker.registration.check import MAX_MM
from tracker.registration.nudge import NudgeLimits
from tracker.registration.points import PointGate, PointSettings
from tracker.registration.surface import SurfaceGate
from tracker.rehearsal import BoardKind, Scene, Skill

ROOT = Path(__file__).parents[2]
REGISTRATION = Config().registration


def by_path(value: object, path: str = "") -> dict[str, object]:
    """The values of a nested mapping by their dotted path."""
    if not isinstance(value, Mapping) or not value:
        return {path: value}
    out: dict[str, object] = {}
    for key, inner in value.items():
        out |= by_path(inner, f"{path}.{key}" if path else str(key))
    return out


def differences(one: Mapping[str, object], other: Mapping[str, object]) -> dict[str, tuple[object, object]]:
    """Both values of each key in which two mappings differ."""
    keys = sorted({*one, *other})
    pairs = {key: (one.get(key, "missing"), other.get(key, "missing")) for key in keys}
    return {key: (left, right) for key, (left, right) in pairs.items() if left != right}


def test_the_config_that_is_shown_is_the_config_that_is_built_in() -> None:
    shown = by_path(yaml.safe_load((ROOT / "config.yaml").read_text(encoding="utf-8")))
    built_in = by_path(Config().model_dump(mode="json"))
    differing = differences(shown, built_in)
    assert not differing, f"write into config.yaml what server/config.py has: (shown, built in) {differing}"


@pytest.mark.parametrize(
    ("own", "of_settings"),
    [
        pytest.param(own, of_settings, id=f"{type(own).__module__.replace('.', '/')}.py-{type(own).__name__}")
        for own, of_settings in (
            (AlarmLimits(), alarm_limits(Config())),
            (DrillLimits(), drill_limits(Config())),
            (CaptureSettings(), capture_settings(REGISTRATION)),
            (PointSettings(), point_settings(REGISTRATION)),
            (PointGate(), point_gate(REGISTRATION)),
            (
                SurfaceGate(),
                SurfaceGate(max_rms_mm=REGISTRATION.max_surface_rms_mm, max_tre_mm=REGISTRATION.max_tre_mm),
            ),
            (
                NudgeLimits(),
                NudgeLimits(max_mm=REGISTRATION.max_nudge_mm, max_deg=REGISTRATION.max_nudge_deg),
            ),
            (ScoreSettings(), ScoreSettings(**Config().tracker.model_dump())),
            (SmoothingSettings(), SmoothingSettings(**Config().smoothing.model_dump())),
            (ToolGate(), ToolGate(**Config().tool_calibration.model_dump())),
        )
    ],
)
def test_the_defaults_of_the_tracker_are_those_of_the_settings(own: object, of_settings: object) -> None:
    differing = differences(asdict(own), asdict(of_settings))  # pyrefly: ignore[bad-argument-type]  # dataclasses
    place = f"{type(own).__name__} of {type(own).__module__}"
    assert not differing, f"write into {place} what server/config.py has: (tracker, config) {differing}"


def test_single_limits_of_the_tracker_are_those_of_the_settings() -> None:
    config = Config()
    max_tip_sd_mm = {one.name: one.default for one in fields(Setup)}["max_tip_sd_mm"]
    places = {
        "tracker/navigation/snapshot.py": (max_tip_sd_mm, config.limits.max_tip_sd_mm),
        "tracker/registration/check.py": (MAX_MM, config.registration.max_check_mm),
        "tracker/plan/screw/proposal.py": (WALL_MARGIN_MM, config.plan.wall_margin_mm),
        "tracker/plan/screw/channel.py": (FRONT_MARGIN_MM, config.plan.front_margin_mm),
    }
    differing = {place: pair for place, pair in places.items() if pair[0] != pair[1]}
    assert not differing, f"write there what server/config.py has: (tracker, config) {differing}"


def test_a_setting_moves_every_limit_of_an_alarm() -> None:
    alarms = {name: 1.5 * value for name, value in Config().alarms.model_dump().items()}
    others = {"limits": {"video_stale_after_ms": 750}, "registration": {"check_again_after_min": 45}}
    moved, own = alarm_limits(Config.model_validate({"alarms": alarms, **others})), AlarmLimits()
    fixed = [one.name for one in fields(AlarmLimits) if getattr(moved, one.name) == getattr(own, one.name)]
    assert fixed == [], f"alarm_limits in server/alarms/service.py does not pass {fixed} on"


@pytest.mark.parametrize(
    ("settings", "played"),
    [(RehearsalBoard, BoardKind), (RehearsalScene, Scene), (RehearsalSkill, Skill)],
    ids=["board", "scene", "skill"],
)
def test_what_the_rehearsal_plays_can_be_set(settings: object, played: type[Scene]) -> None:
    differing = set(get_args(settings)) ^ {one.value for one in played}
    assert not differing, f"in one of server/config.py and tracker/rehearsal/settings.py only: {differing}"
