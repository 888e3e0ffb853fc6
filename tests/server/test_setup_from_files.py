"""Marker pictures, camera files, and the setup made from them."""

import json
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pytest

from server.camera_file import camera_file_text, load_camera_file, read_camera_file
from server.config import CameraConfig, Config, MarkerConfig, RehearsalConfig, ToolConfig
from server.marker_file import load_marker_image
from server.setup import CaseSetup, Preparation, build_setup, nominal_camera
from tracker.camera import CameraControl
from tracker.errors import CalibrationError, InvalidInput
from tracker.navigation import Absent, AbsentReason
from tracker.plan import Channel
from tracker.pose import ToolModel

CAMERA = {
    "matrix": [[500, 0, 32], [0, 500, 24], [0, 0, 1]],
    "distortion": [0, 0, 0, 0],
    "size_wh_px": [64, 48],
}


def picture(path: Path, *, width: int = 40, height: int = 40, contrast: int = 255) -> Path:
    image = np.zeros((height, width), np.uint8)
    image[height // 4 : height // 2, width // 4 :] = contrast
    cv2.imwrite(str(path), image)
    return path


@pytest.mark.parametrize("suffix", ["png", "jpg", "bmp"])
def test_a_marker_picture_is_read_as_grey(tmp_path: Path, suffix: str) -> None:
    image = load_marker_image(picture(tmp_path / f"m.{suffix}"))
    assert image.shape == (40, 40)
    assert image.dtype == np.uint8


@pytest.mark.parametrize(
    ("width", "height", "contrast", "code"),
    [
        pytest.param(7, 7, 255, "MARKER_IMAGE_TOO_SMALL", id="seven-pixels"),
        pytest.param(100, 97, 255, "MARKER_IMAGE_NOT_SQUARE", id="three-percent-off-square"),
        pytest.param(40, 40, 20, "MARKER_IMAGE_FLAT", id="nearly-one-grey"),
        pytest.param(100, 98, 255, None, id="two-percent-off-square-is-fine"),
    ],
)
def test_a_picture_that_cannot_be_a_marker_is_rejected_with_its_numbers(
    tmp_path: Path, width: int, height: int, contrast: int, code: str | None
) -> None:
    file = picture(tmp_path / "m.png", width=width, height=height, contrast=contrast)
    if code is None:
        assert load_marker_image(file).shape == (height, width)
        return
    with pytest.raises(InvalidInput) as caught:
        load_marker_image(file)
    assert caught.value.code == code
    assert "m.png" in caught.value.message


def test_a_file_that_is_no_picture_is_rejected(tmp_path: Path) -> None:
    (tmp_path / "m.png").write_text("words")
    with pytest.raises(InvalidInput, match="5 bytes"):
        load_marker_image(tmp_path / "m.png")


def test_a_camera_file_may_be_yaml_or_json(tmp_path: Path) -> None:
    for name, text in (("c.json", json.dumps(CAMERA)), ("c.yaml", str(CAMERA))):
        (tmp_path / name).write_text(text)
        assert load_camera_file(tmp_path / name).size_wh_px == (64, 48)


@pytest.mark.parametrize(
    ("text", "code"),
    [
        pytest.param("[1, 2]", "CAMERA_FILE_INVALID", id="a-list"),
        pytest.param("matrix: 1", "CAMERA_FILE_INCOMPLETE", id="keys-missing"),
        pytest.param("a: [", "CAMERA_FILE_UNREADABLE", id="not-yaml"),
        pytest.param(json.dumps({**CAMERA, "matrix": "k"}), "CAMERA_FILE_INVALID", id="matrix-is-a-word"),
        pytest.param(
            json.dumps({**CAMERA, "camera": {"controls": {"focus": "near"}}}),
            "CAMERA_FILE_INVALID",
            id="a-control-is-a-word",
        ),
        pytest.param(
            json.dumps({**CAMERA, "camera": {"controls": {"sharpness": 3}}}),
            "CAMERA_FILE_INVALID",
            id="a-control-that-is-none",
        ),
        pytest.param(json.dumps({**CAMERA, "distortion": [0]}), "CAMERA_MODEL_INVALID", id="one-coefficient"),
        pytest.param(
            json.dumps({**CAMERA, "size_wh_px": [64.5, 48]}), "CAMERA_MODEL_INVALID", id="half-a-pixel"
        ),
        pytest.param(
            json.dumps({**CAMERA, "distortion": [1e6, 0, 0, 0, 0]}), "CAMERA_MODEL_INVALID", id="no-lens"
        ),
    ],
)
def test_a_camera_file_that_cannot_be_used_names_itself(tmp_path: Path, text: str, code: str) -> None:
    (tmp_path / "c.yaml").write_text(text)
    with pytest.raises(InvalidInput) as caught:
        load_camera_file(tmp_path / "c.yaml")
    assert caught.value.code == code
    assert "c.yaml" in caught.value.message


def test_a_camera_file_keeps_identity_and_controls_of_its_camera(tmp_path: Path) -> None:
    path = tmp_path / "c.yaml"
    camera = {"name": "main", "device": "Webcam", "controls": {"focus": 120, "zoom": 0}}
    path.write_text(json.dumps({**CAMERA, "camera": camera}))
    file = read_camera_file(path)
    assert file.device == "Webcam"
    assert file.controls == {CameraControl.FOCUS: 120, CameraControl.ZOOM: 0}
    path.write_text(camera_file_text(file, {}))
    again = read_camera_file(path)
    assert (again.controls, again.device) == (file.controls, file.device)
    settings = Config(camera=CameraConfig(source="v.mov", calibration=path))
    assert build_setup(settings).camera_controls == file.controls
    assert build_setup(settings).camera_device == "Webcam"


def config(folder: Path, *, calibrated: bool) -> Config:
    (folder / "c.json").write_text(json.dumps(CAMERA))
    calibration = folder / "c.json" if calibrated else None
    tool = ToolConfig(
        marker="m", tip_in_marker_mm=[0, -9, 0], axis_in_marker=[0, -1, 0], radius_mm=2, length_mm=9
    )
    return Config(
        camera=CameraConfig(source="v.mov", calibration=calibration),
        markers={"m": MarkerConfig(image=picture(folder / "m.png"), side_mm=25.0)},
        tools={"t": tool},
    )


def test_without_a_camera_file_no_millimetre_is_claimed(tmp_path: Path) -> None:
    preparation = build_setup(config(tmp_path, calibrated=False))
    assert preparation.setup is None
    setup = preparation.setup_for((640, 360))
    assert not setup.camera_calibrated
    assert setup.camera.size_wh_px == (640, 360)
    assert setup.camera.matrix[0, 0] == pytest.approx(768.0)


def test_how_long_a_camera_reads_its_rows_reaches_the_tracker_and_not_the_rehearsal(tmp_path: Path) -> None:
    given = config(tmp_path, calibrated=True)
    for source, readout_s in (("0", 0.016), ("rehearsal", 0.0)):
        camera = given.camera.model_copy(update={"source": source, "readout_ms": 16.0})
        preparation = build_setup(given.model_copy(update={"camera": camera}))
        assert preparation.readout_s == readout_s
        assert preparation.setup is not None
        assert preparation.tracker_for(preparation.setup).readout_s == readout_s
        # The case's calibration has precedence over the settings, also for a global shutter.
        for stored_ms in (21.0, 0.0):
            expected_s = 0.0 if source == "rehearsal" else stored_ms / 1000.0
            assert preparation.with_case(CaseSetup(readout_ms=stored_ms)).readout_s == expected_s
        assert preparation.with_case(CaseSetup()).readout_s == readout_s


def test_without_plan_and_registration_both_are_absent_with_their_reason(tmp_path: Path) -> None:
    setup = build_setup(config(tmp_path, calibrated=True)).setup
    assert setup is not None
    assert setup.camera_calibrated
    assert setup.channel == Absent(reason=AbsentReason.NO_PLAN)
    assert setup.registration == Absent(reason=AbsentReason.NOT_REGISTERED)
    assert setup.tools["t"].marker == "m"


def test_a_camera_file_for_another_size_is_rejected_with_both_sizes(tmp_path: Path) -> None:
    preparation = build_setup(config(tmp_path, calibrated=True))
    with pytest.raises(CalibrationError) as caught:
        preparation.setup_for((640, 360))
    assert caught.value.code == "CAMERA_SIZE_MISMATCH"
    assert "640x360" in caught.value.message
    assert "64x48" in caught.value.message
    assert not preparation.uncalibrated_setup_for((640, 360)).camera_calibrated


def test_a_calibration_is_scaled_only_if_allowed(tmp_path: Path) -> None:
    plain = build_setup(config(tmp_path, calibrated=True))
    with pytest.raises(CalibrationError) as caught:
        plain.setup_for((128, 96))
    assert "128x96" in caught.value.message
    assert "64x48" in caught.value.message
    assert "camera.same_sensor_area" in caught.value.remedy
    stated = replace(plain, same_sensor_area=True)
    setup = stated.setup_for((128, 96))
    assert setup.camera_calibrated
    assert setup.camera.size_wh_px == (128, 96)
    assert setup.camera.matrix[0, 0] == 1000.0
    # Another aspect ratio is never possible, and the remedy does not suggest it.
    with pytest.raises(CalibrationError) as caught:
        stated.setup_for((128, 72))
    assert caught.value.code == "CAMERA_SIZE_MISMATCH"
    assert "same_sensor_area" not in caught.value.remedy
    assert "never scaled" in caught.value.remedy


def prepared(tmp_path: Path) -> Preparation:
    markers = {"m": MarkerConfig(image=picture(tmp_path / "m.png"), side_mm=25.0)}
    return build_setup(Config(camera=CameraConfig(source="0"), markers=markers))


def made_tool(marker: str) -> ToolModel:
    return ToolModel.from_tip_and_axis(
        name="awl",
        marker=marker,
        tip_in_marker_mm=[0, -90, 0],
        axis_in_marker=[0, -1, 0],
        radius_mm=1.5,
        length_mm=90,
    )


def test_what_a_case_knows_takes_the_place_of_the_settings(tmp_path: Path) -> None:
    case = CaseSetup(
        camera=nominal_camera((64, 48)), tools={"awl": made_tool("m"), "lost": made_tool("other")}
    )
    changed = prepared(tmp_path).with_case(case)
    assert changed.setup is not None
    assert changed.setup.camera_calibrated
    assert list(changed.setup.tools) == ["awl"], "a tool whose marker nobody looks for cannot be placed"


def test_a_channel_of_the_case_is_not_registered_by_what_registered_another() -> None:
    rehearsal = build_setup(Config())
    assert not isinstance(rehearsal.registration, Absent)
    channel = Channel(
        name="L4 left", entry_in_vertebra_mm=np.zeros(3), target_in_vertebra_mm=np.ones(3) * 9, radius_mm=3.0
    )
    changed = rehearsal.with_case(CaseSetup(channel=channel))
    assert changed.channel is channel
    assert changed.registration == Absent(reason=AbsentReason.NOT_REGISTERED)


def test_after_a_case_is_closed_the_rehearsals_own_channel_says_whose_it_is() -> None:
    rehearsal = build_setup(Config())
    closed = rehearsal.with_case(CaseSetup())
    assert closed.registration is rehearsal.registration
    assert not isinstance(closed.channel, Absent)
    assert closed.channel.name == "rehearsal's L3 left"


def test_a_rehearsal_that_brings_no_setup_knows_its_marker_alone() -> None:
    bare = build_setup(Config(rehearsal=RehearsalConfig(provides_setup=False)))
    assert [model.name for model in bare.models] == ["drill"]
    assert bare.camera is None
    assert bare.tools == {}
    assert bare.channel == Absent(reason=AbsentReason.NO_PLAN)
    assert bare.registration == Absent(reason=AbsentReason.NOT_REGISTERED)
