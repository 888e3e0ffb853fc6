"""From an empty case to an active channel, through the API; and rejections."""

import json
from typing import Any

import numpy as np
import pytest

from tests.procedure.conftest import Server
from tests.procedure.test_ct_step import BY, opened, picture, sent
from tests.procedure.uploads import dicom_zip, nifti, phantom, scanned
from tracker.errors import PlanError
from tracker.navigation.clearance import WallSource
from tracker.rehearsal.ct import PedicleTruth

VOXEL_MM = 1.0


def measured(server: Server, side: str) -> Any:  # noqa: ANN401  JSON
    click = {**BY, "seed_lps_mm": phantom().seed_lps_mm(side, (1.0, 0.5, -0.5)).tolist()}
    job = server.done(server.ask("POST", f"/api/plan/vertebrae/L3/pedicles/{side}", 202, json=click))
    assert job["state"] == "done", job["problem"]
    return job["result"]["pedicle"]


def agrees(pedicle: dict[str, Any], truth: PedicleTruth) -> None:
    assert pedicle["width_mm"] == pytest.approx(truth.width_mm, abs=VOXEL_MM / 2)
    assert pedicle["height_mm"] == pytest.approx(truth.height_mm, abs=VOXEL_MM / 2)
    off_deg = np.degrees(np.arccos(min(1.0, float(np.dot(pedicle["axis_lps"], truth.axis_lps)))))
    assert off_deg < 2.0


def planned(server: Server, content: bytes) -> Any:  # noqa: ANN401  JSON
    """A case with a CT, L3 with both pedicles and channels."""
    opened(server)
    assert sent(server, content)["state"] == "done"
    server.ask("POST", "/api/plan/vertebrae", 201, json={**BY, "name": "L3"})
    for side in ("left", "right"):
        agrees(measured(server, side), phantom().truth(side))
        server.ask("PUT", f"/api/plan/vertebrae/L3/channels/{side}", 200, json=BY)
    return server.ask("GET", "/api/plan", 200)


def test_from_an_empty_case_to_a_channel_to_be_drilled(server: Server) -> None:
    catalogue = server.ask("GET", "/api/plan/catalogue", 200)
    assert (catalogue["min_landmarks"], catalogue["ranges"]) == (3, [])
    plan = planned(server, dicom_zip())
    assert plan["heading"]["current"]
    assert plan["heading"]["version"] == 5

    # The proposed reference slice of the vertebra, with its three lines and the channels.
    proposal = server.ask("GET", "/api/plan/proposals/slice?vertebra=L3", 200)
    isthmus = scanned().index_from_lps(phantom().truth("left").isthmus_lps_mm)
    assert proposal["slice_index"] == pytest.approx(isthmus[2], abs=1.0)
    chosen = server.ask("PUT", "/api/plan/vertebrae/L3/reference", 200, json={**BY, "apart_mm": 20})
    reference = chosen["plan"]["vertebrae"][0]["references"][0]
    assert [line["name"] for line in reference["lines"]] == ["middle", "left", "right"]
    drawn = picture(server, "/api/plan/vertebrae/L3/reference.png")
    assert min(drawn.shape[:2]) >= 512
    coloured = (drawn.max(axis=2) - drawn.min(axis=2)) > 60
    assert 0.002 < coloured.mean() < 0.1

    # The channel came with the proposed screw of the catalogue, with all of its values.
    size = server.ask("GET", "/api/plan/proposals/screw?vertebra=L3&side=left", 200)
    assert 4.0 <= size["diameter_mm"] <= 8.0
    with_screw = server.ask("GET", "/api/plan", 200)
    left = next(one for one in with_screw["plan"]["vertebrae"][0]["channels"] if one["side"] == "left")
    screw = left["screws"][0]
    assert {name: screw[name] for name in size} == size
    assert screw["clearance"]["grade"] == "A"
    assert screw["tolerance"]["max_offset_mm"] > 0.4
    assert screw["bone"]["mean_hu"] > 100

    # Its clearance by depth is that of the figures, with the limit of the settings.
    without = server.ask("DELETE", "/api/plan/vertebrae/L3/channels/right/screw", 200, params=BY)
    clearances = server.ask("GET", "/api/plan/clearances", 200)
    assert (clearances["plan_id"], clearances["margin_mm"]) == (without["heading"]["id"], 0.5)
    by_side = {one["side"]: one["clearance"] for one in clearances["channels"]}
    assert by_side["right"] == {"kind": "absent", "reason": "NO_SCREW"}
    walls = ("medial_mm", "lateral_mm", "superior_mm", "inferior_mm")
    assert by_side["left"]["against"] == "pedicle"
    assert by_side["left"]["min_mm"] == pytest.approx(min(screw["clearance"][wall] for wall in walls))
    assert by_side["left"]["min_mm"] == pytest.approx(min(by_side["left"]["clearance_mm"]), abs=1e-3)
    assert 0.0 < by_side["left"]["min_depth_mm"] < screw["length_mm"]

    # The active channel reaches the tracking process and survives other changes.
    assert server.adopted == [] or server.adopted[-1].channel is None
    now = {**BY, "vertebra": "L3", "side": "left"}
    server.ask("POST", "/api/plan/active-channel", 200, json=now)
    channel = server.adopted[-1].channel
    assert channel is not None
    assert channel.name == "L3 left"
    truth = phantom().truth("left")
    away = truth.isthmus_lps_mm - channel.entry_in_vertebra_mm
    beside = np.linalg.norm(away - (away @ channel.axis_in_vertebra) * channel.axis_in_vertebra)
    assert beside < 0.6
    assert 2 * channel.radius_mm == pytest.approx(truth.width_mm, abs=VOXEL_MM / 2)
    adopted_before = len(server.adopted)
    server.ask("POST", "/api/plan/vertebrae", 201, json={**BY, "name": "L4"})
    assert server.ask("GET", "/api/plan", 200)["active_channel"]["side"] == "left"
    channels = [case.channel for case in server.adopted[adopted_before:]]
    assert None not in (channels or [None]), "navigation has its channel at every moment of the change"

    # The corrected value is used, the measured one is kept; the channel changed and must be chosen again.
    corrected = {**BY, "corrected": {"width_mm": 7.0, "transverse_deg": 12.0}}
    after = server.ask("PUT", "/api/plan/vertebrae/L3/pedicles/left/corrections", 200, json=corrected)
    record = next(
        one for one in after["plan"]["vertebrae"][0]["pedicles"] if one["measured"]["side"] == "left"
    )
    assert record["measured"]["width_mm"] == pytest.approx(truth.width_mm, abs=VOXEL_MM / 2)
    assert after["used"]["L3"]["left"]["width_mm"] == 7.0
    slimmer = next(one for one in after["plan"]["vertebrae"][0]["channels"] if one["side"] == "left")
    assert slimmer["channel"]["radius_mm"] == 3.5
    assert slimmer["screws"][0]["tolerance"] != screw["tolerance"]
    assert after["active_channel"] is None
    assert server.adopted[-1].channel is None

    # Navigation compares with the corrected pedicle.
    server.ask("POST", "/api/plan/active-channel", 200, json=now)
    navigated = server.adopted[-1]
    assert navigated.channel is not None
    assert navigated.drill_reference is not None
    wall = navigated.drill_reference.wall
    assert wall.against is WallSource.PEDICLE
    isthmus = record["measured"]["isthmus_lps_mm"]
    assert wall.distances_mm(isthmus)[0][0] == pytest.approx(-7.0 / 2, abs=0.3)


def test_a_plan_on_nifti_in_another_order_is_the_same(server: Server) -> None:
    planned(server, nifti(scanned()))
    proposal = server.ask("GET", "/api/plan/proposals/slice?vertebra=L3", 200)
    isthmus = scanned().index_from_lps(phantom().truth("left").isthmus_lps_mm)
    assert proposal["slice_index"] == pytest.approx(isthmus[2], abs=1.0)
    server.ask("PUT", "/api/plan/vertebrae/L3/reference", 200, json={**BY, "apart_mm": 20})
    assert min(picture(server, "/api/plan/vertebrae/L3/reference.png").shape[:2]) >= 512


def test_a_channel_by_hand_and_what_is_rejected(server: Server) -> None:
    opened(server)
    assert server.ask("GET", "/api/plan", 409)["code"] == "PLAN_MISSING"
    assert server.ask("POST", "/api/plan/vertebrae", 409, json={**BY, "name": "L3"})["code"] == "CT_MISSING"
    sent(server, dicom_zip())
    first = server.ask("POST", "/api/plan/vertebrae", 201, json={**BY, "name": "L3", "expected_version": 0})
    hand = {"entry_lps_mm": [15, 14, 2], "target_lps_mm": [8, -30, 3], "diameter_mm": 6.0}

    def rejected(method: str, path: str, status: int, code: str, **sent: Any) -> None:  # noqa: ANN401
        assert server.ask(method, f"/api/plan{path}", status, **sent)["code"] == code

    rejected("POST", "/vertebrae", 409, "PLAN_INVALID", json={**BY, "name": "L3"})
    rejected("POST", "/vertebrae", 422, "REQUEST_INVALID", json={**BY, "name": "  "})
    rejected("POST", "/vertebrae", 409, "VERSION_CONFLICT", json={**BY, "name": "L4", "expected_version": 0})
    lay = "/vertebrae/L3/channels/left"
    rejected("PUT", lay, 409, "PEDICLE_MISSING", json=BY)
    rejected("PUT", "/vertebrae/L9/channels/left", 409, "VERTEBRA_UNKNOWN", json={**BY, "by_hand": hand})
    rejected(
        "PUT", lay, 409, "CHANNEL_OUTSIDE_CT", json={**BY, "by_hand": {**hand, "target_lps_mm": [0, -500, 0]}}
    )
    rejected(
        "PUT", lay, 409, "CHANNEL_INVALID", json={**BY, "by_hand": {**hand, "target_lps_mm": [15, 14, 2]}}
    )
    rejected("PUT", "/vertebrae/L3/channels/middle", 422, "REQUEST_INVALID", json=BY)
    rejected("GET", "/proposals/slice?vertebra=L3", 409, "NO_PEDICLE_MEASURED")
    rejected("GET", "/vertebrae/L3/reference.png", 409, "REFERENCE_MISSING")
    rejected("POST", "/active-channel", 409, "CHANNEL_MISSING", json={**BY, "vertebra": "L3", "side": "left"})
    air = server.ask(
        "POST", "/api/plan/vertebrae/L3/pedicles/left", 202, json={**BY, "seed_lps_mm": [0, 500, 0]}
    )
    assert server.done(air)["problem"]["code"] == "SEED_OUTSIDE_CT"
    assert server.ask("GET", "/api/plan", 200)["heading"] == first["heading"]

    laid = server.ask("PUT", f"/api/plan{lay}", 200, json={**BY, "by_hand": hand, "expected_version": 1})
    assert laid["plan"]["vertebrae"][0]["channels"][0]["by_hand"]
    rejected("PUT", f"{lay}/screw", 422, "SCREW_INCOMPLETE", json={**BY, "diameter_mm": 6.0})
    rejected(
        "PUT", f"{lay}/screw", 409, "SCREW_NOT_IN_CATALOGUE", json={**BY, "diameter_mm": 6.1, "length_mm": 40}
    )
    rejected("PUT", f"{lay}/screw", 409, "PEDICLE_MISSING", json={**BY, "diameter_mm": 6, "length_mm": 40})
    server.ask("DELETE", f"/api/plan{lay}", 200, params=BY)
    assert server.ask("DELETE", "/api/plan/vertebrae/L3", 200, params=BY)["plan"]["vertebrae"] == []


def test_landmarks_are_set_go_out_and_come_back_and_odd_ones_are_rejected(server: Server) -> None:
    opened(server)
    sent(server, dicom_zip())
    server.ask("POST", "/api/plan/vertebrae", 201, json={**BY, "name": "L3"})
    points = {"right superior articular process": [-19.5, 12.5, 9.0], "spinous process": [0.0, 30.0, -5.0]}
    landmarks = [{"name": name, "point_lps_mm": at} for name, at in points.items()]
    where = "/api/plan/vertebrae/L3/landmarks"

    plan = server.ask("PUT", where, 200, json={**BY, "landmarks": landmarks, "expected_version": 1})
    assert plan["plan"]["vertebrae"][0]["landmarks"] == landmarks
    assert plan["heading"]["version"] == 2
    file = server.ask("GET", "/api/plan/export", 200)
    assert file["plan"]["vertebrae"][0]["landmarks"] == landmarks
    assert (
        server.ask("PUT", where, 200, json={**BY, "landmarks": []})["plan"]["vertebrae"][0]["landmarks"] == []
    )
    back = server.ask("POST", "/api/plan/import", 201, content=json.dumps(file), params=BY)
    assert back["plan"]["vertebrae"][0]["landmarks"] == landmarks

    def rejected(status: int, code: str, **requested: Any) -> None:  # noqa: ANN401
        answer = server.ask("PUT", where, status, json={**BY, "landmarks": landmarks, **requested})
        assert answer["code"] == code

    rejected(409, "VERSION_CONFLICT", expected_version=2)
    rejected(409, "LANDMARK_TWICE", landmarks=[landmarks[0], landmarks[0]])
    rejected(409, "LANDMARK_OUTSIDE_CT", landmarks=[{"name": "tip", "point_lps_mm": [0, 0, 900]}])
    rejected(409, "PLAN_INVALID", landmarks=[{"name": "tip\u202e", "point_lps_mm": [0, 0, 0]}])
    for odd in ([{"name": " ", "point_lps_mm": [0, 0, 0]}], [{"name": "tip", "point_lps_mm": [0, 0]}]):
        rejected(422, "REQUEST_INVALID", landmarks=odd)
    assert server.ask("GET", "/api/plan", 200)["heading"] == back["heading"]


def test_another_ct_makes_the_plan_out_of_date_until_it_is_sent_again(server: Server) -> None:
    opened(server)
    sent(server, dicom_zip())
    server.ask("POST", "/api/plan/vertebrae", 201, json={**BY, "name": "L3"})
    hand = {"entry_lps_mm": [15, 14, 2], "target_lps_mm": [8, -30, 3], "diameter_mm": 6.0}
    server.ask("PUT", "/api/plan/vertebrae/L3/channels/left", 200, json={**BY, "by_hand": hand})
    server.ask("POST", "/api/plan/active-channel", 200, json={**BY, "vertebra": "L3", "side": "left"})
    assert [setup.channel is not None for setup in server.adopted] == [True]
    sent(server, dicom_zip())
    assert [setup.channel is not None for setup in server.adopted] == [True, False]
    old = server.ask("GET", "/api/plan", 200)
    assert "ct 'main'" in old["heading"]["out_of_date"]
    assert (
        server.ask("POST", "/api/plan/vertebrae", 409, json={**BY, "name": "L4"})["code"]
        == "PLAN_OUT_OF_DATE"
    )
    again = {**BY, "plan": old["plan"], "expected_version": old["heading"]["version"]}
    assert server.ask("PUT", "/api/plan", 200, json=again)["heading"]["current"]
    assert server.ask("PUT", "/api/plan", 409, json=again)["code"] == "VERSION_CONFLICT"


def test_a_plan_is_exported_and_imported_with_its_author(
    server: Server, monkeypatch: pytest.MonkeyPatch
) -> None:
    def none_fits(*_: object, **__: object) -> tuple[float, float]:
        raise PlanError("NO_SCREW_FITS", "", "")

    with monkeypatch.context() as patch:
        patch.setattr("server.procedure.plan.step.propose_screw", none_fits)
        plan = planned(server, dicom_zip())
    assert [one["screws"] for one in plan["plan"]["vertebrae"][0]["channels"]] == [[], []]
    server.ask("PUT", "/api/plan/vertebrae/L3/channels/left/screw", 200, json=BY)
    file = server.ask("GET", "/api/plan/export", 200)
    assert (file["made_by"], file["version"]) == ("M. Ito", plan["heading"]["version"] + 1)
    # Values in a file that follow from others are recomputed, not trusted.
    file["plan"]["vertebrae"][0]["channels"][1]["screws"][0:0] = []
    lied = json.loads(json.dumps(file))
    for planned_channel in lied["plan"]["vertebrae"][0]["channels"]:
        for screw in planned_channel["screws"]:
            screw["clearance"]["medial_mm"] = 99.0
            screw["bone"]["hu"] = [9000.0]
    back = server.ask(
        "POST", "/api/plan/import", 201, content=json.dumps(lied), params={"made_by": "R. Sato"}
    )
    assert back["heading"]["made_by"] == "R. Sato"
    assert back["plan"] == file["plan"]

    other = json.loads(json.dumps(file))
    other["ct"]["voxels_sha256"] = "0" * 64
    sent_other = {"content": json.dumps(other), "params": BY}
    assert server.ask("POST", "/api/plan/import", 422, **sent_other)["code"] == "PLAN_OF_ANOTHER_CT"
    sent_other["params"] = {**BY, "for_other_ct": "true"}
    server.ask("POST", "/api/plan/import", 201, **sent_other)


def test_hostile_plan_files_are_rejected_and_nothing_is_stored(server: Server) -> None:
    planned(server, dicom_zip())
    file = server.ask("GET", "/api/plan/export", 200)
    before = server.ask("GET", "/api/plan", 200)

    def spoilt(change: Any) -> bytes:  # noqa: ANN401
        changed = json.loads(json.dumps(file))
        change(changed)
        return json.dumps(changed).encode()

    def pedicle(changed: Any) -> Any:  # noqa: ANN401
        return changed["plan"]["vertebrae"][0]["pedicles"][0]["measured"]

    bad: dict[str, bytes] = {
        "no JSON": b"plan",
        "no text": b"\xff\xfe\x00",
        "a list": b"[]",
        "too deep": b"[" * 100_000,
        "deep inside": spoilt(lambda one: one).replace(
            b'"vertebrae": [', b'"vertebrae": [' + b"[" * 500 + b"]" * 500 + b",", 1
        ),
        "NaN": spoilt(lambda one: one).replace(b'"width_mm": ', b'"width_mm": NaN, "x": ', 1),
        "other format": spoilt(lambda one: one.update(format="x")),
        "other version": spoilt(lambda one: one.update(format_version=[7] * 1000)),
        "no plan": spoilt(lambda one: one.pop("plan")),
        "version of the plan": spoilt(lambda one: one["plan"].update(format_version=99)),
        "unknown key": spoilt(lambda one: one["plan"].update(x=1)),
        "huge number": spoilt(lambda one: pedicle(one).update(width_mm=10**400)),
        "huge numbers": spoilt(lambda one: pedicle(one).update(isthmus_lps_mm=[10**400, 0, 0])),
        "far away": spoilt(lambda one: pedicle(one).update(isthmus_lps_mm=[1e6, 0, 0])),
        "two numbers": spoilt(lambda one: pedicle(one).update(isthmus_lps_mm=[1, 2])),
        "no outline": spoilt(lambda one: pedicle(one).update(outline_lps_mm=[])),
        "flat outline": spoilt(lambda one: pedicle(one).update(outline_lps_mm=[1.0] * 30)),
        "long axis": spoilt(lambda one: pedicle(one).update(axis_lps=[0, -3, 0])),
        "no width": spoilt(lambda one: pedicle(one).update(width_mm=-1)),
        "side": spoilt(lambda one: pedicle(one).update(side="top")),
        "many": spoilt(lambda one: one["plan"].update(vertebrae=[{"name": str(n)} for n in range(100)])),
        "name": spoilt(lambda one: one["plan"]["vertebrae"][0].update(name="L3\n\x00" * 40)),
        "true": spoilt(lambda one: pedicle(one).update(width_mm=True)),
        "channel of the moon": spoilt(
            lambda one: one["plan"]["vertebrae"][0]["channels"][0]["channel"].update(
                entry_in_vertebra_mm=[0, 400, 0], target_in_vertebra_mm=[0, 380, 0]
            )
        ),
    }
    for name, content in bad.items():
        answer = server.door.post("/api/plan/import", content=content, params=BY)
        assert answer.status_code in (409, 422), (name, answer.text)
        reported = answer.json()
        assert reported["remedy"], name
        assert len(reported["message"]) < 500, name
    assert server.ask("GET", "/api/plan", 200) == before
    too_long = server.door.post("/api/plan/import", content=b" " * (9 * 2**20), params=BY)
    assert too_long.status_code == 413
