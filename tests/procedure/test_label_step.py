"""A segmentation of the vertebrae through the API: taken in, used, and rejected."""

import functools
from typing import Any

import numpy as np

from tests.procedure.conftest import Server
from tests.procedure.test_ct_step import BY, opened, sent
from tests.procedure.uploads import nifti, phantom, scanned
from tests.server.imaging.made_labels import label_nifti
from tracker.plan.labels import CLASS_OF_LEVEL, LabelVolume


@functools.cache
def labelled(level: str = "L3") -> LabelVolume:
    """True label of the phantom's vertebra in the voxels of its CT."""
    volume = scanned()
    index = np.argwhere(np.ones(volume.hu.shape, dtype=bool))[:, ::-1]
    inside = phantom().bone_distance_mm(volume.lps_from_index(index)) < 0.0
    labels = inside.reshape(volume.hu.shape) * np.uint8(CLASS_OF_LEVEL[level])
    return LabelVolume(labels=labels, lps_from_ijk=volume.lps_from_ijk, voxel_mm=1.0)


def send_labels(server: Server, content: bytes, **query: str) -> Any:  # noqa: ANN401  JSON
    job = server.ask("POST", "/api/labels", 202, content=content, params={**BY, **query})
    return server.done(job)


def test_labels_become_a_document_of_the_case_that_depends_on_its_ct(server: Server) -> None:
    opened(server)
    content = label_nifti(labelled())
    assert server.ask("POST", "/api/labels", 409, content=content, params=BY)["code"] == "CT_MISSING"
    assert server.ask("GET", "/api/labels", 409)["code"] == "LABELS_NOT_STORED"
    sent(server, nifti(scanned()))
    done = send_labels(server, content)
    assert done["state"] == "done", done["problem"]
    made = server.ask("GET", "/api/labels", 200)
    assert made["heading"]["current"]
    assert made["heading"]["made_by"] == BY["made_by"]
    ct = server.ask("GET", "/api/ct", 200)["heading"]["id"]
    assert made["heading"]["depends_on"] == [ct]
    (one,) = made["vertebrae"]
    assert one["level"] == "L3"
    assert one["is_cut"], "the phantom's processes leave its CT"
    file = server.door.get("/api/labels.nii.gz")
    assert file.status_code == 200
    again = {"If-None-Match": file.headers["etag"]}
    assert server.door.get("/api/labels.nii.gz", headers=again).status_code == 304
    # What the case has can be sent again, and gives the same.
    assert send_labels(server, file.content)["result"]["sha256"] == made["sha256"]
    # Another CT makes them out of date.
    sent(server, nifti(scanned()))
    assert not server.ask("GET", "/api/labels", 200)["heading"]["current"]


def test_wrong_labels_leave_nothing_behind(server: Server) -> None:
    opened(server)
    sent(server, nifti(scanned()))
    unnamed = server.ask("POST", "/api/labels", 422, content=b"x", params={**BY, "names": "29:liver"})
    assert unnamed["code"] == "LABEL_NAMES_INVALID"
    failed = send_labels(server, b"hello")
    assert failed["problem"]["code"] == "LABELS_MISSING"
    assert server.ask("GET", "/api/labels", 409)["code"] == "LABELS_NOT_STORED"


def with_vertebra(server: Server, name: str, label: str) -> str:
    """A case with a CT, the label of its vertebra, and a vertebra in the plan; its id."""
    case = opened(server)
    sent(server, nifti(scanned()))
    assert send_labels(server, label_nifti(labelled(label)))["state"] == "done"
    server.ask("POST", "/api/plan/vertebrae", 201, json={**BY, "name": name})
    return case


def measured(server: Server, name: str, side: str, point: list[float]) -> Any:  # noqa: ANN401  JSON
    request = {**BY, "seed_lps_mm": point}
    return server.done(server.ask("POST", f"/api/plan/vertebrae/{name}/pedicles/{side}", 202, json=request))


def test_both_pedicles_are_measured_from_the_label(server: Server) -> None:
    with_vertebra(server, "L3", "L3")
    starts = server.ask("GET", "/api/labels/starts/L3", 200)["starts"]
    assert [one["side"] for one in starts] == ["left", "right"]
    for start in starts:
        job = measured(server, "L3", start["side"], start["point_lps_mm"])
        assert job["state"] == "done", job["problem"]
        truth = phantom().truth(start["side"])
        assert abs(job["result"]["pedicle"]["width_mm"] - truth.width_mm) < 0.5
        server.ask("PUT", f"/api/plan/vertebrae/L3/channels/{start['side']}", 200, json=BY)
    compared = server.ask("GET", "/api/labels/channels", 200)["channels"]
    assert [(one["vertebra"], one["side"], one["level"], one["problem"]) for one in compared] == [
        ("L3", "left", "L3", None),
        ("L3", "right", "L3", None),
    ]
    assert server.ask("GET", "/api/labels/starts/L4", 409)["code"] == "LEVEL_WITHOUT_LABEL"
    place = server.ask("GET", "/api/ct/slices/axial?at_mm=0", 200)
    request = {key: place[key] for key in ("width_px", "height_px")}
    request["lps_from_px"] = [one for row in place["lps_from_px"] for one in row]
    (one,) = server.ask("GET", "/api/labels/outlines", 200, params=request)["outlines"]
    assert one["level"] == "L3"
    assert len(one["rings_lps_mm"]) >= 2, "the bone, and its canal as a hole"


def test_a_plan_for_another_level_than_its_label_is_refused_and_stated(server: Server) -> None:
    case = with_vertebra(server, "L3", "L4")
    hand = {"entry_lps_mm": [15, 14, 2], "target_lps_mm": [8, -30, 3], "diameter_mm": 6.0}
    lay = "/api/plan/vertebrae/L3/channels/left"
    rejection = server.ask("PUT", lay, 409, json={**BY, "by_hand": hand})
    assert rejection["code"] == "LEVEL_DOUBTFUL"
    assert "L4" in rejection["message"]
    assert server.ask("GET", "/api/plan", 200)["plan"]["vertebrae"][0]["channels"] == []

    # Labels that come after the plan do not change it; they are stated, and stop navigation.
    labels = server.ask("GET", "/api/labels", 200)["heading"]["id"]
    document = f"/api/cases/{case}/documents/{labels}/withdrawal"
    server.ask("POST", document, 200, json={"by": "test", "reason": "wrong"})
    server.ask("PUT", lay, 200, json={**BY, "by_hand": hand})
    server.ask("POST", "/api/plan/active-channel", 200, json={**BY, "vertebra": "L3", "side": "left"})

    def plan_step() -> Any:  # noqa: ANN401  JSON
        return next(one for one in server.ask("GET", "/api/procedure", 200)["steps"] if one["step"] == "plan")

    assert plan_step()["state"] == "done"
    assert send_labels(server, label_nifti(labelled("L4")))["state"] == "done"
    (one,) = server.ask("GET", "/api/labels/channels", 200)["channels"]
    assert one["problem"]["code"] == "LEVEL_DOUBTFUL"
    assert plan_step()["state"] == "out_of_date"
    assert "L4" in plan_step()["message"]
    again = {**BY, "vertebra": "L3", "side": "left"}
    assert server.ask("POST", "/api/plan/active-channel", 409, json=again)["code"] == "LEVEL_DOUBTFUL"
    # It can still be taken out, and the vertebra planned under its right name.
    server.ask("DELETE", f"{lay}?made_by=test", 200)
    server.ask("POST", "/api/plan/vertebrae", 201, json={**BY, "name": "L4"})
    server.ask("PUT", "/api/plan/vertebrae/L4/channels/left", 200, json={**BY, "by_hand": hand})
