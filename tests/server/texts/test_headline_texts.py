"""The headline names what exceeds its limit and the direction of the correction, with the figures' digits."""

import dataclasses
from collections.abc import Callable

import pytest

from server.texts import LANGUAGES, Headline, Tone, headline_of
from server.texts.language import clock_text
from tests.server.texts.breach import NOON_S, breach
from tests.tracker.navigation.assessed import assessed_at
from tracker.navigation import Absent, AbsentReason, NavigationSnapshot
from tracker.navigation.alarms import QUIET, Alarm, AlarmSnapshot, AlarmState, Presence
from tracker.pose import Unseen, UnseenReason

SnapshotOf = Callable[..., NavigationSnapshot]
ON_THE_AXIS: dict[str, object] = {"tip_in_vertebra_mm": (0.0, 0.0, 12.0), "tilt_rad": 0.0, "judged": True}


def alarms(*them: Alarm) -> AlarmSnapshot:
    return AlarmSnapshot(alarms=them, unix_offset_s=NOON_S)


def headline_at(snapshot_of: SnapshotOf, depth_mm: float, **off: float) -> Headline:
    assessment = assessed_at(depth_mm, **off)
    return headline_of(dataclasses.replace(snapshot_of(), assessments={"drill": assessment}), QUIET)


@pytest.mark.parametrize(
    ("drill", "tone", "title", "detail"),
    [
        pytest.param({"depth_mm": 30.0}, Tone.GOOD, "ON PATH", "", id="on-path"),
        pytest.param(
            {"depth_mm": -10.0, "medial_mm": -2.0, "cranial_mm": 1.2},
            Tone.CAUTION,
            "CORRECT 2.0 mm medial, 1.2 mm caudal",
            "entry 2.3 mm, limit 1.8 mm",
            id="entry",
        ),
        pytest.param(
            {"depth_mm": -60.0, "medial_mm": 40.0, "cranial_mm": 30.0},
            Tone.CAUTION,
            "ENTRY 50.0 mm AWAY",
            "entry 50.0 mm, limit 1.8 mm",
            id="laid-aside",
        ),
        pytest.param(
            {"depth_mm": 5.0, "medial_deg": 6.0},
            Tone.CAUTION,
            "AIM 6.0° lateral",
            "angle 6.0°, limit 5.7°",
            id="angle",
        ),
        pytest.param(
            {"depth_mm": 2.0, "medial_mm": 1.7, "medial_deg": 2.0},
            Tone.CAUTION,
            "AIM lateral",
            "at the end: medial wall 100 %, limit 5 %",
            id="at-the-end",
        ),
        pytest.param(
            {"depth_mm": 30.0, "medial_mm": 2.3},
            Tone.WARNING,
            "NEAR MEDIAL WALL 0.6 mm",
            "limit 1.0 mm · move lateral",
            id="near",
        ),
        pytest.param(
            {"depth_mm": 30.0, "unsure": 10.0},
            Tone.WARNING,
            "UNCERTAIN ±2.77 mm",
            "95 % error, limit 1.80 mm",
            id="uncertain",
        ),
        pytest.param(
            {"depth_mm": 30.0, "unsure": 10.0, "min_error_95_mm": 2.1},
            Tone.WARNING,
            "SET-UP INSUFFICIENT ±2.77 mm",
            "95 % error, at best 2.10 mm with this registration and tool, limit 1.80 mm",
            id="insufficient-set-up",
        ),
        pytest.param(
            {"depth_mm": 56.2}, Tone.DANGER, "TOO DEEP 1.2 mm", "Stop. Withdraw the drill.", id="too-deep"
        ),
        pytest.param(
            {"depth_mm": 30.0, "medial_mm": 3.8},
            Tone.DANGER,
            "THROUGH MEDIAL WALL 0.9 mm",
            "Stop. Withdraw the drill.",
            id="through",
        ),
        pytest.param(
            {"depth_mm": 0.0, "medial_deg": 89.99},
            Tone.CAUTION,
            "DRILL ACROSS CHANNEL",
            "angle 90.0°, limit 5.7°",
            id="across",
        ),
    ],
)
def test_each_verdict_in_words(
    snapshot_of: SnapshotOf, drill: dict[str, float], tone: Tone, title: str, detail: str
) -> None:
    headline = headline_at(snapshot_of, **drill)
    assert headline.tone is tone
    assert (headline.title["en"], headline.detail["en"]) == (title, detail)
    assert "{" not in headline.title["de"] + headline.detail["de"]


def test_where_no_bone_is_known_no_wall_is_named(snapshot_of: SnapshotOf) -> None:
    headline = headline_of(snapshot_of(**{**ON_THE_AXIS, "tilt_rad": 0.3}), QUIET)
    assert headline.title["en"].startswith("OUTSIDE CHANNEL ")


def test_of_several_drills_the_worst_is_shown_and_named(snapshot_of: SnapshotOf) -> None:
    snapshot = snapshot_of()
    tools = {"awl": snapshot.tools["drill"], "drill": snapshot.tools["drill"]}
    both = {"awl": assessed_at(30.0), "drill": assessed_at(30.0, medial_mm=3.8)}
    headline = headline_of(dataclasses.replace(snapshot, tools=tools, assessments=both), QUIET)
    assert headline.title["en"] == "drill: THROUGH MEDIAL WALL 0.9 mm"


@pytest.mark.parametrize(
    ("alarm", "event"),
    [
        pytest.param(
            breach(state=AlarmState.LATCHED, presence=Presence.NO),
            f"BREACH {clock_text(NOON_S + 3.0)} not acknowledged",
            id="over",
        ),
        pytest.param(breach(presence=Presence.NO), f"BREACH {clock_text(NOON_S + 3.0)} clearing", id="going"),
        pytest.param(breach(presence=Presence.UNKNOWN), "BREACH when last seen", id="lost"),
        pytest.param(breach(), "", id="present, and then the headline says so itself"),
    ],
)
def test_an_unacknowledged_breach_is_beside_the_headline_and_not_green(
    snapshot_of: SnapshotOf, alarm: Alarm, event: str
) -> None:
    headline = headline_of(snapshot_of(**ON_THE_AXIS), alarms(alarm))
    assert headline.title["en"] == "ON PATH"
    assert headline.tone is Tone.CAUTION
    assert headline.event["en"] == event
    assert bool(headline.event["de"]) == bool(event)


@pytest.mark.parametrize("reason", AbsentReason)
def test_without_figures_there_is_a_reason_and_no_verdict(
    snapshot_of: SnapshotOf, reason: AbsentReason
) -> None:
    snapshot = dataclasses.replace(snapshot_of(), assessments={"drill": Absent(reason=reason)})
    headline = headline_of(snapshot, QUIET)
    assert headline.verdict is None
    assert headline.tone is Tone.NONE
    for language in LANGUAGES:
        assert headline.title[language].isupper()
        assert headline.detail[language]


def test_a_marker_that_is_twice_in_view_is_named_with_what_to_do(snapshot_of: SnapshotOf) -> None:
    once, twice = snapshot_of(), Unseen(reason=UnseenReason.MARKER_TWICE)
    absent = {"drill": Absent(reason=AbsentReason.MARKER_TWICE)}
    # The tool's own marker, the patient's, and a marker while there are no tools.
    for sightings, assessments, name in (
        ({"drill": twice}, absent, "drill"),
        ({**once.sightings, "patient": twice}, absent, "patient"),
        ({**once.sightings, "drill": twice}, {}, "drill"),
    ):
        snapshot = dataclasses.replace(once, sightings=sightings, assessments=assessments)
        headline = headline_of(snapshot, QUIET)
        assert headline.title == {"en": "MARKER TWICE IN VIEW", "de": "MARKER DOPPELT IM BILD"}
        assert headline.detail["en"] == f"{name}: cover or remove all but one"
        assert headline.detail["de"] == f"{name}: alle bis auf einen abdecken oder entfernen"


@pytest.mark.parametrize("reason", [one for one in UnseenReason if one is not UnseenReason.MARKER_TWICE])
def test_a_marker_that_is_not_seen_is_named_with_its_reason(
    snapshot_of: SnapshotOf, reason: UnseenReason
) -> None:
    snapshot = dataclasses.replace(snapshot_of(seen=False), sightings={"drill": Unseen(reason=reason)})
    headline = headline_of(snapshot, QUIET)
    assert headline.title["en"] == "NO TRACKING"
    assert headline.detail["en"].startswith("drill: not seen, ")


def test_without_an_image_only_the_alarms_are_reported() -> None:
    headline = headline_of(None, alarms(breach(presence=Presence.UNKNOWN)))
    assert (headline.verdict, headline.title["en"]) == (None, "NO IMAGE")
    assert headline.event["en"] == "BREACH when last seen"
