"""Placed screws through the API: stored where the drill was, in use with the next image, withdrawn."""

import time
from typing import Any

import numpy as np
import pytest

from server.store import DocumentKind
from tests.procedure.conftest import Server
from tests.procedure.patient import (
    BY,
    CAMERA_FROM_VERTEBRA,
    TIP_IN_MARKER,
    Patient,
    activate,
    marker_seen,
    ready,
)
from tracker.geometry import Rigid, rotation_between
from tracker.pose import Seen

PLACEMENTS = "/api/navigation/placements"
SIZE = {"diameter_mm": 5.5, "length_mm": 40.0}
LEFT = {**BY, "vertebra": "L3", "side": "left"}
PLACE = {**LEFT, **SIZE}
PLACE_RIGHT = {**PLACE, "side": "right"}
ENTRY = {"left": np.array([15.0, 14.0, 2.0]), "right": np.array([-15.0, 14.0, 2.0])}
TARGET = {"left": np.array([8.0, -30.0, 3.0]), "right": np.array([-8.0, -30.0, 3.0])}


def axis_of(side: str) -> np.ndarray:
    along = TARGET[side] - ENTRY[side]
    return np.asarray(along / np.linalg.norm(along))


def drilled(depth_mm: float, *, side: str = "left") -> Seen:
    """The drill along a channel of L3, its tip at this depth."""
    direction = CAMERA_FROM_VERTEBRA.rotate_directions(axis_of(side))
    tip = CAMERA_FROM_VERTEBRA.move_points(ENTRY[side] + depth_mm * axis_of(side))
    rotation = rotation_between([0.0, -1.0, 0.0], direction)
    return marker_seen(Rigid(rotation=rotation, translation_mm=tip - rotation @ TIP_IN_MARKER))


def channels(server: Server) -> dict[str, Any]:
    listed = server.ask("GET", PLACEMENTS, 200)["channels"]
    return {f"{one['vertebra']} {one['side']}": one for one in listed}


def rejected(server: Server, status: int = 409, request: dict[str, Any] = PLACE) -> str:
    return str(server.ask("POST", PLACEMENTS, status, json=request)["code"])


@pytest.fixture
def patient(server: Server) -> Patient:
    """Registered and checked; its images are newer than the present, so that none is too old."""
    ready(server)
    patient = Patient(server=server, at_s=time.monotonic() + 3600.0)
    patient.register()
    patient.check()
    return patient


def test_a_screw_is_placed_where_the_drill_is_and_used_from_the_next_image(
    server: Server, patient: Patient
) -> None:
    assert [one["is_active"] for one in channels(server).values()] == [True, False]
    shown = patient.show(drilled(30.0))
    server.ask("POST", PLACEMENTS, 201, json=PLACE)
    listed = channels(server)
    assert listed["L3 right"]["placement"] is None
    one = listed["L3 left"]["placement"]
    assert (one["placed_by"], one["tool"], one["out_of_date"]) == ("ito", "drill", None)
    assert one["image_number"] == shown.image_number
    assert one["figures"]["depth"]["value"] == pytest.approx(30.0, abs=1.5)
    # The registration has an error of some tenths of a millimetre.
    (screw,) = patient.show(drilled(30.0)).setup.placed_screws
    np.testing.assert_allclose(screw.head_in_vertebra_mm, ENTRY["left"], atol=1.5)
    along = screw.tip_in_vertebra_mm - screw.head_in_vertebra_mm
    assert np.linalg.norm(along) == pytest.approx(40.0)
    assert along @ axis_of("left") == pytest.approx(40.0, abs=0.1)
    # The drill goes on; the screw stays.
    assert patient.show(None).setup.placed_screws[0].name == "L3 left"


def test_a_second_placement_replaces_the_first_and_withdrawn_there_is_none(
    server: Server, patient: Patient
) -> None:
    patient.show(drilled(20.0))
    server.ask("POST", PLACEMENTS, 201, json=PLACE)
    patient.show(drilled(35.0))
    server.ask("POST", PLACEMENTS, 201, json=PLACE)
    one = channels(server)["L3 left"]["placement"]
    assert one["figures"]["depth"]["value"] == pytest.approx(35.0, abs=1.5)
    server.ask("DELETE", f"{PLACEMENTS}/{one['document_id']}", 200, params=BY)
    assert channels(server)["L3 left"]["placement"] is None
    assert patient.show(None).setup.placed_screws == ()


def test_the_other_side_keeps_the_first_screw(server: Server, patient: Patient) -> None:
    patient.show(drilled(20.0))
    server.ask("POST", PLACEMENTS, 201, json=PLACE)
    activate(server, side="right")
    patient.show(drilled(20.0))
    assert rejected(server, request=PLACE_RIGHT) == "DRILL_NOT_IN_CHANNEL"
    patient.show(drilled(20.0, side="right"))
    # A page that still names the other side.
    assert rejected(server) == "PLACEMENT_OTHER_CHANNEL"
    server.ask("POST", PLACEMENTS, 201, json=PLACE_RIGHT)
    assert all(one["placement"] for one in channels(server).values())
    assert {one.name for one in patient.show(None).setup.placed_screws} == {"L3 left", "L3 right"}


def test_after_another_registration_a_placement_is_out_of_date_and_not_drawn(
    server: Server, patient: Patient
) -> None:
    patient.show(drilled(20.0))
    server.ask("POST", PLACEMENTS, 201, json=PLACE)
    patient.register()
    assert "was replaced" in channels(server)["L3 left"]["placement"]["out_of_date"]
    assert patient.show(None).setup.placed_screws == ()


def test_what_is_not_known_is_not_placed(server: Server, patient: Patient) -> None:
    patient.show(None)
    assert rejected(server) == "PLACEMENT_NO_NUMBERS"
    patient.show(drilled(-5.0))
    assert rejected(server) == "DRILL_NOT_IN_BONE"
    patient.show(drilled(20.0))
    assert rejected(server, request=LEFT) == "PLACEMENT_NO_SCREW"
    assert rejected(server, 422, {**LEFT, "length_mm": 40.0}) == "SCREW_INCOMPLETE"
    # An image of another channel, as between a change of the channel and the next image.
    activate(server, side="right")
    assert rejected(server, request=PLACE_RIGHT) == "PLACEMENT_SETUP_CHANGED"
    assert all(one["placement"] is None for one in channels(server).values())


def test_an_old_image_places_nothing(server: Server, patient: Patient) -> None:
    patient.at_s = time.monotonic() - 5.0
    patient.show(drilled(20.0))
    assert rejected(server) == "PLACEMENT_NO_IMAGE"


def test_without_a_registration_nothing_is_placed(server: Server) -> None:
    case_id = ready(server)
    assert rejected(server) == "REGISTER_MISSING"
    assert server.store.all(case_id, DocumentKind.PLACEMENT) == ()
    plan = server.store.current(case_id, DocumentKind.PLAN, "main")
    assert server.ask("DELETE", f"{PLACEMENTS}/{plan.id}", 409, params=BY)["code"] == "PLACEMENT_UNKNOWN"


def test_the_channel_that_the_drill_is_nearer_to_is_proposed_and_not_switched(
    server: Server, patient: Patient
) -> None:
    observe = server.steps.channel_proposer.observe

    def proposal_after(seen: Seen | None) -> Any:  # noqa: ANN401  a proposal or None
        return [observe(patient.show(seen)) for _ in range(40)][-1]

    assert proposal_after(drilled(-2.0)) is None
    proposed = proposal_after(drilled(-2.0, side="right"))
    assert (proposed.vertebra, proposed.side, proposed.is_registered) == ("L3", "right", True)
    assert [one["is_active"] for one in channels(server).values()] == [True, False]
    # Without a pose nothing is proposed.
    assert proposal_after(None) is None
    # Switched by a person: the chosen one is not proposed.
    activate(server, side="right")
    assert proposal_after(drilled(-2.0, side="right")) is None
    assert proposal_after(drilled(-2.0)).side == "left"
    # A channel with its screw is not proposed.
    activate(server)
    patient.show(drilled(30.0))
    server.ask("POST", PLACEMENTS, 201, json=PLACE)
    activate(server, side="right")
    assert proposal_after(drilled(-2.0)) is None
