"""The panel shows numbers if they are known, otherwise the reason; never both."""

from collections.abc import Callable

import pytest

from server.live import Instant
from server.number_format import NOT_KNOWN, format_number
from server.overlay import panel_of
from server.overlay.panel_readings import channel_name, small_print_of
from server.stream.assessment_messages import AssessmentMessage
from server.stream.messages import live_message
from tracker.navigation import NavigationSnapshot

SnapshotOf = Callable[..., NavigationSnapshot]


@pytest.mark.parametrize(
    ("theatre", "state"),
    [
        pytest.param({"seen": False}, "NO TRACKING", id="marker-unseen"),
        pytest.param({"calibrated": False}, "CAMERA NOT CALIBRATED", id="no-camera-file"),
        pytest.param({"registered": False}, "NOT REGISTERED", id="not-registered"),
        pytest.param({"planned": False}, "NO PLAN", id="no-plan"),
        pytest.param({"with_tool": False}, "TOOL NOT DEFINED", id="no-tool"),
        pytest.param(
            {"with_tool": False, "calibrated": False}, "CAMERA NOT CALIBRATED", id="camera-comes-first"
        ),
        pytest.param({"with_tool": False, "seen": False}, "NO TRACKING", id="nothing-at-all"),
    ],
)
def test_what_is_absent_is_said_in_words(
    snapshot_of: SnapshotOf, theatre: dict[str, bool], state: str
) -> None:
    panel = panel_of(snapshot_of(**theatre))
    assert panel.headline.title["en"] == state
    assert panel.readings == ()


def test_the_burned_in_numbers_are_the_numbers_of_the_message(
    snapshot_of: SnapshotOf, instant_of: Callable[..., Instant]
) -> None:
    snapshot = snapshot_of()
    message = live_message(instant_of(1, snapshot=snapshot), now_s=1.0)
    assert message.snapshot is not None
    assert message.snapshot.displayed_tool == "drill"
    sent = message.snapshot.tools[0].assessment
    assert isinstance(sent, AssessmentMessage)
    figures = sent.figures
    shown = (figures.entry, figures.angle, figures.depth, figures.to_go, figures.wall)
    panel = panel_of(snapshot)
    assert [reading.value for reading in panel.readings] == [
        NOT_KNOWN if figure.value is None else format_number(figure.value) for figure in shown
    ]
    assert [reading.status for reading in panel.readings] == [figure.status for figure in shown]
    assert panel.readings[-1].hint == sent.wall
    assert panel.headline.verdict is sent.verdict
    assert panel.headline.title["en"] == message.headline.title.en


def test_a_drill_across_the_channel_has_no_entry_offset(snapshot_of: SnapshotOf) -> None:
    readings = panel_of(snapshot_of(tilt_rad=1.5707963)).readings
    assert readings[0].value == NOT_KNOWN
    assert readings[1].value == "90.0"


def test_the_small_print_is_of_one_language(snapshot_of: SnapshotOf) -> None:
    snapshot = snapshot_of()
    number = snapshot.image_number
    assert small_print_of(snapshot, "en") == (
        "L3 left · registered by the rehearsal",
        f"image {number} · research software, not a medical device",
    )
    assert small_print_of(snapshot, "de") == (
        "L3 links · registriert über Probebetrieb",
        f"Bild {number} · Forschungssoftware, kein Medizinprodukt",
    )
    assert small_print_of(snapshot_of(planned=False), "en")[0] == ""


@pytest.mark.parametrize(
    ("name", "shown"),
    [("rehearsal's L3 right", "L3 rechts · Probebetrieb"), ("S1 alar", "S1 alar"), ("left", "left")],
)
def test_only_names_that_the_program_made_are_translated(name: str, shown: str) -> None:
    assert channel_name(name, "de") == shown
    assert channel_name(name, "en") == name
