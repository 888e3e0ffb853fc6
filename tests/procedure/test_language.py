"""A page that asks for German gets the server's sentences in German, with the digits of the English ones."""

import re
from functools import partial
from typing import Any

import numpy as np

from tests.procedure.conftest import Server
from tests.procedure.patient import DRILL, USED, Patient, ready
from tests.procedure.test_camera_step import DOTS, open_a_case, png
from tests.procedure.uploads import nifti, scanned

POINTS = "/api/registration/points"
GERMAN = {"Accept-Language": "de-DE,de;q=0.9,en;q=0.8"}


def in_both(server: Server, method: str, path: str, status: int, **sent: Any) -> tuple[Any, Any]:  # noqa: ANN401  JSON
    return (
        server.ask(method, path, status, **sent),
        server.ask(method, path, status, headers=GERMAN, **sent),
    )


def digits(text: str) -> list[str]:
    """Numbers of a sentence; German has decimal commas."""
    return re.findall(r"\d+(?:\.\d+)?", re.sub(r"(?<=\d),(?=\d)", ".", text))


def test_the_reasons_of_the_steps_are_in_the_requested_language(server: Server) -> None:
    english, german = in_both(server, "GET", "/api/procedure", 200)
    assert {step["message"] for step in english["steps"]} == {"no case is open"}
    assert {step["message"] for step in german["steps"]} == {"es ist kein Fall geöffnet"}
    open_a_case(server)
    _, german = in_both(server, "GET", "/api/procedure", 200)
    camera = german["steps"][0]
    assert (camera["code"], camera["language"]) == ("CAMERA_NOT_CALIBRATED", "de")
    assert camera["message"] == "die Kamera ist nicht kalibriert"
    assert camera["remedy"] == "Die Kamera mit Ansichten der Tafel kalibrieren."
    navigation = german["steps"][-1]
    assert navigation["message"] == "Navigation wartet auf Kamera: die Kamera ist nicht kalibriert"


def test_a_step_that_waits_is_rejected_in_the_requested_language(server: Server) -> None:
    open_a_case(server)
    english, german = in_both(server, "POST", POINTS, 409, json=DRILL)
    assert (english["code"], english["language"]) == (german["code"], "en") == ("CAMERA_MISSING", "en")
    assert english["message"] == "the registration waits for the camera: the camera is not calibrated"
    assert german["message"] == "Registrierung wartet auf Kamera: die Kamera ist nicht kalibriert"
    assert german["remedy"] == "Die Kamera mit Ansichten der Tafel kalibrieren."
    assert german["language"] == "de"


def test_a_rejected_capture_has_the_same_digits_in_both_languages(server: Server) -> None:
    ready(server)
    patient = Patient(server=server)
    patient.show(None)
    server.ask("POST", POINTS, 201, json=DRILL)
    server.ask("POST", f"{POINTS}/captures", 202, json={"landmark": USED[0]})

    def is_captured(index: int) -> bool:
        capture = server.ask("GET", POINTS, 200)["capture"]
        return bool(capture["images"] > index or capture["state"] == "rejected")

    for index in range(4):
        patient.show(patient.tip_on(USED[0], off_mm=(0.0, 1.2 * index, 0.0)))
        server.until(partial(is_captured, index))
    english, german = (answer["capture"]["problem"] for answer in in_both(server, "GET", POINTS, 200))
    assert english["code"] == german["code"] == "CAPTURE_MOVED"
    assert german["message"].startswith("die Spitze bewegte sich: sie streut um")
    assert (
        german["remedy"] == "Die Hand auflegen, die Spitze ruhig auf die Landmarke halten und neu antasten."
    )
    assert len(digits(english["message"])) == 4
    assert digits(english["message"]) == digits(german["message"])


def test_a_document_out_of_date_states_its_reason_in_the_requested_language(server: Server) -> None:
    documents = f"/api/cases/{ready(server)}/documents"
    ct = next(one for one in server.ask("GET", documents, 200)["documents"] if one["kind"] == "ct")
    reason = {"by": "ito", "reason": "another patient"}
    server.ask("POST", f"{documents}/{ct['id']}/withdrawal", 200, json=reason)
    english, german = in_both(server, "GET", "/api/procedure", 200)
    because = "ct 'main' version 1, which was withdrawn by ito: another patient"
    assert english["steps"][2]["message"] == f"it depends on {because}"
    because = "beruht auf CT „main“ Version 1, zurückgezogen von ito: another patient"
    assert (german["steps"][2]["state"], german["steps"][2]["message"]) == ("out_of_date", because)
    _, german = in_both(server, "GET", documents, 200)
    assert because in [one["out_of_date"] for one in german["documents"]]


def test_a_collection_of_board_views_advises_and_rejects_in_the_requested_language(server: Server) -> None:
    open_a_case(server)
    server.ask("POST", "/api/camera/collection", 201, json={"board": DOTS})
    english, german = in_both(server, "GET", "/api/camera/collection", 200)
    assert english["missing"] == ["Show the board to the camera."]
    assert german["missing"] == ["Die Tafel der Kamera zeigen."]
    empty = png(np.full((200, 300), 128, np.uint8))
    english, german = in_both(server, "POST", "/api/camera/collection/images", 422, content=empty)
    assert english["message"] == "the board was not found in sent: no dots that stand in a grid"
    assert german["message"] == "die Tafel wurde in sent nicht gefunden: keine Punkte, die ein Raster bilden"
    assert german["language"] == "de"


def test_the_stored_warnings_of_a_ct_are_worded_in_the_language_of_each_request(server: Server) -> None:
    open_a_case(server)
    server.done(server.ask("POST", "/api/ct", 202, content=nifti(scanned()), params={"made_by": "M. Ito"}))
    english, german = in_both(server, "GET", "/api/ct", 200)
    assert [one["code"] for one in english["warnings"]] == [one["code"] for one in german["warnings"]]
    unnamed = german["warnings"][-1]
    assert english["warnings"][-1]["message"] == "a NIfTI file does not identify the patient"
    assert unnamed["message"] == "eine NIfTI-Datei nennt den Patienten nicht"
    assert unnamed["remedy"] == "Sicherstellen, dass dies das CT des Patienten ist."
    # So is the document itself.
    case, document = server.ask("GET", "/api/procedure", 200)["case_id"], english["heading"]["id"]
    _, stored = in_both(server, "GET", f"/api/cases/{case}/documents/{document}", 200)
    assert stored["content"]["warnings"][-1]["message"] == unnamed["message"]
