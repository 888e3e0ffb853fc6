"""Camera, tool and settings files with arbitrary content: rejected with their own code, never a traceback."""

from pathlib import Path

import pytest

from server.camera_file import load_camera_file
from server.config_file import load_config
from server.errors import ConfigError
from server.tool_file import load_tool_file
from tracker.errors import InvalidInput


@pytest.mark.parametrize(
    "content",
    [
        pytest.param(b"[" * 100_000, id="lists-without-end"),
        pytest.param(b"made_at: 2026-13-45", id="a-date-that-there-is-not"),
        pytest.param(b"\xff\xfe\x00", id="no-text"),
        pytest.param(b"matrix: [1, 2", id="cut-off"),
        pytest.param(b"a: !!python/object/apply:os.system ['true']", id="a-command"),
        pytest.param(b"\x00", id="a-zero"),
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
