"""Refinement of a registration by a sweep over the bone, through the API, and its rejections."""

from typing import Any

import numpy as np

from server.imaging.meshes import ply_from_surface, read_mesh
from server.store import DocumentKind
from tests.procedure.conftest import Server
from tests.procedure.patient import (
    BY,
    CAMERA_FROM_VERTEBRA,
    DRILL,
    Patient,
    drill_at,
    ready,
    registered,
    states,
    withheld,
)
from tests.tracker.registration.sweeps import corners_from_behind, vertebra
from tracker.geometry import Array
from tracker.navigation import AbsentReason

SWEEP = "/api/registration/sweep"
ENTRY = np.array([15.0, 14.0, 2.0])


def with_bone(server: Server, case_id: str) -> None:
    with server.store.new_file(case_id, ".ply") as new:
        new.path.write_bytes(ply_from_surface(vertebra()))
    assert len(read_mesh(server.store.file(case_id, new.stored.id).path, unit="mm").surface.faces) > 100
    server.store.put(case_id, DocumentKind.SURFACE, "main", {}, made_by="test", files=[new.stored.id])


def swept(server: Server, patient: Patient, points_lps_mm: Array) -> Any:  # noqa: ANN401  JSON
    """Show the tip at each of these points, and wait until all were captured."""
    reported = server.ask("GET", SWEEP, 200)
    for point in points_lps_mm:
        wanted = reported["points"] + 1
        patient.show(drill_at(CAMERA_FROM_VERTEBRA.move_points(point) + patient.random.normal(0, 0.1, 3)))

        def taken(wanted: int = wanted) -> bool:
            nonlocal reported
            reported = server.ask("GET", SWEEP, 200)
            return bool(reported["points"] >= wanted)

        server.until(taken)
    return reported


def on_bone(corners: Array, count: int) -> Array:
    random = np.random.default_rng(3)
    chosen = corners[random.choice(len(corners), count)]
    return np.asarray(np.einsum("nk,nkj->nj", random.dirichlet([1.0, 1.0, 1.0], count), chosen))


def test_a_sweep_makes_the_next_version_of_the_registration(server: Server) -> None:
    case_id = ready(server)
    patient = Patient(server=server)
    patient.show(None)
    assert server.ask("POST", SWEEP, 409, json=DRILL)["code"] == "REGISTER_MISSING"
    patient.register()
    assert server.ask("POST", SWEEP, 409, json=DRILL)["code"] == "SURFACE_MISSING"
    with_bone(server, case_id)
    patient.check()
    server.ask("POST", SWEEP, 201, json=DRILL)
    assert server.ask("POST", f"{SWEEP}/fit", 409)["code"] == "SURFACE_SWEEP_SMALL"
    reported = swept(server, patient, on_bone(corners_from_behind(), 40))
    assert reported["reach_mm"][0] > 20.0
    # A lifted tip is ignored.
    server.ask("PUT", SWEEP, 200, json={"taking": False})
    patient.show(drill_at(np.array([0.0, 0.0, 300.0])))
    fit = server.ask("POST", f"{SWEEP}/fit", 200)
    assert fit["missing"] == []
    assert fit["numbers"]["rms_mm"] < 0.5
    document = server.ask("POST", f"{SWEEP}/conclusion", 201, json=BY)
    assert document["heading"]["version"] == 2
    assert document["content"]["method"] == "surface"
    assert document["content"]["numbers"]["points"] == 40
    found = registered(server)
    assert found is not None
    off = found.anchor_from_vertebra.move_points(ENTRY) - CAMERA_FROM_VERTEBRA.move_points(ENTRY)
    assert np.linalg.norm(off) < 0.5
    assert withheld(server) is AbsentReason.NOT_CHECKED
    patient.check()
    assert withheld(server) is None
    # Another bone surface ends it.
    with_bone(server, case_id)
    assert states(server)["register"] == "out_of_date"


def test_a_sweep_that_was_overtaken_or_slides_is_not_kept(server: Server) -> None:
    case_id = ready(server)
    with_bone(server, case_id)
    patient = Patient(server=server)
    patient.register()
    server.ask("POST", SWEEP, 201, json=DRILL)
    # One small area of bone determines almost nothing.
    corners = corners_from_behind()
    near = np.argsort(np.linalg.norm(corners.mean(axis=1) - corners[0].mean(axis=0), axis=1))[:6]
    swept(server, patient, on_bone(corners[near], 14))
    small = server.ask("POST", f"{SWEEP}/conclusion", 409, json=BY)
    assert small["code"].startswith("SURFACE_")
    assert small["remedy"]

    swept(server, patient, on_bone(corners, 40))
    nudge = {**BY, "kind": "shift", "axis": "left", "amount": 0.5}
    server.ask("POST", "/api/registration/nudges", 201, json=nudge)
    overtaken = server.ask("POST", f"{SWEEP}/conclusion", 409, json=BY)
    assert overtaken["code"] == "VERSION_CONFLICT"
    server.ask("DELETE", SWEEP, 204)
    assert server.ask("GET", SWEEP, 409)["code"] == "COLLECTION_MISSING"
