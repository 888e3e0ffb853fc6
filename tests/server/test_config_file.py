"""Settings: their sources, and error messages for all mistakes."""

import operator
from pathlib import Path

import cv2
import numpy as np
import pytest
import yaml

from server.config import Config
from server.config_file import Override, load_config
from server.errors import ConfigError
from server.printing.board_sheet import description_of
from tracker.rehearsal.boards import BOARD_FROM_KIND
from tracker.rehearsal.settings import BoardKind

REPOSITORY = Path(__file__).parents[2]


def settings(folder: Path, content: object) -> Path:
    file = folder / "settings.yaml"
    file.write_text(content if isinstance(content, str) else yaml.safe_dump(content))
    return file


def rejected(folder: Path, content: object) -> ConfigError:
    with pytest.raises(ConfigError) as caught:
        load_config(settings(folder, content), environment={})
    assert "settings.yaml" in caught.value.message
    assert caught.value.remedy
    return caught.value


def test_the_file_in_the_repository_states_the_built_in_defaults() -> None:
    assert load_config(REPOSITORY / "config.yaml", environment={}) == Config()


@pytest.mark.parametrize("kind", list(BoardKind))
def test_the_file_describes_the_board_that_the_rehearsal_shows(kind: BoardKind) -> None:
    pattern, numbers = description_of(BOARD_FROM_KIND[kind]).removesuffix(", newer layout").split(" ", 1)
    assert pattern == kind.value
    described = f"{pattern}: {numbers}"
    assert described in (REPOSITORY / "config.yaml").read_text(), (
        f"config.yaml: describe it above `board`: {described}"
    )


def test_without_a_file_the_built_in_settings_hold(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert load_config(environment={}) == Config()
    (tmp_path / "config.yaml").write_text("server: {port: 8123}\ncamera:\n")
    assert load_config(environment={}).server.port == 8123


TOOL = {
    "marker": "a",
    "tip_in_marker_mm": [0, 0, 0],
    "axis_in_marker": [0, 0, 0],
    "radius_mm": 1,
    "length_mm": 9,
}
TRACKER = {
    "transforms": ["DrillToTracker", "PatientToTracker"],
    "sd_mm": 0.2,
    "sd_deg": 0.2,
    "latency_ms": 40,
}


def tracker_with(**changes: object) -> dict[str, object]:
    """Settings of an external tracker; a key of None is omitted."""
    section = {key: value for key, value in {**TRACKER, **changes}.items() if value is not None}
    patient = {"marker": "PatientToTracker"}
    return {"camera": {"source": "openigtlink"}, "external_tracker": section, "reference": patient}


@pytest.mark.parametrize(
    ("content", "words"),
    [
        pytest.param(
            {"server": {"prot": 1}}, ["'server.prot'", "'server.port'", "host, port"], id="key-nearly-right"
        ),
        pytest.param({"sever": {}}, ["'sever'", "'server'", "limits"], id="section-nearly-right"),
        pytest.param(
            {"server": {"port": 70000}}, ["'server.port' is 70000", "0 to 65535"], id="out-of-range"
        ),
        pytest.param({"server": {"port": "8000"}}, ["'8000'", "whole number"], id="text-for-a-number"),
        pytest.param({"rehearsal": {"seed": True}}, ["True", "whole number"], id="flag-for-a-number"),
        pytest.param({"rehearsal": {"noise": float("nan")}}, ["nan", "0 to 10"], id="not-a-number"),
        pytest.param({"camera": {"rate": "slow"}}, ["'slow'", "own or fast"], id="word-not-offered"),
        pytest.param({"camera": {"source": [1]}}, ["[1]", "0 to 99", "text"], id="source-is-a-list"),
        pytest.param({"server": [1]}, ["'server' is [1]", "host, port"], id="section-is-a-list"),
        pytest.param({"video": {"jpeg_quality": 0}}, ["1 to 100"], id="quality-zero"),
        pytest.param({"tracker": {"accept_score_ratio": 1.1}}, ["1.1", "0 to 1"], id="ratio-over-one"),
        pytest.param({"camera": {"width": 640}}, ["camera.width", "camera.height"], id="width-alone"),
        pytest.param(
            {"camera": {"trigger": "line1"}},
            ["'camera.trigger' is 'line1'", "industrial camera"],
            id="trigger-of-a-rehearsal",
        ),
        pytest.param(
            {"camera": {"source": "basler:1", "trigger": "line 1"}},
            ["camera.trigger"],
            id="trigger-with-a-space",
        ),
        pytest.param({"tools": {"t": TOOL}}, ["tools.t.marker", "axis_in_marker"], id="tool-of-nothing"),
        pytest.param({"markers": {"a b": {}}}, ["markers.a b", "letters"], id="name-with-a-space"),
        pytest.param({5: 1}, ["'[5]'", "server"], id="key-is-a-number"),
        pytest.param("server: {port: 1\n", ["YAML", "line"], id="not-yaml"),
        pytest.param("- a\n", ["YAML", "list"], id="list-at-the-top"),
        pytest.param("video: {}\nvideo: {}\n", ["'video'", "duplicate"], id="key-twice"),
        pytest.param(
            {"camera": {"calibration": "c.yaml"}}, ["camera.calibration", "c.yaml"], id="no-camera-file"
        ),
        pytest.param(
            {"markers": {"m": {"image": "m.png", "side_mm": 4}}},
            ["markers.m.image", "m.png"],
            id="no-picture",
        ),
        pytest.param(
            {"markers": {"drill": {"image": "m.png", "side_mm": 4}}}, ["rehearsal's own"], id="drill-is-taken"
        ),
        pytest.param(
            {
                "rehearsal": {"reference": True},
                "markers": {"reference": {"image": "m.png", "side_mm": 4}},
            },
            ["markers.reference", "rehearsal's own"],
            id="reference-is-taken",
        ),
        pytest.param(
            {"plan": {"screw_ranges": [{"name": "Slim", "diameters_mm": [4.5, 3], "lengths_mm": [40]}]}},
            ["'plan.screw_ranges[0].diameters_mm' of 'Slim' has 3", "'plan.screw_diameters_mm'"],
            id="product-line-with-a-size-of-no-screw",
        ),
        pytest.param(
            {"dicom": {"receive": {"port": 11112}}},
            ["'dicom.receive.allowed_ae_titles' is empty", "at least one AE title"],
            id="dicom-from-nobody",
        ),
        pytest.param(
            {"dicom": {"receive": {"client_ca": "ca.pem"}}},
            ["'dicom.receive.client_ca'", "with TLS only"],
            id="certificates-of-senders-without-tls",
        ),
        pytest.param(
            {"dicom": {"ae_title": "SEVENTEEN_LETTERS"}}, ["dicom.ae_title"], id="too-long-an-ae-title"
        ),
        pytest.param(
            {"camera": {"source": "openigtlink"}}, ["'external_tracker' is missing"], id="no-tracker"
        ),
        pytest.param(
            tracker_with(transforms=["TrackerToDrill", "PatientToTracker"]),
            ["'external_tracker.transforms' lead to the frames Drill, Tracker", "one frame of the tracker"],
            id="an-inverse-transform",
        ),
        pytest.param(
            {**tracker_with(), "reference": {}},
            ["'reference.marker' is missing"],
            id="no-patient",
        ),
        pytest.param(
            tracker_with(sd_mm=0, sd_deg=0, latency_ms=0),
            [f"'external_tracker.{key}' is 0, allowed: a number above 0" for key in ("sd_mm", "latency_ms")],
            id="a-tracker-without-error",
        ),
        pytest.param(
            tracker_with(sd_mm=None, sd_deg=None, latency_ms=None),
            [f"'external_tracker.{key}' is missing" for key in ("sd_mm", "sd_deg", "latency_ms")],
            id="no-error-of-the-tracker",
        ),
        pytest.param(
            {"rehearsal": {"events": [{"kind": "earthquake", "at_s": 1}]}},
            ["earthquake", "camera_moves or patient_moves"],
            id="no-such-event",
        ),
    ],
)
def test_a_mistake_is_reported_with_file_key_value_and_what_is_allowed(
    tmp_path: Path, content: object, words: list[str]
) -> None:
    error = rejected(tmp_path, content)
    for word in words:
        assert word in error.message


def test_a_key_of_an_older_release_is_refused_with_its_successor(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    former = {
        "camera.speed_hz": "was renamed to 'camera.rate_hz' in 1.2.0",
        "tools.*.tip": "was removed in 2.0.0: give 'calibration'",
        "overlay": "was renamed to 'video' in 1.3.0",
    }
    monkeypatch.setattr("server.config_file.FORMER_KEYS", former)
    old = {
        "camera": {"speed_hz": 20},
        "tools": {"drill.1": {}, "awl": {**TOOL, "tip": 1}},
        "overlay": {"a": 1},
    }
    message = rejected(tmp_path, old).message
    for sentence in (
        "'camera.speed_hz' was renamed to 'camera.rate_hz' in 1.2.0",
        "'tools.awl.tip' was removed in 2.0.0: give 'calibration'",
        "'overlay' was renamed to 'video' in 1.3.0",
    ):
        assert sentence in message
    with pytest.raises(ConfigError, match=r"^COAXIAL__CAMERA__SPEED_HZ: 'camera\.speed_hz' was renamed to"):
        load_config(settings(tmp_path, {}), environment={"COAXIAL__CAMERA__SPEED_HZ": "20"})


def test_all_mistakes_are_reported_at_once(tmp_path: Path) -> None:
    error = rejected(tmp_path, {"server": {"port": -1, "hots": ""}, "video": {"jpeg_quality": 101}})
    mistakes = error.context["mistakes"]
    assert isinstance(mistakes, list)
    assert [mistake["key"] for mistake in mistakes] == ["server.port", "server.hots", "video.jpeg_quality"]


def test_a_file_that_is_not_there_is_reported(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match=r"nowhere\.yaml") as caught:
        load_config(tmp_path / "nowhere.yaml", environment={})
    assert caught.value.code == "CONFIG_FILE_UNREADABLE"


def test_paths_belong_to_the_folder_of_the_file_and_typed_ones_to_the_working_folder(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = tmp_path / "set"
    folder.mkdir()
    picture = np.zeros((20, 20), np.uint8)
    picture[5:9, 5:9] = 255
    cv2.imwrite(str(folder / "m.png"), picture)
    file = settings(
        folder, {"camera": {"source": "v.mov"}, "markers": {"m": {"image": "m.png", "side_mm": 4}}}
    )
    monkeypatch.chdir(tmp_path)
    config = load_config(file, environment={})
    assert config.camera.source == str(folder / "v.mov")
    assert config.markers["m"].image == folder / "m.png"
    typed: dict[tuple[str, ...], Override] = {
        ("camera", "source"): Override(value="w.mov", origin="--source")
    }
    assert load_config(file, overrides=typed, environment={}).camera.source == str(tmp_path / "w.mov")


def test_typed_beats_environment_beats_file_and_each_is_named_when_it_is_wrong(tmp_path: Path) -> None:
    file = settings(tmp_path, {"server": {"port": 1}})
    assert load_config(file, environment={"COAXIAL_PORT": "2"}).server.port == 2
    typed: dict[tuple[str, ...], Override] = {("server", "port"): Override(value=3, origin="--port")}
    assert load_config(file, overrides=typed, environment={"COAXIAL_PORT": "2"}).server.port == 3
    with pytest.raises(ConfigError, match=r"^COAXIAL_PORT: 'server\.port' is 'x'"):
        load_config(file, environment={"COAXIAL_PORT": "x"})
    typed = {("server", "port"): Override(value=-3, origin="--port")}
    with pytest.raises(ConfigError, match=r"^--port: 'server\.port' is -3"):
        load_config(file, overrides=typed, environment={})


@pytest.mark.parametrize(
    ("name", "text", "key", "value"),
    [
        pytest.param("COAXIAL__CAMERA__RATE", "fast", "camera.rate", "fast", id="a-word"),
        pytest.param("COAXIAL__CAMERA__RATE_HZ", "25", "camera.rate_hz", 25.0, id="a-rate"),
        pytest.param("COAXIAL__CAMERA__LOOP", "false", "camera.loop", False, id="a-flag"),
        pytest.param("COAXIAL__SECURITY__SIGN_IN", "off", "security.sign_in", "off", id="off-is-no-flag"),
        pytest.param("COAXIAL__SERVER__PORT", "9", "server.port", 9, id="a-number"),
        pytest.param("COAXIAL__PLUGINS__SINKS", "[]", "plugins.sinks", [], id="a-list"),
        pytest.param("COAXIAL__CAMERA__RATE_HZ", "null", "camera.rate_hz", None, id="null"),
        pytest.param("COAXIAL__SERVER__PORT", " ", "server.port", 1, id="empty-is-not-set"),
    ],
)
def test_every_setting_comes_from_the_environment(
    tmp_path: Path, name: str, text: str, key: str, value: object
) -> None:
    file = settings(tmp_path, {"server": {"port": 1}, "camera": {"loop": True, "rate_hz": 20}})
    config = load_config(file, environment={name: text, "COAXIAL_HOME": "elsewhere"})
    assert operator.attrgetter(key)(config) == value


def test_an_entry_of_a_section_comes_from_the_environment(tmp_path: Path) -> None:
    picture = np.zeros((20, 20), np.uint8)
    picture[5:9, 5:9] = 255
    cv2.imwrite(str(tmp_path / "m.png"), picture)
    file = settings(tmp_path, {"markers": {"m": {"image": "m.png", "side_mm": 4}}})
    assert load_config(file, environment={"COAXIAL__MARKERS__M__SIDE_MM": "5.5"}).markers["m"].side_mm == 5.5


@pytest.mark.parametrize(
    ("name", "text", "message"),
    [
        pytest.param(
            "COAXIAL__CAMERA__RATES",
            "fast",
            r"^COAXIAL__CAMERA__RATES: 'camera\.rates' is not a known key, did you mean 'camera\.rate'\?",
            id="no-such-key",
        ),
        pytest.param(
            "COAXIAL__SERVER__PORT",
            "x",
            r"^COAXIAL__SERVER__PORT: 'server\.port' is 'x', allowed: a whole number from 0",
            id="no-such-value",
        ),
        pytest.param("COAXIAL__CAMERA__RATE", "[", "^COAXIAL__CAMERA__RATE is not valid YAML", id="no-yaml"),
    ],
)
def test_a_wrong_setting_of_the_environment_is_named(
    tmp_path: Path, name: str, text: str, message: str
) -> None:
    with pytest.raises(ConfigError, match=message):
        load_config(settings(tmp_path, {}), environment={name: text})
