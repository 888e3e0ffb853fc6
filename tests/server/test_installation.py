"""Imports of child processes and the folder of compiled code, in an installation and in a checkout."""

from pathlib import Path

import pytest

from server.installation import default_settings, isolate_imports, place_code_cache

ROOT = Path(__file__).parents[2]
RECORD = """\
server/app.py,sha256=aaaa,10
tracker/errors.py,sha256=bbbb,20
tracker/README.md,sha256=cccc,30
tracker/__pycache__/errors.cpython-311.pyc,,
coaxial-0.1.0.dist-info/RECORD,,
"""


@pytest.fixture(autouse=True)
def cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The user's cache folder, if the data folder is elsewhere."""
    monkeypatch.setattr("platformdirs.user_cache_path", lambda name: tmp_path / "cache" / name)
    monkeypatch.setenv("COAXIAL_HOME", str(tmp_path / "home"))
    return tmp_path / "cache" / "coaxial"


def placed(record: str | None) -> str | None:
    environment: dict[str, str] = {}
    place_code_cache(environment, record)
    return environment.get("NUMBA_CACHE_DIR")


def test_compiled_code_of_an_installation_lies_in_the_cache_folder(cache: Path) -> None:
    folder = placed(RECORD)
    assert folder is not None
    assert Path(folder).parent == cache
    assert Path(folder).is_dir()


def test_compiled_code_of_another_tracker_is_not_used() -> None:
    assert placed(RECORD) == placed(RECORD.replace("aaaa", "a0a0").replace("cccc", "c0c0"))
    assert placed(RECORD) != placed(RECORD.replace("bbbb", "b0b0"))


def test_a_cache_folder_that_cannot_be_written_is_replaced_by_the_data_folder(
    cache: Path, tmp_path: Path
) -> None:
    cache.parent.write_text("a file, so no folder can be made here")
    folder = placed(RECORD)
    assert folder is not None
    assert Path(folder).is_relative_to(tmp_path / "home")


@pytest.mark.parametrize("record", [None, "_coaxial.pth,sha256=dddd,7\n"], ids=["not-installed", "editable"])
def test_a_checkout_compiles_beside_its_sources(record: str | None) -> None:
    assert placed(record) is None


def test_a_folder_of_compiled_code_that_is_set_is_used() -> None:
    environment = {"NUMBA_CACHE_DIR": "there"}
    place_code_cache(environment, RECORD)
    assert environment == {"NUMBA_CACHE_DIR": "there"}


def test_children_ignore_the_current_folder_unless_it_is_imported_from() -> None:
    installed: dict[str, str] = {}
    isolate_imports(installed, ["/opt/coaxial/bin", "/opt/coaxial/lib"])
    assert installed == {"PYTHONSAFEPATH": "1"}
    checkout: dict[str, str] = {}
    isolate_imports(checkout, [str(Path.cwd()), "/opt/coaxial/lib"])
    assert checkout == {}


def test_the_default_settings_are_the_documented_ones() -> None:
    assert default_settings() == (ROOT / "config.yaml").read_text(encoding="utf-8")
