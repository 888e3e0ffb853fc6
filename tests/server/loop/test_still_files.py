"""Cached background files save the rendering at a start; a damaged file causes no error."""

import threading
from pathlib import Path

import numpy as np
import pytest

from server.loop import still_files
from server.loop.still_files import FOLDER, StillFiles
from tracker.rehearsal import Scene, Theatre, TheatreSettings, backdrop, scenery

SETTINGS = TheatreSettings(seed=4, size_wh_px=(160, 160), clutter=0.0)
AT_S = 9.0


def image(home: Path, settings: TheatreSettings = SETTINGS) -> np.ndarray:
    """The image with what the home keeps, and what it keeps afterwards is written."""
    shown = Theatre(settings).renderer(store=StillFiles(home)).image_at(AT_S)
    for thread in threading.enumerate():
        if thread.name == "scenery":
            thread.join()
    return shown


def files(home: Path) -> list[Path]:
    return sorted((home / FOLDER).glob("*"))


@pytest.fixture
def rendered(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """One entry for each scenery that was rendered."""
    out: list[str] = []
    render = scenery.still_scenery

    def counted(*given: object) -> object:
        out.append("rendered")
        return render(*given)  # pyrefly: ignore[bad-argument-type]  # as it was called

    monkeypatch.setattr(backdrop, "still_scenery", counted)
    return out


def test_the_second_start_shows_the_same_without_rendering(tmp_path: Path, rendered: list[str]) -> None:
    first = image(tmp_path)
    second = image(tmp_path)
    np.testing.assert_array_equal(second, first)
    np.testing.assert_array_equal(first, Theatre(SETTINGS).renderer().image_at(AT_S))
    assert len(rendered) == 2, "once for the first, and once without a store"


def test_another_scene_of_the_same_theatre_is_the_same_scenery(tmp_path: Path, rendered: list[str]) -> None:
    image(tmp_path)
    image(tmp_path, TheatreSettings(seed=4, size_wh_px=(160, 160), clutter=0.0, scene=Scene.BOARD))
    assert len(rendered) == 1


def test_another_theatre_or_another_program_is_not_taken(
    tmp_path: Path, rendered: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    image(tmp_path)
    image(tmp_path, TheatreSettings(seed=4, size_wh_px=(160, 160), clutter=0.0, blur=2.0))
    monkeypatch.setattr(still_files, "_program", lambda: b"changed")
    image(tmp_path)
    assert len(rendered) == 3
    assert len(files(tmp_path)) == 3


@pytest.mark.parametrize("damage", ["cut", "empty", "flipped", "other"])
def test_a_damaged_file_changes_nothing(tmp_path: Path, rendered: list[str], damage: str) -> None:
    first = image(tmp_path)
    (file,) = files(tmp_path)
    whole = bytearray(file.read_bytes())
    if damage == "flipped":
        whole[len(whole) // 2] ^= 0xFF
    if damage == "other":
        np.savez(file, picture=np.zeros((4, 4), dtype=np.uint8))
    else:
        file.write_bytes({"cut": bytes(whole[: len(whole) // 2]), "empty": b""}.get(damage, bytes(whole)))
    np.testing.assert_array_equal(image(tmp_path), first)
    assert len(rendered) == 2
    image(tmp_path)
    assert len(rendered) == 2, "and was written anew"


def test_a_home_that_takes_nothing_changes_nothing(tmp_path: Path, rendered: list[str]) -> None:
    occupied = tmp_path / "file"
    occupied.write_bytes(b"")
    for home in (occupied, tmp_path / "missing"):
        image(home)
        image(home)
    assert len(rendered) == 4
    assert not (tmp_path / "missing").exists(), "a home is made by what owns it"


def test_a_full_disk_leaves_nothing_behind(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(np, "savez", _full)
    image(tmp_path)
    assert files(tmp_path) == []


def _full(*_given: object, **_named: object) -> None:
    raise OSError(28, "No space left on device")


def test_only_so_many_are_kept(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(still_files, "MAX_FILES", 2)
    for seed in range(1, 5):
        image(tmp_path, TheatreSettings(seed=seed, size_wh_px=(160, 160), clutter=0.0))
    assert len(files(tmp_path)) == 2
