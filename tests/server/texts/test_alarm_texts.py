"""An alarm is stated in the present tense only while its condition is present."""

import pytest

from server.texts import LANGUAGES, Language, alarm_text, alarm_title, with_unknown_presence
from server.texts.controls import CONTROLS
from server.texts.language import clock_text
from server.texts.phrases import PHRASES
from tests.server.texts.breach import MEDIAL, NOON_S, alarm, breach, mm, peak
from tracker.camera import CameraControl
from tracker.navigation.alarms import (
    ALARM_RULES,
    Alarm,
    AlarmState,
    Condition,
    Kind,
    Measure,
    Peak,
    Presence,
    Site,
)
from tracker.navigation.clearance import WallSource
from tracker.navigation.directions import Wall

TIME = clock_text(NOON_S + 3.0)


@pytest.mark.parametrize(
    ("reported", "sentence", "remedy"),
    [
        pytest.param(
            breach(),
            "Drill 0.4 mm through the medial wall at 29.0 mm depth.",
            "Stop. Withdraw the drill.",
            id="through the wall now",
        ),
        pytest.param(
            # The sentence of this moment once was "the drill is through the pedicle wall: 7.3 mm".
            breach(measure=mm(7.3), presence=Presence.NO),
            f"Was 0.8 mm through the medial wall at 29.0 mm depth, {TIME}. Not through now.",
            "",
            id="being cleared, the wall 7.3 mm away",
        ),
        pytest.param(
            breach(measure=mm(7.3), presence=Presence.NO, state=AlarmState.LATCHED),
            f"Was 0.8 mm through the medial wall at 29.0 mm depth, {TIME}. Not through now.",
            "",
            id="over, and not acknowledged",
        ),
        pytest.param(
            breach(presence=Presence.UNKNOWN, state=AlarmState.LATCHED),
            f"Was 0.8 mm through the medial wall at 29.0 mm depth, {TIME}.",
            "",
            id="over, and not seen any more: nothing is said of now",
        ),
        pytest.param(
            breach(presence=Presence.UNKNOWN),
            f"Not tracked. Was 0.8 mm through the medial wall at 29.0 mm depth, {TIME}.",
            "Stop.",
            id="tracking lost in a breach",
        ),
        pytest.param(
            breach(site=Site(depth_mm=29.0, wall=Wall.MEDIAL, against=WallSource.CHANNEL)),
            "Drill 0.4 mm outside the planned channel at 29.0 mm depth.",
            "Stop. Withdraw the drill.",
            id="no bone is known",
        ),
        pytest.param(
            breach(state=AlarmState.LATCHED, presence=Presence.NO, earlier_peak=peak(-1.2, at_s=1.0)),
            f"Was 0.8 mm through the medial wall at 29.0 mm depth, {TIME}. Not through now. "
            f"Earlier 1.2 mm, {clock_text(NOON_S + 1.0)}.",
            "",
            id="again, and over again",
        ),
        pytest.param(
            breach(earlier_peak=peak(-1.2, at_s=1.0)),
            "Drill 0.4 mm through the medial wall at 29.0 mm depth. "
            f"Earlier 1.2 mm, {clock_text(NOON_S + 1.0)}.",
            "Stop. Withdraw the drill.",
            id="there again",
        ),
        pytest.param(
            alarm(Condition.CLEARANCE_LOW, measure=mm(0.6, 1.0), site=MEDIAL),
            "0.6 mm to the medial wall, limit 1.0 mm.",
            "Do not advance. Aim back to the channel's axis.",
            id="near a wall",
        ),
        pytest.param(
            alarm(Condition.POSE_UNCERTAIN, measure=mm(1.94, 1.5)),
            "95 % error ±1.94 mm, limit 1.50 mm.",
            "Hold the marker closer, steadier and more tilted.",
            id="with the digits of its figure",
        ),
        pytest.param(
            alarm(Condition.SETUP_INSUFFICIENT, measure=mm(1.94, 1.5)),
            "95 % error ±1.94 mm, limit 1.50 mm. No camera view meets it with this registration and tool.",
            "Register with more landmarks, or plan a thinner screw.",
            id="what no view mends is not blamed on the view",
        ),
        pytest.param(
            alarm(
                Condition.CAMERA_CHANGED,
                measure=Measure(value=135.0, limit=120.0, unit=""),
                control=CameraControl.FOCUS,
            ),
            "Focus changed from 120 to 135 since the calibration.",
            "Stop. Set it back, or calibrate and register again.",
            id="the lens moved",
        ),
        pytest.param(
            alarm(
                Condition.CAMERA_CHANGED,
                measure=Measure(value=1.0, limit=0.0, unit=""),
                control=CameraControl.AUTOFOCUS,
            ),
            "Automatic focus changed from off to on since the calibration.",
            "Stop. Set it back, or calibrate and register again.",
            id="a switch is on or off",
        ),
        pytest.param(
            alarm(
                Condition.DRILL_UNSEEN,
                presence=Presence.NO,
                peak=Peak(measure=Measure(value=3.2, limit=1.0, unit="s"), severity=3.2, at_s=3.0),
            ),
            "Drill marker was not seen for 3.2 s.",
            "",
            id="seen again",
        ),
    ],
)
def test_an_alarm_in_words(reported: Alarm, sentence: str, remedy: str) -> None:
    words = alarm_text(reported, unix_offset_s=NOON_S)
    assert words.sentence["en"] == sentence
    assert words.remedy["en"] == remedy


@pytest.mark.parametrize("language", LANGUAGES)
@pytest.mark.parametrize("condition", Condition)
def test_beside_figures_that_are_not_live_nothing_that_they_show_is_said_of_now(
    condition: Condition, language: Language
) -> None:
    now = alarm(condition, measure=mm(-0.4), peak=peak(-0.8), presence=Presence.YES)
    said = alarm_text(now, unix_offset_s=NOON_S)
    without = alarm_text(with_unknown_presence(now), unix_offset_s=NOON_S)
    is_of_figures = (
        ALARM_RULES[condition].kind is Kind.PHYSIOLOGICAL or ALARM_RULES[condition].needs_current_image
    )
    assert (without.sentence[language] != said.sentence[language]) == is_of_figures
    assert (without.remedy[language] != said.remedy[language]) == is_of_figures
    assert without.title == said.title


@pytest.mark.parametrize("language", LANGUAGES)
@pytest.mark.parametrize("condition", Condition)
def test_every_condition_has_words_in_every_state(condition: Condition, language: Language) -> None:
    values = {"measure": mm(0.3, 0.5), "peak": peak(0.2)}
    has_number = "{value}" in PHRASES[language][condition].present
    for numbers in (values,) if has_number and not PHRASES[language][condition].bare else ({}, values):
        for presence in Presence:
            for state in (AlarmState.ACTIVE, AlarmState.ACKNOWLEDGED, AlarmState.LATCHED):
                words = alarm_text(alarm(condition, state, presence=presence, **numbers), unix_offset_s=0.0)
                assert words.title[language].isupper()
                sentence, remedy = words.sentence[language], words.remedy[language]
                assert sentence[0].isupper() or sentence[0].isdigit()
                assert sentence.endswith(".")
                assert "{" not in sentence
                assert "  " not in sentence
                is_present = presence is Presence.YES
                assert remedy.endswith(".") == (is_present or bool(remedy))
                if is_present:
                    assert remedy
                if presence is Presence.NO:
                    assert not remedy


@pytest.mark.parametrize("language", LANGUAGES)
def test_no_two_conditions_share_a_title(language: Language) -> None:
    assert len({alarm_title(condition)[language] for condition in Condition}) == len(Condition)


def test_who_acknowledged_is_named() -> None:
    known = alarm_text(breach(acknowledged_by="M. Ito"), unix_offset_s=0.0).known
    assert known == {"en": "Acknowledged by M. Ito.", "de": "Quittiert von M. Ito."}


def test_every_control_of_a_camera_has_a_name_in_every_language() -> None:
    for language in LANGUAGES:
        assert set(CONTROLS[language]) == set(CameraControl)
        assert len(set(CONTROLS[language].values())) == len(CameraControl)
    assert CONTROLS["en"] != CONTROLS["de"]
