"""Warnings are stored with their values, and worded in a language when they are read."""

import json
from collections.abc import Collection, Mapping

import numpy as np
import pytest

from server.imaging.plausibility import clipped_warning, value_warnings
from server.texts import worded
from server.texts.errors import phrase_text
from tests.tracker.camera.rendered import POSES, picture
from tests.tracker.camera.test_board_size import SHOWN, SQUARES
from tracker.camera.calibration import calibrate
from tracker.camera.calibration.board_size import with_board_size_warning
from tracker.camera.detection import BoardView, find_board
from tracker.errors import Remark
from tracker.plan.bone.remarks import ENDS, remarks_of
from tracker.plan.bone.threshold import ThresholdProposal
from tracker.plan.document import plain
from tracker.plan.mesh.remarks import Findings
from tracker.plan.mesh.remarks import remarks_of as mesh_remarks_of
from tracker.plan.mesh.units import Kind
from tracker.plan.pedicle.remarks import canal_remarks
from tracker.plan.triangles import Connectivity
from tracker.registration.points.outliers import outlier_remarks


def stored(remark: Remark) -> object:
    """Return a remark as it comes back from a document."""
    return json.loads(json.dumps(plain(remark), allow_nan=False))


def german(remark: Remark) -> tuple[str, str]:
    """Return message and remedy of a stored remark in German."""
    localized = worded(stored(remark), "de")
    assert isinstance(localized, dict)
    return localized["message"], localized["remedy"]


def bone_cut(*ends: str) -> Remark:
    at_end = np.array([[name in ends for name in ENDS]])
    threshold = ThresholdProposal(threshold_hu=200.0, surroundings_hu=40.0, bone_ratio=0.2)
    return remarks_of(at_end, (1, 1, 1), np.ones(3), 200.0, threshold, given=None)[1][0]


@pytest.mark.parametrize(
    ("remark", "message", "remedy"),
    [
        pytest.param(
            canal_remarks(8.0, 7.0)[0],
            "der Knochen reicht offenbar 8 mm über die mediale Wand hinaus (7 mm sind bei solchen Voxeln "
            "üblich); der Isthmus liegt vielleicht zu weit vorn",
            "Den Isthmus auf den Schichten prüfen.",
            id="pedicle",
        ),
        pytest.param(
            value_warnings(np.full((8, 8, 8), 7, np.int16))[0],
            "alle Voxel haben 7 HU: dieses CT ist leer",
            "",
            id="empty CT",
        ),
        pytest.param(
            clipped_warning(12),
            "12 Voxel lagen außerhalb von -32768 bis 32767 HU und wurden auf diesen Bereich begrenzt",
            "",
            id="clipped CT",
        ),
        pytest.param(
            bone_cut("first slice", "last row"),
            "der Knochen reicht über das CT hinaus: er ist abgeschnitten an: erste Schicht, letzte Zeile",
            "Nur auf vollständigem Knochen planen, oder einen größeren Teil des Patienten aufnehmen.",
            id="bone",
        ),
    ],
)
def test_a_stored_warning_is_worded_in_german(remark: Remark, message: str, remedy: str) -> None:
    assert german(remark) == (message, remedy)
    assert worded(stored(remark), "en") == stored(remark)


def test_the_warnings_of_a_mesh_are_worded_in_german() -> None:
    found = Findings(
        kind=Kind.SPINE,
        size_mm=np.array([90.0, 80.0, 300.0]),
        parts=3,
        connectivity=Connectivity(
            edges=np.zeros((0, 2), np.int64),
            border_edges=4,
            non_manifold_edges=2,
            misoriented_edges=0,
            border_vertices=np.zeros(0, np.int64),
        ),
        flipped=5,
        faces=900,
        dropped=1,
        mirrored=True,
    )
    remarks = mesh_remarks_of(found)
    assert len(remarks) == 7
    for remark in remarks:
        message, remedy = german(remark)
        assert message != remark.message
        assert remedy != remark.remedy or not remedy


@pytest.mark.parametrize(
    ("suspects", "undetected_mm", "german_message"),
    [
        pytest.param(
            [1],
            {0: 1.2, 1: 3.21, 2: 1.0, 3: 0.9},
            "4 Landmarken schließen einen Fehler von bis zu 3,2 mm nicht aus in: spinous process; der "
            "angegebene Fehler enthält eine Landmarke mit einem Fehler von 2,5 mm (3-D-RMS)",
            id="in one landmark",
        ),
        pytest.param(
            range(4),
            {0: 1.2, 1: np.inf, 2: 1.0, 3: 0.9},
            "4 Landmarken schließen einen Fehler beliebiger Größe nicht aus in: jeder davon; der "
            "angegebene Fehler enthält eine Landmarke mit einem Fehler von 2,5 mm (3-D-RMS)",
            id="in any",
        ),
    ],
)
def test_the_remark_of_a_registration_is_worded_in_german(
    suspects: Collection[int], undetected_mm: Mapping[int, float], german_message: str
) -> None:
    labels = ("left", "spinous process", "right", "lamina")
    (remark,) = outlier_remarks(labels, undetected_mm, suspects, 2.5)
    assert german(remark)[0] == german_message


def test_the_warnings_of_a_calibration_are_worded_in_german() -> None:
    found = [find_board(picture(SHOWN, pose), SQUARES) for pose in POSES[:3]]
    views = [one for one in found if isinstance(one, BoardView)]
    report = with_board_size_warning(calibrate(views, size_wh_px=(640, 480)), views, SQUARES)
    worded_in_german = {one.code: german(one) for one in report.warnings}
    assert {
        "BOARD_SIZE_UNLIKELY",
        "CORNERS_UNCOVERED",
        "FEW_VIEWS",
        "MODEL_NOT_TRIED",
    } <= worded_in_german.keys()
    for one in report.warnings:
        assert worded_in_german[one.code][0] != one.message
        assert worded_in_german[one.code][1] != one.remedy
    assert worded_in_german["BOARD_SIZE_UNLIKELY"] == (
        "keine Ansicht zeigt mehr als 9 x 6 von 10 x 7 (innere Ecken), und die meisten zeigen genau diese",
        "Noch einmal zählen (innere Ecken, je Richtung eine weniger als Felder): die Tafel hat offenbar "
        "9 x 6.",
    )


def test_all_warnings_of_a_document_are_worded_and_all_else_is_left_alone() -> None:
    remark = stored(canal_remarks(8.0, 7.0)[0])
    document = {
        "vertebrae": [{"name": "L3", "pedicles": [{"warnings": [remark], "width_mm": 7.5}]}],
        "n": [1.5],
    }
    localized = worded(document, "de")
    assert isinstance(localized, dict)
    (pedicle,) = localized["vertebrae"][0]["pedicles"]
    assert pedicle["warnings"][0]["message"].startswith("der Knochen reicht")
    assert pedicle["width_mm"] == 7.5
    assert localized["n"] == [1.5]
    assert document["vertebrae"][0]["pedicles"][0]["warnings"] == [remark]  # type: ignore[index]


def test_a_sentence_of_an_older_document_stays_as_it_is() -> None:
    assert worded({"warnings": ["its section is oblique"]}, "de") == {"warnings": ["its section is oblique"]}


def test_the_reason_of_a_lens_model_is_german_with_commas() -> None:
    text = phrase_text("model_reason", "5 describe views held out to 0.312 px, 4 to 0.340 px, 8 to 0.311 px")
    assert text["de"].endswith("auf 0,312 px, 4 auf 0,340 px, 8 auf 0,311 px")
