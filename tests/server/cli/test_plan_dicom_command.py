"""`coaxial plan dicom`: an exported plan as DICOM files, for the CT on which it was made alone."""

import hashlib
import json
from pathlib import Path
from typing import Any

import pydicom
import pytest
import trimesh
from pynetdicom import AE, AllStoragePresentationContexts, evt
from typer.testing import CliRunner

from server.cli import app
from server.imaging.ct_reader import read_ct
from tests.server.imaging.made_labels import label_nifti
from tests.server.imaging.made_study import PATIENT, labelled_study
from tests.tracker.plan.test_plan_document import document
from tracker.errors import NavigationError
from tracker.plan import plan_to_mapping


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A CT as DICOM, its labels, a surface, and a plan as the page exports it."""
    path = tmp_path_factory.mktemp("plan")
    made, labels = labelled_study()
    ct = read_ct(made.write(path / "ct"), into=path / "voxels.npy")
    (path / "labels.nii.gz").write_bytes(label_nifti(labels))
    middle = ct.volume.lps_from_index([size / 2 for size in ct.volume.shape_ijk])
    trimesh.creation.icosphere(radius=20.0).apply_translation(middle).export(path / "bone.stl")
    plan = {
        "format": "coaxial plan",
        "ct": {
            "voxels_sha256": hashlib.sha256((path / "voxels.npy").read_bytes()).hexdigest(),
            "lps_from_ijk": ct.volume.lps_from_ijk.tolist(),
        },
        "plan": plan_to_mapping(document()),
    }
    (path / "plan.json").write_text(json.dumps(plan))
    return path


def typed(folder: Path, output: Path, *words: object) -> tuple[int, str]:
    given = ["plan", "dicom", folder / "plan.json", folder / "ct", "--output", output, *words]
    result = CliRunner().invoke(app, [str(word) for word in given])
    if isinstance(result.exception, NavigationError):
        return 2, result.exception.code
    return result.exit_code, result.output


def test_a_plan_becomes_files_of_the_study(folder: Path, tmp_path: Path) -> None:
    status, text = typed(
        folder, tmp_path, "--labels", folder / "labels.nii.gz", "--surface", f"L3={folder / 'bone.stl'}"
    )
    assert status == 0, text
    assert "L3 left screw" in text
    assert PATIENT.partition("^")[0] not in text
    found = {path.name: pydicom.dcmread(path) for path in tmp_path.iterdir()}
    assert set(found) == {
        "bone.dcm",
        "l3-bone.dcm",
        "l3-left-channel.dcm",
        "l3-left-screw.dcm",
        "report.dcm",
    }
    assert [one.SegmentLabel for one in found["bone.dcm"].SegmentSequence] == ["L3"]
    assert {str(one.PatientName) for one in found.values()} == {PATIENT}


def test_a_plan_of_another_ct_is_refused(folder: Path, tmp_path: Path) -> None:
    plan: dict[str, Any] = json.loads((folder / "plan.json").read_text())
    for change in ({"voxels_sha256": "0" * 64}, {"lps_from_ijk": [[1.0]]}, None):
        marks = None if change is None else {**plan["ct"], **change}
        other = tmp_path / "plan.json"
        other.write_text(json.dumps({**plan, "ct": marks}))
        result = CliRunner().invoke(
            app, ["plan", "dicom", str(other), str(folder / "ct"), "--output", str(tmp_path / "out")]
        )
        assert isinstance(result.exception, NavigationError)
        assert result.exception.code == "PLAN_OF_ANOTHER_CT"
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    ("words", "code"),
    [
        pytest.param(["--surface", "bone.stl"], "SURFACE_OPTION_INVALID", id="no-vertebra"),
        pytest.param(["--surface", "L3=missing.stl"], "MESH_UNREADABLE", id="no-file"),
        pytest.param(["--labels", "missing.nii.gz"], "CT_NOT_THERE", id="no-labels"),
        pytest.param(["--series", "1.2.3"], "CT_SERIES_UNKNOWN", id="no-such-series"),
    ],
)
def test_bad_options_are_reported(folder: Path, tmp_path: Path, words: list[str], code: str) -> None:
    assert typed(folder, tmp_path / "out", *words) == (2, code)
    assert not (tmp_path / "out").exists()


def test_a_surface_beside_the_ct_is_refused(folder: Path, tmp_path: Path) -> None:
    trimesh.creation.icosphere(radius=20.0).apply_translation([500.0, 0.0, 0.0]).export(tmp_path / "far.stl")
    assert typed(folder, tmp_path / "out", "--surface", f"L3={tmp_path / 'far.stl'}") == (
        2,
        "SURFACE_OUTSIDE_CT",
    )


@pytest.mark.parametrize(("status", "code"), [(0x0000, ""), (0xA700, "ARCHIVE_NOT_COMPLETE")])
def test_a_plan_is_sent_to_the_archive_of_the_settings(
    folder: Path, tmp_path: Path, status: int, code: str
) -> None:
    entity = AE(ae_title="ARCHIVE")
    for context in AllStoragePresentationContexts:
        entity.add_supported_context(context.abstract_syntax or "")
    stored: list[str] = []

    def store(event: evt.Event) -> int:
        stored.append(str(event.dataset.PatientName))
        return status

    server = entity.start_server(("127.0.0.1", 0), block=False, evt_handlers=[(evt.EVT_C_STORE, store)])
    assert server is not None
    archive = {"host": "127.0.0.1", "port": server.server_address[1]}
    (tmp_path / "config.yaml").write_text(json.dumps({"dicom": {"archive": archive}}))
    given = ["plan", "send", folder / "plan.json", folder / "ct", "--config", tmp_path / "config.yaml"]
    try:
        result = CliRunner().invoke(app, [str(word) for word in given])
    finally:
        server.shutdown()
    assert stored == [PATIENT] * 3
    assert getattr(result.exception, "code", "") == code
    assert ("report: stored" in result.output) is (status == 0)
