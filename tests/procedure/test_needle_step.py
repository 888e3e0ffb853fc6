"""Registration with needles through the API: by marks, by overlay, or rejected."""

from contextlib import ExitStack
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest

from server.store import DocumentKind
from tests.procedure.conftest import Server, serving
from tests.procedure.patient import (
    BY,
    DRILL,
    LANDMARKS,
    Patient,
    activate,
    plan_content,
    ready,
    registered,
    withheld,
)
from tracker.geometry import Array, Camera, Marker, Rigid, Vertebra
from tracker.navigation import AbsentReason
from tracker.plan import ReferenceSlice, SliceLine
from tracker.registration.needles import (
    RulerMeasurement,
    overlay_of_pose,
    planned_on_lines,
    view_prior_from_ruler,
)
from tracker.rehearsal import Theatre, TheatreSettings

NEEDLES = "/api/registration/needles"
CAMERA = Theatre(TheatreSettings()).camera
VIEW = {"vertical_mm": 380.0, "horizontal_mm": 240.0}
MEASURED = RulerMeasurement(vertical_mm=380.0, horizontal_mm=240.0)
NEEDLE_LANDMARKS = ["left transverse process", "right transverse process", "spinous process"]
MIDDLE = np.mean([LANDMARKS[name] for name in NEEDLE_LANDMARKS], axis=0)
IMAGE = np.full((CAMERA.size_wh_px[1], CAMERA.size_wh_px[0], 3), 90, np.uint8)
UP_MM = np.array([0.0, 40.0, 0.0])
ORIGIN_LPS_MM = (-50.0, -40.0, -5.0)


def truth() -> Rigid[Camera, Vertebra]:
    """Camera position by ruler."""
    middle_px = 0.5 * np.array(CAMERA.size_wh_px)
    view = view_prior_from_ruler(MEASURED, CAMERA, middle_px)
    x, y = CAMERA.normalised_from_px(middle_px.reshape(1, 2))[0]
    at = view.distance_mm * np.array([x, y, 1.0]) / np.linalg.norm([x, y, 1.0])
    return Rigid(rotation=view.rotation, translation_mm=at - view.rotation @ MIDDLE)


def px(*points_lps_mm: Array) -> list[list[float]]:
    found: list[list[float]] = CAMERA.px_from_camera(truth().move_points(np.array(points_lps_mm))).tolist()
    return found


def marked(names: list[str]) -> list[dict[str, Any]]:
    """Needles perpendicular on these landmarks."""
    ends = [px(np.array(LANDMARKS[name]), LANDMARKS[name] + UP_MM) for name in names]
    return [{"entry_px": entry, "head_px": head} for entry, head in ends]


def reference() -> ReferenceSlice:
    """Slice number 5, at z = 0."""
    return ReferenceSlice(
        slice_index=5,
        apart_mm=20.0,
        lines=tuple(
            SliceLine(
                name=name,
                ends_lps_mm=np.array([[x, 0.0, 0.0], [x, 50.0, 0.0]]),
                ends_px=np.array([[x + 50.0, 40.0], [x + 50.0, 90.0]]),
            )
            for name, x in (("middle", 0.0), ("left", 20.0), ("right", -20.0))
        ),
        paths=(),
    )


def with_slice(server: Server) -> None:
    """A case whose plan has a reference slice, on a CT that is white on the patient's left."""
    case_id = ready(server)
    hu = np.full((10, 100, 100), -1000, np.int16)
    hu[:, :, 50:] = 1500
    with server.store.new_file(case_id, ".npy") as new:
        np.save(new.path, hu)
    affine = np.eye(4)
    affine[:3, 3] = ORIGIN_LPS_MM
    ct = server.store.put(
        case_id,
        DocumentKind.CT,
        "main",
        {"lps_from_ijk": affine.tolist()},
        made_by="test",
        files=[new.stored.id],
    )
    content = plan_content("L3", references=(reference(),))
    server.store.put(case_id, DocumentKind.PLAN, "main", content, made_by="test", depends_on=[ct.id])
    activate(server)


def test_needles_that_are_marked_register_and_say_what_they_cannot_see(server: Server) -> None:
    ready(server)
    patient = Patient(server=server, camera_from_vertebra=truth())
    patient.show(None, image=IMAGE)
    requested = {"view": VIEW, "landmarks": NEEDLE_LANDMARKS, "marked": marked(NEEDLE_LANDMARKS)}
    document = server.ask("POST", f"{NEEDLES}/conclusion", 201, json={**requested, **BY})
    numbers = document["content"]["numbers"]
    assert document["content"]["method"] == "needles"
    assert numbers["needles"] == 3
    assert numbers["worst_offset_px"] < 1.0
    # Three needles in one image hardly determine their distance; the stated error includes that.
    assert numbers["depth_sd_mm"] > 2.0 * numbers["across_sd_mm"]
    assert numbers["tre_at_entry_mm"] > numbers["across_sd_mm"]
    found = registered(server)
    assert found is not None
    off = found.anchor_from_vertebra.move_points(MIDDLE) - truth().move_points(MIDDLE)
    assert np.linalg.norm(off) < 2.0
    assert withheld(server) is AbsentReason.NOT_CHECKED
    used = {**DRILL, "landmark": NEEDLE_LANDMARKS[0]}
    assert server.ask("POST", "/api/registration/check", 409, json=used)["code"] == "LANDMARK_WAS_USED"
    server.ask("POST", "/api/registration/check", 201, json={**DRILL, "landmark": "left lamina"})


def test_a_vertebra_without_a_planned_channel_is_registered_to_the_reference(
    tmp_path: Path, turns: ExitStack
) -> None:
    server = turns.enter_context(serving(tmp_path / "home", {"reference": {"marker": "reference"}}))
    case_id = ready(server)
    content = plan_content("L3", "L4")
    content["vertebrae"][1]["channels"] = []
    ct = server.store.current(case_id, DocumentKind.CT, "main")
    server.store.put(case_id, DocumentKind.PLAN, "main", content, made_by="test", depends_on=[ct.id])
    activate(server)
    beside: Rigid[Camera, Marker] = Rigid.from_vector([3.0, 0.1, 0.2], [60.0, 20.0, 430.0])
    Patient(server=server, camera_from_vertebra=truth(), camera_from_reference=beside).show(None, image=IMAGE)
    requested = {"view": VIEW, "landmarks": NEEDLE_LANDMARKS, "marked": marked(NEEDLE_LANDMARKS)}
    document = server.ask("POST", f"{NEEDLES}/conclusion", 201, json={**requested, **BY, "vertebra": "L4"})
    assert document["content"]["reference"] == "reference"


def test_the_slice_is_laid_over_the_picture_and_taken(server: Server) -> None:
    with_slice(server)
    patient = Patient(server=server)
    patient.show(None, image=IMAGE)
    first = server.ask("POST", f"{NEEDLES}/overlay", 200, json={"view": VIEW})
    assert first["overlay"]["shift_px"] == [0.5 * edge for edge in CAMERA.size_wh_px]
    assert [one["name"] for one in first["needles"]] == ["middle", "left", "right"]
    assert first["directions"] == []
    assert first["slice"] is not None

    places = planned_on_lines(reference())
    view = view_prior_from_ruler(MEASURED, CAMERA, 0.5 * np.array(CAMERA.size_wh_px))
    true_overlay = overlay_of_pose(truth(), places, CAMERA, view)
    overlay = {
        "shift_px": true_overlay.shift_px.tolist(),
        "rotation_deg": true_overlay.rotation_deg,
        "scale_px_per_mm": true_overlay.scale_px_per_mm,
    }
    ends = [px(place.point_lps_mm, place.point_lps_mm + 40.0 * place.direction_lps) for place in places]
    needles = [{"entry_px": entry, "head_px": head} for entry, head in ends]
    laid = server.ask(
        "POST", f"{NEEDLES}/overlay", 200, json={"view": VIEW, "overlay": overlay, "marked": needles}
    )
    assert max(one["beside_px"] for one in laid["needles"]) < 2.0
    # A page that draws the slice there shows each line's ends where the lens images them.
    assert (laid["slice"]["width_px"], laid["slice"]["height_px"]) == (100, 100)
    for line in reference().lines:
        there = np.column_stack([line.ends_px, np.ones(2)]) @ np.array(laid["slice"]["image_from_slice"]).T
        np.testing.assert_allclose(there[:, :2] / there[:, 2:], px(*line.ends_lps_mm), atol=1.5)

    requested = {**VIEW, "x_px": overlay["shift_px"][0], "y_px": overlay["shift_px"][1], "fade_ratio": 0.5}
    answer = server.door.get(f"{NEEDLES}/overlay.jpg", params=requested)
    assert answer.headers["content-type"] == "image/jpeg"
    drawn: Any = cv2.imdecode(np.frombuffer(answer.content, np.uint8), cv2.IMREAD_COLOR)
    assert drawn.shape == IMAGE.shape
    # White bone is on the patient's left, black air on the right, both at half opacity.
    (left, right) = px(np.array([30.0, 30.0, 0.0]), np.array([-30.0, 30.0, 0.0]))
    assert int(drawn[int(left[1]), int(left[0])].mean()) == pytest.approx((90 + 255) / 2, abs=4)
    assert int(drawn[int(right[1]), int(right[0])].mean()) == pytest.approx(90 / 2, abs=4)

    taken = server.ask("POST", f"{NEEDLES}/conclusion", 201, json={"view": VIEW, "overlay": overlay, **BY})
    assert taken["content"]["made_from"]["way"] == "overlay"
    assert registered(server) is not None


def drawn(names: list[str]) -> Any:  # noqa: ANN401  an image
    """Wires with heads, drawn finer than a pixel."""
    fine: Any = np.full((IMAGE.shape[0] * 4, IMAGE.shape[1] * 4, 3), (110, 90, 40), np.uint8)
    for one in marked(names):
        entry, head = (
            tuple(round(4.0 * value + 1.5) for value in one[end]) for end in ("entry_px", "head_px")
        )
        cv2.line(fine, entry, head, (180, 178, 176), 16, cv2.LINE_AA)
        cv2.circle(fine, head, 30, (60, 180, 230), -1, cv2.LINE_AA)
    return cv2.resize(fine, IMAGE.shape[1::-1], interpolation=cv2.INTER_AREA)


def test_needles_that_the_software_finds_are_proposed_and_kept_when_a_person_has_picked(
    server: Server,
) -> None:
    ready(server)
    patient = Patient(server=server, camera_from_vertebra=truth())
    patient.show(None, image=drawn(NEEDLE_LANDMARKS))
    requested = {"view": VIEW, "landmarks": NEEDLE_LANDMARKS}
    proposals = server.ask("POST", f"{NEEDLES}/proposal", 200, json=requested)["proposals"]
    best = proposals[0]
    assert best["probability_ratio"] == max(one["probability_ratio"] for one in proposals)
    assert [one["name"] for one in best["laid"]["needles"]] == NEEDLE_LANDMARKS
    assert all(abs(one["offset_mm"]) < 3.0 for one in best["laid"]["needles"])
    for found, true in zip(best["marked"], marked(NEEDLE_LANDMARKS), strict=True):
        assert np.linalg.norm(np.subtract(found["entry_px"], true["entry_px"])) < 6.0
    # Nobody has reviewed it yet.
    assert (
        server.ask("POST", f"{NEEDLES}/conclusion", 422, json={**requested, **BY})["code"]
        == "REQUEST_INVALID"
    )
    alone = {**requested, "picked": True, "overlay": best["laid"]["overlay"], **BY}
    assert server.ask("POST", f"{NEEDLES}/conclusion", 422, json=alone)["code"] == "REQUEST_INVALID"
    assert registered(server) is None
    picked = {**requested, "marked": best["marked"], "picked": True, **BY}
    document = server.ask("POST", f"{NEEDLES}/conclusion", 201, json=picked)
    assert document["content"]["made_from"]["way"] == "picked"
    # With the proposal's uncertainty, although a person's mark is more accurate.
    proposed, stored = best["laid"]["numbers"], document["content"]["numbers"]
    assert stored["across_sd_mm"] == pytest.approx(proposed["across_sd_mm"], rel=0.05)
    assert stored["tilt_sd_deg"] == pytest.approx(proposed["tilt_sd_deg"], rel=0.05)
    assert registered(server) is not None
    swapped = [best["marked"][number] for number in (1, 0, 2)]
    rejected = server.ask("POST", f"{NEEDLES}/conclusion", 409, json={**requested, "marked": swapped, **BY})
    assert rejected["code"] == "NEEDLES_SWAPPED"


def test_what_needles_cannot_do_is_rejected_with_a_remedy(server: Server) -> None:
    case_id = ready(server)
    patient = Patient(server=server)

    def code(path: str, status: int, **sent: Any) -> str:  # noqa: ANN401  JSON
        rejected = server.ask("POST", f"{NEEDLES}/{path}", status, json={"view": VIEW, **sent})
        assert rejected["remedy"]
        return str(rejected["code"])

    assert code("overlay", 503, landmarks=NEEDLE_LANDMARKS) == "NO_PICTURE"
    patient.show(None, image=IMAGE)
    assert code("overlay", 409) == "REFERENCE_MISSING"
    assert code("overlay", 409, landmarks=["nose"]) == "LANDMARK_UNKNOWN"
    assert code("proposal", 409, landmarks=NEEDLE_LANDMARKS) == "NEEDLES_NOT_FOUND"
    assert code("proposal", 409, landmarks=NEEDLE_LANDMARKS, use_touched=True) == "COLLECTION_MISSING"
    needles = marked(NEEDLE_LANDMARKS)
    two = {"landmarks": NEEDLE_LANDMARKS, "marked": needles[:2]}
    assert code("conclusion", 422, **two, **BY) == "NEEDLES_UNPAIRED"
    overlay = {"shift_px": [640.0, 360.0], "scale_px_per_mm": 3.0}
    both = {"landmarks": NEEDLE_LANDMARKS, "marked": needles, "overlay": overlay}
    assert code("conclusion", 422, **both, **BY) == "REQUEST_INVALID"
    assert code("proposal", 422, view={"vertical_mm": -1.0, "horizontal_mm": 1.0}) == "REQUEST_INVALID"
    assert registered(server) is None
    camera = server.store.current(case_id, DocumentKind.CAMERA, "main")
    server.store.withdraw(camera, by="test", reason="it fell")
    assert code("overlay", 409, landmarks=NEEDLE_LANDMARKS) == "CAMERA_OUT_OF_DATE"
