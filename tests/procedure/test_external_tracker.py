"""With an external tracker what a camera made is not used, and what needs images is rejected."""

from pathlib import Path

import pytest

from server.procedure.registration_record import (
    RegistrationEvidence,
    RegistrationRecord,
    registration_from_document,
)
from server.store import CaseStore, DocumentKind, Home
from tests.procedure.conftest import serving
from tests.procedure.test_camera_step import DOTS
from tests.server.loop.test_external_tracking import CONFIG, DRILL, PATIENT
from tracker.errors import RegistrationError
from tracker.geometry import Rigid
from tracker.registration import Registration

AWL = {"name": "awl", "side_mm": 9, "made_by": "Anna"}
SETTINGS = {
    "camera": {"source": "openigtlink"},
    "external_tracker": CONFIG.model_dump(mode="json")["external_tracker"],
    "reference": {"marker": PATIENT},
}


def test_a_registration_to_a_camera_is_not_used_with_an_external_tracker(tmp_path: Path) -> None:
    record = RegistrationRecord.of(
        Registration.known_to_camera(Rigid.identity()),
        RegistrationEvidence(from_s=None),
        vertebra="L3",
        reference="",
        run="1",
    )
    store = CaseStore(Home(tmp_path))
    case = store.create("any")
    content = record.model_dump(mode="json")
    document = store.put(case.id, DocumentKind.REGISTRATION, "L3", content, made_by="Anna")
    assert registration_from_document(document, reference="", has_images=True).vertebra == "L3"
    with pytest.raises(RegistrationError) as rejected:
        registration_from_document(document, reference=PATIENT, has_images=False)
    assert rejected.value.code == "REGISTERED_TO_CAMERA"


def test_rigid_bodies_take_the_place_of_markers_and_steps_that_need_images_say_so(tmp_path: Path) -> None:
    with serving(tmp_path, SETTINGS) as server:
        case = server.ask("POST", "/api/cases", 201, json={"name": "tracked"})
        server.ask("POST", f"/api/cases/{case['id']}/open", 200)
        server.show(at_s=1.0)
        bodies = server.ask("GET", "/api/markers", 200)["markers"]
        assert [(one["name"], one["side_mm"]) for one in bodies] == [(DRILL, None), (PATIENT, None)]
        picture = server.ask("GET", f"/api/markers/{DRILL}/picture", 404)
        added = server.ask("POST", "/api/markers", 409, content=b"x", params=AWL)
        board = server.ask("POST", "/api/camera/collection", 409, json={"board": DOTS})
        latency = server.ask("POST", "/api/latency/measurement", 409, json={"codes": 20})
        codes = [one["code"] for one in (picture, added, board, latency)]
        assert codes == ["MARKER_WITHOUT_IMAGE", *["NO_CAMERA_IN_USE"] * 3]
        steps = server.ask("GET", "/api/procedure", 200)["steps"]
        assert (steps[0]["state"], steps[0]["code"]) == ("done", "EXTERNAL_TRACKER")
