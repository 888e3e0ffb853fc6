"""A camera with a bad calibration report causes a warning with its values."""

from pathlib import Path

import pytest
import structlog
import yaml

from server.camera_file import read_camera_file
from server.camera_remarks import warn_of_doubtful_camera

CAMERA = {
    "matrix": [[1400.0, 0.0, 960.0], [0.0, 1400.0, 540.0], [0.0, 0.0, 1.0]],
    "distortion": [-0.1, 0.02, 0.0, 0.0, 0.0],
    "size_wh_px": [1920, 1080],
}
GOOD = {"rms_px": 0.31, "sd": {"fx": 1.2, "fy": 1.1, "cx": 0.9, "cy": 0.8, "k1": 0.002}, "warnings": []}


def warnings_for(report: dict[str, object], folder: Path) -> list[str]:
    path = folder / "camera.yaml"
    path.write_text(yaml.safe_dump({**CAMERA, **report}))
    with structlog.testing.capture_logs() as lines:
        warn_of_doubtful_camera(read_camera_file(path), title=str(path), max_rms_px=1.0)
    assert all(line["code"] == "CAMERA_DOUBTFUL" and line["remedy"] for line in lines)
    return [line["event"] for line in lines]


@pytest.mark.parametrize("report", [{}, GOOD, {"rms_px": 1.0}], ids=["none", "good", "at the limit"])
def test_a_credible_report_or_none_is_not_warned_of(report: dict[str, object], tmp_path: Path) -> None:
    assert warnings_for(report, tmp_path) == []


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"rms_px": 2.31}, "rms_px is 2.31, allowed: above 0 to 1 px"),
        ({"rms_px": 0.0}, "rms_px is 0.0"),
        ({"rms_px": float("nan")}, "rms_px is nan"),
        ({"rms_px": "small"}, "rms_px is small"),
        ({"sd": {"fx": 14.1}}, "standard deviation of fx is 14.1 px, recommended up to 14.0 px"),
        ({"sd": {"cy": -1.0}}, "standard deviation of cy is -1.0 px, recommended up to 19.2 px"),
        ({"parameters": [{"name": "fy", "sd": 50.0}], "sd": None}, "standard deviation of fy is 50.0 px"),
        ({"warnings": ["CORNERS_UNCOVERED"]}, "it has the warnings CORNERS_UNCOVERED"),
        ({"warnings": [{"code": "TWO_CAMERAS"}]}, "it has the warnings TWO_CAMERAS"),
    ],
)
def test_a_report_that_contradicts_its_camera_is_warned_of(
    change: dict[str, object], message: str, tmp_path: Path
) -> None:
    (warning,) = warnings_for({**GOOD, **change}, tmp_path)
    assert message in warning
    assert "camera.yaml" in warning
