"""The layout of the repository: locations and names of files."""

import ast
import subprocess
from collections import Counter
from collections.abc import Iterable
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
TOP = {
    *("pyproject.toml", "server", "tracker", "web", "tests", "docs", "config.yaml", "Dockerfile", "Makefile"),
    *("README.md", "ARCHITECTURE.md", "CHANGELOG.md", "CONTRIBUTING.md", "LICENSE"),
}
ROOMS = ("tracker", "server", "tests", "web", "docs")
PACKAGES = ("tracker", "server")
VAGUE_NAMES = {"utils", "util", "helpers", "helper", "common", "manager", "data", "info", "misc"}
CODE = (".py", ".ts", ".tsx")


def files_in_git() -> list[Path]:
    """Files that are tracked or about to be, relative to the top, if they exist."""
    listed = subprocess.run(
        # The checkout may belong to another user, as in a container.
        ["git", "-c", "safe.directory=*", "ls-files", "-z", "--cached", "--others", "--exclude-standard"],
        cwd=ROOT,
        check=True,
        capture_output=True,
        text=True,
    )
    return [Path(name) for name in listed.stdout.split("\0") if name and (ROOT / name).exists()]


def odd_at_the_top(files: Iterable[Path]) -> set[str]:
    top = {file.parts[0] for file in files}
    return {name for name in top - TOP if not name.startswith(".") and not name.startswith("requirements")}


def vaguely_named(files: Iterable[Path]) -> list[Path]:
    return [file for file in files if VAGUE_NAMES & {part.lower() for part in (*file.parts[:-1], file.stem)}]


def of_one_test_name(files: Iterable[Path]) -> list[Path]:
    """Test files with equal names: pytest imports them by name and collects only one of the two."""
    tests = [file for file in files if file.name.startswith("test_") and file.suffix == ".py"]
    named = Counter(file.name for file in tests)
    return [file for file in tests if named[file.name] > 1]


def undocumented_packages(top: Path) -> list[str]:
    """Python folders whose __init__.py is missing or has no docstring."""
    silent = []
    for folder in sorted({file.parent for file in top.rglob("*.py")}):
        door = folder / "__init__.py"
        if not door.exists() or not ast.get_docstring(ast.parse(door.read_text(encoding="utf-8"))):
            silent.append(str(folder))
    return silent


def test_at_the_top_lies_only_what_was_agreed() -> None:
    files = files_in_git()
    assert odd_at_the_top(files) == set()
    assert {file.parts[0] for file in files} >= TOP


def test_a_stray_file_at_the_top_is_seen() -> None:
    assert odd_at_the_top([Path("setup.cfg"), Path("tracker/a.py"), Path(".gitignore")]) == {"setup.cfg"}


@pytest.mark.parametrize("room", ROOMS)
def test_each_top_folder_has_a_readme_with_its_purpose(room: str) -> None:
    readme = ROOT / room / "README.md"
    assert readme.exists(), f"{room} has no README.md"
    assert readme.read_text(encoding="utf-8").startswith("# ")


@pytest.mark.parametrize("package", PACKAGES)
def test_each_package_has_a_docstring_with_its_purpose(package: str) -> None:
    assert undocumented_packages(ROOT / package) == []


def test_a_package_without_docstring_is_seen(tmp_path: Path) -> None:
    (tmp_path / "told").mkdir()
    (tmp_path / "told" / "__init__.py").write_text('"""Says it."""\n')
    (tmp_path / "mute").mkdir()
    (tmp_path / "mute" / "__init__.py").write_text("import os\n")
    (tmp_path / "bare").mkdir()
    (tmp_path / "bare" / "thing.py").write_text("x = 1\n")
    assert [Path(name).name for name in undocumented_packages(tmp_path)] == ["bare", "mute"]


def test_no_file_has_a_meaningless_name() -> None:
    assert vaguely_named(file for file in files_in_git() if file.suffix in CODE) == []


def test_a_meaningless_name_is_detected() -> None:
    files = [Path("server/utils.py"), Path("tracker/common/edge.py"), Path("tracker/data_rate.py")]
    assert vaguely_named(files) == files[:2]


def test_no_two_test_files_share_a_name() -> None:
    assert of_one_test_name(files_in_git()) == []


def test_test_files_of_one_name_are_seen() -> None:
    files = [Path("tests/a/test_pose.py"), Path("tests/b/test_pose.py"), Path("tests/test_edges.py")]
    assert of_one_test_name(files) == files[:2]
