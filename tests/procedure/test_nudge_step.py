"""Nudges by hand through the API: small, bounded, logged, undone, and checked again."""

import numpy as np
import pytest

from server.store import DocumentKind
from tests.procedure.conftest import Server
from tests.procedure.patient import Patient, ready, registered, states, withheld
from tracker.navigation import AbsentReason
from tracker.registration import Registration

NUDGES = "/api/registration/nudges"


def now(server: Server) -> Registration:
    found = registered(server)
    assert found is not None
    return found


def test_a_nudge_moves_the_vertebra_and_undone_it_is_as_it_was(server: Server) -> None:
    case_id = ready(server)
    patient = Patient(server=server)
    rejected = server.ask("GET", NUDGES, 409)
    assert rejected["code"] == "REGISTER_MISSING"
    patient.register()
    patient.check()
    made = now(server)
    step = {"made_by": "mori", "kind": "shift", "axis": "head", "amount": 1.0}
    reported = server.ask("POST", NUDGES, 201, json=step)
    assert reported["shift_mm"] == pytest.approx(1.0)
    assert [(one["axis"], one["amount"], one["made_by"]) for one in reported["nudges"]] == [
        ("head", 1.0, "mori")
    ]
    moved = now(server)
    way = moved.anchor_from_vertebra.translation_mm - made.anchor_from_vertebra.translation_mm
    np.testing.assert_allclose(way, made.anchor_from_vertebra.rotation[:, 2], atol=1e-9)
    assert np.trace(moved.covariance) > np.trace(made.covariance)
    # It is another registration than the checked one.
    assert withheld(server) is AbsentReason.NOT_CHECKED
    assert states(server)["check"] == "missing"

    server.ask("POST", NUDGES, 201, json={**step, "kind": "turn", "amount": -0.5})
    reported = server.ask("DELETE", f"{NUDGES}/last", 200, params={"made_by": "mori"})
    assert (len(reported["nudges"]), reported["version"]) == (1, 4)
    np.testing.assert_allclose(now(server).anchor_from_vertebra.matrix, moved.anchor_from_vertebra.matrix)
    reported = server.ask("DELETE", f"{NUDGES}/last", 200, params={"made_by": "mori"})
    assert (reported["nudges"], reported["shift_mm"], reported["rotation_deg"]) == ([], 0.0, 0.0)
    np.testing.assert_allclose(now(server).anchor_from_vertebra.matrix, made.anchor_from_vertebra.matrix)
    np.testing.assert_allclose(now(server).covariance, made.covariance)
    nothing = server.ask("DELETE", f"{NUDGES}/last", 409, params={"made_by": "mori"})
    assert nothing["code"] == "NUDGE_NONE"
    versions = server.store.history(case_id, DocumentKind.REGISTRATION, "L3")
    assert [one.made_by for one in versions] == ["ito", "mori", "mori", "mori", "mori"]
    patient.check()
    assert server.ask("GET", "/api/procedure", 200)["may_navigate"]


def test_nudges_that_came_in_with_an_archive_say_so_also_after_one_more(server: Server) -> None:
    case_id = ready(server)
    Patient(server=server).register()
    step = {"made_by": "mori", "kind": "shift", "axis": "head", "amount": 1.0}
    server.ask("POST", NUDGES, 201, json=step)
    archive = server.door.get(f"/api/cases/{case_id}/archive").content
    taken = server.ask("POST", "/api/cases/archive", 201, content=archive)["id"]
    server.ask("POST", f"/api/cases/{taken}/open", 200)
    (one,) = server.ask("GET", NUDGES, 200)["nudges"]
    assert one["made_by"] == "mori, says the archive"
    reported = server.ask("POST", NUDGES, 201, json=step)
    assert [one["made_by"] for one in reported["nudges"]] == ["mori, says the archive", "mori"]


def test_nudges_are_small_and_lead_only_so_far(server: Server) -> None:
    ready(server)
    Patient(server=server).register()
    step = {"made_by": "mori", "kind": "shift", "axis": "left", "amount": 1.0}
    assert server.ask("POST", NUDGES, 409, json={**step, "amount": 0.7})["code"] == "NUDGE_STEP_INVALID"
    server.ask("POST", NUDGES, 422, json={**step, "amount": 5.0})
    server.ask("POST", NUDGES, 422, json={**step, "axis": "up"})
    for _ in range(5):
        reported = server.ask("POST", NUDGES, 201, json=step)
    assert reported["shift_mm"] == pytest.approx(5.0)
    too_far = server.ask("POST", NUDGES, 409, json=step)
    assert too_far["code"] == "NUDGE_TOO_FAR"
    assert len(server.ask("GET", NUDGES, 200)["nudges"]) == 5
    server.ask("POST", NUDGES, 201, json={**step, "amount": -1.0})
