"""`coaxial plan measure`: from a file and a point to the numbers."""

import json
from pathlib import Path

import nibabel as nib
import numpy as np
import pytest
from typer.testing import CliRunner

from server.cli.commands import app
from server.cli.plan import seed_from_text
from tests.real_data import real_data_file
from tests.tracker.plan.pedicles import rod_between_blocks, scanned
from tracker.errors import InvalidInput, NavigationError
from tracker.plan.pedicle import axis_from_angles

KEYS = {"width_mm", "height_mm", "transverse_deg", "sagittal_deg", "length_mm", "isthmus_lps_mm", "axis_lps"}


@pytest.fixture(scope="module")
def ct(tmp_path_factory: pytest.TempPathFactory) -> Path:
    axis = axis_from_angles("left", transverse_deg=10.0, sagittal_deg=0.0)
    field = rod_between_blocks(width_mm=8, height_mm=12, axis=axis, rod_hu=800, block_hu=800, around_hu=0)
    volume = scanned(field, spacing_mm=(0.8, 0.8, 1.0), noise_hu=10.0)
    path = tmp_path_factory.mktemp("ct") / "rod.nii.gz"
    # NIfTI axes point right and forward where LPS points left and back.
    image = nib.Nifti1Image(
        volume.hu.transpose(2, 1, 0), np.diag([-1.0, -1.0, 1.0, 1.0]) @ volume.lps_from_ijk
    )
    image.header.set_xyzt_units("mm")
    nib.save(image, path)
    return path


def typed(*words: object) -> tuple[int, str]:
    result = CliRunner().invoke(app, ["plan", "measure", *map(str, words)])
    if isinstance(result.exception, NavigationError):
        return 2, result.exception.code
    return result.exit_code, result.output


def test_a_pedicle_is_measured_as_json(ct: Path) -> None:
    status, text = typed(ct, "--side", "left", "--seed-lps-mm", "-0.5,1,-1", "--json")
    assert status == 0, text
    reported = json.loads(text)
    assert set(reported) >= KEYS
    assert reported["width_mm"] == pytest.approx(8.0, abs=0.4)
    assert reported["height_mm"] == pytest.approx(12.0, abs=0.4)
    assert reported["transverse_deg"] == pytest.approx(10.0, abs=1.0)
    assert reported["length_mm"] == pytest.approx(68.0 / np.cos(np.radians(10.0)), abs=2.0)
    assert reported["screw"]["diameter_mm"] in {6.5, 7.0}


def test_the_series_of_a_ct_are_listed(ct: Path) -> None:
    said = CliRunner().invoke(app, ["plan", "series", str(ct), "--json"])
    assert said.exit_code == 0, said.output
    (one,) = json.loads(said.output)["series"]
    assert (one["series"], one["images"]) == ("nifti", 40)
    assert one["pixel_mm"] == pytest.approx([0.8, 0.8])
    words = CliRunner().invoke(app, ["plan", "series", str(ct)]).output
    assert words.startswith("nifti, ")
    assert "40 slices" in words


def test_and_in_words(ct: Path) -> None:
    status, text = typed(ct, "--side", "left", "--seed-lps-mm", "0,0,0")
    assert status == 0, text
    assert "width" in text
    assert "mm LPS)" in text
    notes = [line for line in text.splitlines() if line.startswith("Note: ")]
    assert notes
    assert not [note for note in notes if note.endswith("..")]


@pytest.mark.parametrize(
    ("seed", "side", "code"),
    [
        pytest.param("1,2", "left", "SEED_INVALID", id="two-numbers"),
        pytest.param("a,b,c", "left", "SEED_INVALID", id="words"),
        pytest.param("0,0,900", "left", "SEED_OUTSIDE_CT", id="elsewhere"),
        pytest.param("0,0,0", "starboard", "SIDE_INVALID", id="no-side"),
    ],
)
def test_bad_input_is_reported(ct: Path, seed: str, side: str, code: str) -> None:
    assert typed(ct, "--side", side, "--seed-lps-mm", seed) == (2, code)


def test_numbers_below_zero_are_numbers() -> None:
    assert seed_from_text("-12.5, 40,-803") == (-12.5, 40.0, -803.0)
    with pytest.raises(InvalidInput):
        seed_from_text("1;2;3")


def test_a_pedicle_of_a_real_thoracic_vertebra() -> None:
    folder = real_data_file("ct", "thoracic-dicom")
    status, text = typed(folder, "--side", "right", "--seed-lps-mm", "-23.9,-92.8,-788.5", "--json")
    assert status == 0, text
    reported = json.loads(text)
    # Estimated from the slices: 7 to 10 mm wide, 16 to 22 mm high.
    assert 7.0 < reported["width_mm"] < 10.0
    assert 15.5 < reported["height_mm"] < 23.0
    assert reported["isthmus_lps_mm"][2] == pytest.approx(-788.0, abs=4.0)
