"""Small private files: their content, who can read them, and what damage or a full disk does."""

import errno
import os
from pathlib import Path

import pytest

from server.store import StoreError
from server.store.private_file import PrivateJsonFile
from server.supervision.hold_storage import HoldRequestFile


def test_what_was_written_is_read_again_and_only_by_the_owner(tmp_path: Path) -> None:
    file = PrivateJsonFile(tmp_path / "small.json", form=2)
    assert file.read() is None
    file.write({"values": [1, 2]})
    file.write({"values": [3]})
    assert file.read() == {"form": 2, "values": [3]}
    assert file.path.stat().st_mode & 0o777 == 0o600
    assert [one.name for one in tmp_path.iterdir()] == ["small.json"]


@pytest.mark.parametrize("content", [b"", b"{", b"[]", b"{}", b'{"form": 3}'])
def test_a_damaged_file_or_another_form_is_a_value_error(tmp_path: Path, content: bytes) -> None:
    (tmp_path / "small.json").write_bytes(content)
    with pytest.raises(ValueError, match=r"form 2|Expect"):
        PrivateJsonFile(tmp_path / "small.json", form=2).read()


def test_a_full_disk_leaves_the_stored_object(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file = PrivateJsonFile(tmp_path / "small.json", form=2)
    file.write({"values": [1]})

    def full(_descriptor: int, _content: bytes) -> int:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(os, "write", full)
    with pytest.raises(OSError, match="No space"):
        file.write({"values": [2]})
    assert file.read() == {"form": 2, "values": [1]}
    assert [one.name for one in tmp_path.iterdir()] == ["small.json"]
    with pytest.raises(StoreError) as caught:
        HoldRequestFile(tmp_path).write([])
    assert caught.value.code == "STORE_FULL"
