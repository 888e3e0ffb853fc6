"""After a start there is no navigation until a person has confirmed that nothing has moved."""

import shutil
import time
from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from server.store import DocumentKind
from tests.procedure.conftest import Server, serving
from tests.procedure.patient import (
    CAMERA_FROM_VERTEBRA,
    Patient,
    activate,
    drill_at,
    ready,
    registered,
    states,
    withheld,
)
from tracker.geometry import Camera, Marker, Rigid
from tracker.navigation import Absent, AbsentReason, Deviation, ToolPose, VertebraPose

REFERENCE = {"reference": {"marker": "reference"}}
CAMERA_FROM_REFERENCE: Rigid[Camera, Marker] = Rigid.from_vector([3.0, 0.1, 0.2], [60.0, 20.0, 430.0])
CONFIRM = "/api/procedure/confirmation"
ON_ENTRY = drill_at(CAMERA_FROM_VERTEBRA.move_points(np.array([15.0, 14.0, 2.0])))


def requested(server: Server) -> Any:  # noqa: ANN401  JSON
    """The requested confirmation, if any."""
    return server.ask("GET", "/api/procedure", 200)["confirmation"]


def beside_a_reference(server: Server) -> Patient:
    return Patient(server=server, camera_from_reference=CAMERA_FROM_REFERENCE)


@pytest.fixture(scope="module")
def checked_home(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of a server whose open case was registered to the patient marker and checked."""
    folder = tmp_path_factory.mktemp("checked")
    with serving(folder, REFERENCE) as server:
        ready(server)
        patient = beside_a_reference(server)
        patient.register()
        patient.check()
        assert requested(server) is None
    return folder


@pytest.fixture
def started_again(checked_home: Path, tmp_path: Path, turns: ExitStack) -> Server:
    """A server started in a copy of that folder."""
    shutil.copytree(checked_home, tmp_path, dirs_exist_ok=True)
    return turns.enter_context(serving(tmp_path, REFERENCE))


def test_after_a_start_the_plan_is_shown_and_no_drill_until_a_person_confirms(started_again: Server) -> None:
    server, patient = started_again, beside_a_reference(started_again)
    shown = patient.show(ON_ENTRY)
    assert isinstance(shown.vertebra, VertebraPose)
    stopped = Absent(reason=AbsentReason.NOT_CONFIRMED)
    assert (shown.tools["drill"], shown.deviations["drill"], shown.analyses["drill"]) == (stopped,) * 3

    reported = server.ask("GET", "/api/procedure", 200)
    assert not reported["may_navigate"]
    assert {one["step"]: one["state"] for one in reported["steps"]} == {
        **dict.fromkeys(("camera", "tool", "plan", "register", "check"), "done"),
        "navigate": "missing",
    }
    assert reported["next_step"] == "navigate"
    needed = reported["confirmation"]
    assert needed["because"] == "server_started"
    assert (needed["vertebra"], needed["registered_by"], needed["reference"]) == ("L3", "ito", "reference")
    assert needed["message"] in reported["steps"][-1]["message"]

    after = server.ask("POST", CONFIRM, 200, json={"registration_id": needed["registration_id"]})
    assert (after["may_navigate"], after["confirmation"]) == (True, None)
    shown = patient.show(ON_ENTRY)
    assert isinstance(shown.tools["drill"], ToolPose)
    assert isinstance(shown.deviations["drill"], Deviation)
    (stored,) = server.store.all(reported["case_id"], DocumentKind.CONFIRMATION)
    assert (stored.made_by, stored.content["because"]) == ("this computer", "server_started")
    assert stored.depends_on == (needed["registration_id"],)


def test_a_second_word_is_no_second_document_and_holds_for_one_run(
    started_again: Server, tmp_path: Path, turns: ExitStack
) -> None:
    server = started_again
    beside_a_reference(server).show(None)
    word = {"registration_id": requested(server)["registration_id"]}
    server.ask("POST", CONFIRM, 200, json=word)
    server.ask("POST", CONFIRM, 200, json=word)
    opened = server.store.get_open_case()
    assert opened is not None
    assert len(server.store.history(opened.id, DocumentKind.CONFIRMATION, "going on with L3")) == 1
    # Opened within the same run, it stays confirmed; the next start asks again.
    server.ask("POST", f"/api/cases/{opened.id}/close", 200)
    server.ask("POST", f"/api/cases/{opened.id}/open", 200)
    assert withheld(server) is None
    turns.close()
    again = turns.enter_context(serving(tmp_path, REFERENCE))
    assert withheld(again) is AbsentReason.NOT_CONFIRMED
    # Closing and opening the case does not replace a confirmation either.
    again.ask("POST", f"/api/cases/{opened.id}/close", 200)
    assert requested(again) is None
    again.ask("POST", f"/api/cases/{opened.id}/open", 200)
    assert withheld(again) is AbsentReason.NOT_CONFIRMED


def test_nobody_confirms_what_they_do_not_see_or_what_is_not_in_use(started_again: Server) -> None:
    server = started_again
    needed = requested(server)
    blind = server.ask("POST", CONFIRM, 409, json={"registration_id": needed["registration_id"]})
    assert blind["code"] == "CONFIRMATION_UNSEEN"
    beside_a_reference(server).show(None)
    other = server.ask("POST", CONFIRM, 409, json={"registration_id": "0123456789abcdef"})
    assert other["code"] == "CONFIRMATION_OUT_OF_DATE"
    assert other["context"]["registration_id"] == needed["registration_id"]
    assert withheld(server) is AbsentReason.NOT_CONFIRMED


def test_a_tip_on_a_landmark_is_more_than_a_word(started_again: Server) -> None:
    patient = beside_a_reference(started_again)
    patient.show(None)
    patient.check()
    assert requested(started_again) is None
    assert withheld(started_again) is None


def test_a_new_tracking_process_did_not_watch_the_camera_before(server: Server) -> None:
    ready(server)
    patient = Patient(server=server)
    patient.register()
    patient.check()
    assert isinstance(patient.show(ON_ENTRY).deviations["drill"], Deviation)
    server.tracked_from_s.append(time.monotonic())
    needed = requested(server)
    assert needed["because"] == "tracking_started"
    assert needed["reference"] is None
    assert states(server)["navigate"] == "missing"
    # A registration adopted before is not used for navigation, whatever is published meanwhile.
    before = server.adopted[-1]
    assert before.withheld is None
    assert before.tracked_from(server.tracked_from_s[-1]).withheld is AbsentReason.NOT_CONFIRMED
    server.ask("POST", CONFIRM, 200, json={"registration_id": needed["registration_id"]})
    assert server.adopted[-1].tracked_from(server.tracked_from_s[-1]).withheld is None
    assert requested(server) is None


def test_beside_a_reference_a_new_tracking_process_goes_on(tmp_path: Path, turns: ExitStack) -> None:
    server = turns.enter_context(serving(tmp_path, REFERENCE))
    ready(server)
    patient = beside_a_reference(server)
    patient.register()
    patient.check()
    server.tracked_from_s.append(time.monotonic())
    assert requested(server) is None
    assert server.adopted[-1].tracked_from(server.tracked_from_s[-1]).withheld is None


def test_what_is_registered_in_this_run_needs_no_word_and_the_other_vertebra_does(
    tmp_path: Path, turns: ExitStack
) -> None:
    server = turns.enter_context(serving(tmp_path, REFERENCE))
    ready(server, "L3", "L4")
    patient = beside_a_reference(server)
    patient.register()
    patient.check()
    turns.close()
    again = turns.enter_context(serving(tmp_path, REFERENCE))
    activate(again, "L4")
    assert (requested(again), registered(again)) == (None, None)
    patient = beside_a_reference(again)
    patient.register()
    patient.check()
    assert withheld(again) is None
    activate(again, "L3")
    assert requested(again)["vertebra"] == "L3"
    assert withheld(again) is AbsentReason.NOT_CONFIRMED


def test_with_no_case_open_there_is_nothing_to_confirm(
    server: Server, restarted: Callable[[], Server]
) -> None:
    assert requested(server) is None
    again = restarted()
    assert again.ask("POST", CONFIRM, 409, json={"registration_id": "a"})["code"] == "NO_CASE_OPEN"
