"""`coaxial plan labels`: a segmentation checked against its CT."""

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

from server.cli.commands import app
from server.imaging.labels.label_file import load_label_file
from server.imaging.nifti import nifti_bytes
from tests.server.imaging.made_labels import label_nifti
from tests.tracker.plan.label_phantoms import labelled_spine
from tracker.errors import PlanError


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    volume, labels = labelled_spine(("L3", "L4"), spacing_mm=(1.5, 1.5, 1.5))
    path = tmp_path_factory.mktemp("labels")
    (path / "ct.nii.gz").write_bytes(nifti_bytes(volume))
    (path / "seg.nii.gz").write_bytes(label_nifti(labels))
    return path


def test_labels_are_listed_and_written_in_the_voxels_of_the_ct(folder: Path) -> None:
    words = ["plan", "labels", str(folder / "ct.nii.gz"), str(folder / "seg.nii.gz")]
    output = folder / "out.nii.gz"
    said = CliRunner().invoke(app, [*words, "--json", "--output", str(output)])
    assert said.exit_code == 0, said.output
    assert [one["level"] for one in json.loads(said.output)["vertebrae"]] == ["L3", "L4"]
    assert load_label_file(output, voxel_mm=1.5).levels == ("L3", "L4")
    text = CliRunner().invoke(app, words).output
    assert text.startswith("L3    62.")
    assert "Note: the file does not name its labels" in text


def test_names_that_contradict_positions_are_rejected(folder: Path) -> None:
    files = [str(folder / "ct.nii.gz"), str(folder / "seg.nii.gz")]
    error = CliRunner().invoke(app, ["plan", "labels", *files, "--names", "29:L4,28:L3"]).exception
    assert isinstance(error, PlanError)
    assert error.code == "LEVEL_DOUBTFUL"
    assert "L3, L4 by name, but L4, L3 by position" in error.message
