"""Exchange with 3D Slicer through the API: the plan out as markups, landmarks and a channel in."""

import json

from server.slicer_file import Markup, MarkupKind, markups_from_bytes, markups_to_bytes
from tests.procedure.conftest import Server
from tests.procedure.test_ct_step import BY, opened, sent
from tests.procedure.uploads import dicom_zip
from tracker.geometry import Array

LANDMARKS = "/api/plan/vertebrae/L3/landmarks/import"
CHANNEL = "/api/plan/vertebrae/L3/channels/left/import"


def test_landmarks_and_a_channel_go_to_slicer_and_come_back(server: Server) -> None:
    opened(server)
    sent(server, dicom_zip())
    assert server.ask("GET", "/api/plan/markups", 409)["code"] == "PLAN_MISSING"
    server.ask("POST", "/api/plan/vertebrae", 201, json={**BY, "name": "L3"})
    assert server.ask("GET", "/api/plan/markups", 409)["code"] == "PLAN_EMPTY"

    # In Slicer's frame, RAS: x and y with the opposite sign.
    points = [{"label": "facet", "position": [19.5, -12.5, 9.0]}, {"label": "tip", "position": [0, -30, -5]}]
    line = [{"position": [-15, -14, 2]}, {"position": [-8, 30, 3]}]
    content = json.dumps(
        {
            "markups": [
                {"type": kind, "coordinateSystem": "RAS", "controlPoints": placed}
                for kind, placed in (("Fiducial", points), ("Line", line))
            ]
        }
    )
    plan = server.ask("POST", LANDMARKS, 201, content=content, params={**BY, "expected_version": 1})
    assert plan["plan"]["vertebrae"][0]["landmarks"] == [
        {"name": "facet", "point_lps_mm": [-19.5, 12.5, 9.0]},
        {"name": "tip", "point_lps_mm": [0.0, 30.0, -5.0]},
    ]
    plan = server.ask("POST", CHANNEL, 201, content=content, params={**BY, "diameter_mm": 6})
    (laid,) = plan["plan"]["vertebrae"][0]["channels"]
    assert laid["by_hand"]
    assert laid["channel"]["entry_in_vertebra_mm"] == [15.0, 14.0, 2.0]
    assert laid["channel"]["target_in_vertebra_mm"] == [8.0, -30.0, 3.0]
    assert laid["channel"]["radius_mm"] == 3.0

    answer = server.door.get("/api/plan/markups")
    assert answer.headers["content-disposition"] == 'attachment; filename="plan-3.mrk.json"'
    out = markups_from_bytes(answer.content, name="it")
    assert [markup.name for markup in out] == ["L3 landmarks", "L3 left channel"]
    again = server.ask("POST", LANDMARKS, 201, content=answer.content, params=BY)
    assert again["plan"]["vertebrae"] == plan["plan"]["vertebrae"]

    def rejected(address: str, status: int, code: str, **more: object) -> None:
        params = {**BY, "diameter_mm": 6, **more}
        given = {"content": bytes(content, "utf-8"), **{"params": params}}
        assert server.ask("POST", address, status, **given)["code"] == code

    rejected(LANDMARKS, 409, "VERSION_CONFLICT", expected_version=1)
    rejected(LANDMARKS.replace("L3", "L4"), 409, "VERTEBRA_UNKNOWN")
    rejected(CHANNEL, 422, "REQUEST_INVALID", diameter_mm=0)
    for address, bad, code in (
        (CHANNEL, lines(out[1].points_lps_mm[::-1]), "CHANNEL_DIRECTION_UNKNOWN"),
        (CHANNEL, b"{}", "MARKUPS_UNREADABLE"),
        (LANDMARKS, lines(out[1].points_lps_mm), "LANDMARKS_MISSING"),
    ):
        given = {"content": bad, "params": {**BY, "diameter_mm": 6}}
        assert server.ask("POST", address, 422, **given)["code"] == code
    assert server.ask("GET", "/api/plan", 200)["heading"] == again["heading"]

    # A plan of another CT is not exported: its coordinates are not those of the case's CT.
    sent(server, dicom_zip())
    assert server.ask("GET", "/api/plan/markups", 409)["code"] == "DOCUMENT_OUT_OF_DATE"


def lines(points_mm: Array) -> bytes:
    return markups_to_bytes(
        [Markup(kind=MarkupKind.LINE, name="", points_lps_mm=points_mm, labels=("L-1", "L-2"))]
    )
