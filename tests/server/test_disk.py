"""Disk space: checked before it is used, and reported in numbers if there is too little."""

import errno
import os
from pathlib import Path

import numpy as np
import pytest

from server import disk
from server.disk import DiskFull
from server.imaging.voxels import voxels_to_fill

VOLUME = (64, 64, 64)


def test_a_ct_without_room_is_rejected_before_its_file_is_made(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(disk, "RESERVED_BYTES", 2**60)
    with pytest.raises(DiskFull) as full, voxels_to_fill(VOLUME, tmp_path / "voxels.npy"):
        pytest.fail("it is not begun")
    assert full.value.context["needed_bytes"] == 2 * 64**3
    assert "0.5 MB are needed" in full.value.message
    assert list(tmp_path.iterdir()) == []


def test_the_room_of_a_ct_is_its_own_before_the_first_voxel(tmp_path: Path) -> None:
    with voxels_to_fill(VOLUME, tmp_path / "voxels.npy") as voxels:
        # A sparse file would end with a signal if the disk is full when it is written.
        (partial,) = tmp_path.iterdir()
        assert partial.stat().st_blocks * 512 >= 2 * 64**3
        voxels.hu[:] = 7
    assert np.load(tmp_path / "voxels.npy").min() == 7


def test_a_disk_that_is_full_all_the_same_is_reported_and_leaves_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def reject(*_requested: object) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(os, "posix_fallocate", reject, raising=False)
    with pytest.raises(DiskFull) as full, voxels_to_fill(VOLUME, tmp_path / "voxels.npy"):
        pytest.fail("it is not begun")
    assert full.value.code == "STORE_FULL"
    assert "MB are free" in full.value.message
    assert list(tmp_path.iterdir()) == []
