"""`coaxial marker` as a person types it."""

import json
from pathlib import Path

import cv2
import numpy as np
import pytest
from typer.testing import CliRunner

from server.cli import app
from server.cli.background import evenly_spaced
from server.marker_file import load_marker_image
from tracker.errors import NavigationError
from tracker.marker import MarkerModel


def typed(*words: str | Path) -> tuple[int, str]:
    result = CliRunner().invoke(app, ["marker", *map(str, words)])
    if isinstance(result.exception, NavigationError):
        # `server.cli.main` tells it, with status 2.
        return 2, result.exception.code
    assert result.exception is None or isinstance(result.exception, SystemExit), result.exception
    return result.exit_code, result.stdout


FEW = ("design", "--proposals", "4")
ORDER = ("design", "--seed", "1", "--proposals", "5", "--side-mm", "25.4", "--output")


@pytest.fixture(scope="module")
def design(tmp_path_factory: pytest.TempPathFactory) -> Path:
    tmp_path = tmp_path_factory.mktemp("design")
    status, text = typed(*ORDER, tmp_path / "new" / "folder")
    assert status == 0, text
    assert "print the pdf at 100 %" in text.lower()
    assert "No background was given" in text
    return tmp_path / "new" / "folder"


def folder_with(picture: Path | None, folder: Path) -> Path:
    """Two images of a desk; the second one contains a print of the picture, if given."""
    folder.mkdir()
    service = np.full((240, 320), 200, np.uint8)
    cv2.circle(service, (60, 60), 25, 40, -1)
    cv2.imwrite(str(folder / "1.png"), service)
    if picture is not None:
        small = cv2.resize(load_marker_image(picture), (60, 60), interpolation=cv2.INTER_AREA)
        service[100:160, 150:210] = np.clip(small, 20, 200)
    cv2.imwrite(str(folder / "2.png"), cv2.GaussianBlur(service, (0, 0), 0.7))
    return folder


def test_a_design_is_written_as_svg_pdf_and_the_picture_that_is_tracked(design: Path) -> None:
    assert sorted(file.name for file in design.iterdir()) == ["marker.pdf", "marker.png", "marker.svg"]
    assert (design / "marker.pdf").read_bytes().startswith(b"%PDF-1.4")
    assert "25.4 mm" in (design / "marker.svg").read_text(encoding="utf-8")
    model = MarkerModel.from_image(load_marker_image(design / "marker.png"), side_mm=25.4, name="m")
    # The same shape in both: the white area of the picture is that of the polygon on the page.
    corners = (design / "marker.svg").read_text(encoding="utf-8").split('<polygon points="')[3].split('"')[0]
    polygon = np.array([point.split(",") for point in corners.split()], np.float32)
    area = cv2.contourArea(polygon) / 25.4**2
    assert (model.image > 127).mean() == pytest.approx(area, abs=0.01)


def test_the_same_seed_gives_the_same_files(design: Path, tmp_path: Path) -> None:
    typed(*ORDER, tmp_path / "again")
    for file in design.iterdir():
        assert (tmp_path / "again" / file.name).read_bytes() == file.read_bytes()


def test_a_name_has_a_shape_of_its_own_on_every_machine_unless_a_seed_is_typed(tmp_path: Path) -> None:
    def picture(name: str, folder: str, *seed: str) -> tuple[np.ndarray, int]:
        output = tmp_path / folder
        status, text = typed(*FEW, "--output", output, "--name", name, "--json", *seed)
        assert status in (0, 1)
        return load_marker_image(output / f"{name}.png"), json.loads(text)["seed"]

    drill, seed = picture("drill", "named")
    assert seed == 2716645360
    awl, _ = picture("awl", "named")
    assert not np.array_equal(awl, drill)
    typed_awl, _ = picture("awl", "typed", "--seed", str(seed))
    assert np.array_equal(typed_awl, drill)


def test_a_marker_that_is_there_is_replaced_only_where_that_is_said(tmp_path: Path) -> None:
    (tmp_path / "marker.png").write_bytes(b"printed")
    few = (*FEW, "--output", tmp_path)
    assert typed(*few) == (2, "MARKER_FILES_EXIST")
    assert (tmp_path / "marker.png").read_bytes() == b"printed"
    typed(*few, "--replace")
    assert load_marker_image(tmp_path / "marker.png").ndim == 2


def test_a_folder_that_cannot_be_written_is_reported_before_the_work(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "file").write_text("", encoding="utf-8")
    monkeypatch.setattr("server.cli.marker.best_design", None)
    assert typed("design", "--output", tmp_path / "file" / "folder") == (2, "OUTPUT_NOT_WRITABLE")


def test_a_background_that_shows_the_marker_fails_the_check(design: Path, tmp_path: Path) -> None:
    marker = design / "marker.png"
    background = folder_with(marker, tmp_path / "images")
    status, text = typed("check", marker, "--background", background, "--output", tmp_path, "--json")
    assert status == 1
    figures = json.loads(text)
    assert figures["unique"] is False
    assert [claim["image_number"] for claim in figures["background"]["claims"]] == [1]
    assert np.mean(figures["background"]["claims"][0]["corners_px"], axis=0) == pytest.approx(
        [179.5, 129.5], abs=2
    )
    picture = cv2.imread(str(tmp_path / "marker-closest.png"))
    assert picture is not None
    # Orange, around the print.
    orange = np.argwhere((picture[..., 2] > 200) & (picture[..., 0] < 90))
    assert orange.mean(axis=0) == pytest.approx([125, 179], abs=15)


def test_a_background_without_it_passes_the_check(design: Path, tmp_path: Path) -> None:
    background = folder_with(None, tmp_path / "images")
    status, text = typed("check", design / "marker.png", "--background", background, "--output", tmp_path)
    assert status == 0, text
    assert "no place reaches all thresholds" in text
    assert "detected in none" in text


@pytest.mark.parametrize(
    ("words", "code"),
    [
        pytest.param(["design", "--background", "0"], "BACKGROUND_WITHOUT_END", id="a-camera"),
        pytest.param(["design", "--background", "nowhere.mp4"], "SOURCE_NOT_FOUND", id="no-such-video"),
        pytest.param(["design", "--name", "a/b"], "MARKER_NAME_INVALID", id="a-name-that-is-a-path"),
        pytest.param(["design", "--side-mm", "500"], "MARKER_SIDE_UNPRINTABLE", id="larger-than-the-page"),
        pytest.param(["check", "nowhere.png"], "MARKER_IMAGE_UNREADABLE", id="no-such-picture"),
    ],
)
def test_bad_input_is_reported(
    words: list[str], code: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    assert typed(*words) == (2, code)
    assert list(tmp_path.iterdir()) == []


def test_a_background_that_cannot_be_read_is_reported_with_the_option_that_names_it(tmp_path: Path) -> None:
    result = CliRunner().invoke(app, ["marker", "design", "--background", str(tmp_path)])
    assert isinstance(result.exception, NavigationError)
    assert result.exception.code == "FOLDER_WITHOUT_IMAGES"
    assert "--background" in result.exception.remedy
    assert "--source" not in result.exception.remedy


@pytest.mark.parametrize("words", [["--help"], ["design", "--help"], ["check", "--help"]])
def test_help_answers(words: list[str]) -> None:
    status, text = typed(*words)
    assert (status, "Usage" in text) == (0, True)


@pytest.mark.parametrize(
    ("length", "count"), [(0, 4), (1, 4), (4, 4), (7, 4), (8, 4), (100, 4), (184, 60), (5, 1)]
)
def test_images_are_evenly_spread_over_a_film_of_any_length(length: int, count: int) -> None:
    grey = np.zeros((1, 1), np.uint8)
    numbers = [number for number, _ in evenly_spaced(((k, grey) for k in range(length)), count=count)]
    assert len(numbers) == min(length, count)
    if len(numbers) > 1:
        gaps = np.diff(numbers)
        assert gaps.max() <= 2 * gaps.min()
        assert numbers[0] == 0
        assert numbers[-1] >= length - 1 - 2 * length / count
