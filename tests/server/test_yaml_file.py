"""Camera, tool and settings files with arbitrary content: rejected with their own code, never a traceback."""

import json
from datetime import UTC, datetime
from pathlib import Path

import pytest

from server.camera_file import load_camera_file
from server.config_file import load_config
from server.errors import ConfigError
from server.tool_file import load_tool_file
from tracker.errors import InvalidInput


def unfolding(form: str, *, first: str = "[1, 1]") -> bytes:
    """YAML of a few lines, each of which has the one before ten times."""
    lines = [f"a0: &a0 {first}"]
    lines += [f"a{n}: &a{n} {form.format(', '.join([f'*a{n - 1}'] * 10))}" for n in range(1, 12)]
    return "\n".join(lines).encode()


@pytest.mark.parametrize(
    "content",
    [
        pytest.param(b"[" * 100_000, id="lists-without-end"),
        pytest.param(b"made_at: 2026-13-45", id="a-date-that-there-is-not"),
        pytest.param(b"\xff\xfe\x00", id="no-text"),
        pytest.param(b"matrix: [1, 2", id="cut-off"),
        pytest.param(b"a: !!python/object/apply:os.system ['true']", id="a-command"),
        pytest.param(b"\x00", id="a-zero"),
        pytest.param(unfolding("[{}]"), id="lists-that-multiply"),
        pytest.param(unfolding("{{<<: [{}]}}", first="{x: 1}"), id="merged-mappings-that-multiply"),
        pytest.param(b"a: &a [*a]", id="a-list-that-contains-itself"),
        pytest.param(b"matrix: [[0x" + b"f" * 5000 + b", 0, 0]]", id="a-number-of-thousands-of-digits"),
        pytest.param(b'{"server": {"\\ud800": 1}}', id="half-a-character"),
        pytest.param(b"# " + b"x" * 2**20, id="megabytes"),
        pytest.param(None, id="a-folder"),
    ],
)
def test_what_cannot_be_read_is_reported(tmp_path: Path, content: bytes | None) -> None:
    path = tmp_path / "file.yaml"
    if content is None:
        path.mkdir()
    else:
        path.write_bytes(content)
    for kind, load in (("camera", load_camera_file), ("tool", load_tool_file)):
        with pytest.raises(InvalidInput) as reported:
            load(path)
        assert reported.value.code == f"{kind.upper()}_FILE_UNREADABLE"
        assert f"the {kind} file {path} " in reported.value.message
    with pytest.raises(ConfigError) as rejected:
        load_config(path)
    assert str(path) in rejected.value.message


def test_a_tool_file_may_be_json_and_its_date_quoted(tmp_path: Path) -> None:
    pivot = {
        "tip_in_marker_mm": [0.0, -120.0, -10.0],
        "covariance_mm2": [[0.01, 0.0, 0.0], [0.0, 0.01, 0.0], [0.0, 0.0, 0.01]],
        "rms_3d_mm": 0.3,
        "used": 40,
        "rejected": 0,
        "tilt_range_deg": 40.0,
        "made_at": "2026-11-21T10:00:00+00:00",
    }
    path = tmp_path / "drill.json"
    path.write_text(json.dumps({"marker": "drill", "side_mm": 25.0, "pivot": pivot}))
    assert load_tool_file(path).pivot.made_at == datetime(2026, 11, 21, 10, tzinfo=UTC)
    path.write_text(json.dumps({"marker": "drill", "side_mm": 25.0, "pivot": {**pivot, "made_at": "soon"}}))
    with pytest.raises(InvalidInput) as rejected:
        load_tool_file(path)
    assert rejected.value.code == "TOOL_FILE_INVALID"
    assert "pivot.made_at" in rejected.value.message
