"""The test run: each file runs once, and a failure of any part fails the run."""

import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
ALONE = "tests/browser/test_first_minute.py"
FILES = (
    "tests/tracker/test_scenes.py",
    "tests/tracker/pose/test_pose.py",
    "tests/server/test_page_in_browser.py",
    "tests/browser/test_dashboard.py",
)
# Records the arguments of each pytest run, and fails for files that contain failing tests.
PYTHON = """#!/bin/sh
echo "$*" >>called
case "$*" in *"$FAILS"*) exit "$WITH";; esac
"""


def run(folder: Path, *narrowed: str, fails: str = "nothing", code: int = 1) -> tuple[int, list[str]]:
    """Exit code of the run, and the arguments of each part."""
    for file in FILES:
        (folder / file).parent.mkdir(parents=True, exist_ok=True)
        (folder / file).touch()
    (folder / ".venv" / "log").mkdir(parents=True)
    python = folder / "python"
    python.write_text(PYTHON)
    python.chmod(0o755)
    (folder / ".make").mkdir()
    (folder / ".make" / "test-lowest").write_text("exec ./python lowest versions\n")
    ended = subprocess.run(
        ["sh", str(ROOT / ".make" / "run-tests"), "./python", "4", *narrowed],
        cwd=folder,
        env={"PATH": "/usr/bin:/bin", "FAILS": fails, "WITH": str(code)},
        check=False,
        capture_output=True,
    )
    return ended.returncode, (folder / "called").read_text().splitlines()


def test_each_file_of_tests_is_run_once(tmp_path: Path) -> None:
    code, called = run(tmp_path)
    assert code == 0
    *others, alone, judged = called
    # The parts in the background come at any time.
    others.remove("lowest versions")
    (tracker,) = (requested for requested in others if "pytest-tracker.xml" in requested)
    others.remove(tracker)
    browser, first, ageless = others
    in_parallel = {word for word in ageless.split() if word.endswith(".py")}
    assert all((ROOT / file).is_file() for file in in_parallel)
    assert in_parallel | {ALONE} == {
        word.removeprefix("--ignore=") for word in browser.split() if "--ignore=" in word
    }
    # The part without a browser runs everything except its exclusions.
    assert "-m not browser" in first
    left_out = {word.removeprefix("--ignore=") for word in first.split() if word.startswith("--ignore=")}
    assert left_out == {"tests/tracker"} == {tracker.split()[-1]}
    assert {"tests/browser", FILES[2]} <= set(browser.split())
    # The exclusions run last, on their own.
    assert f"--ignore={ALONE}" in browser.split()
    assert alone.split()[-1] == ALONE
    assert (ROOT / ALONE).is_file()
    assert judged.startswith(".make/some-test-passed .venv/log/pytest")


@pytest.mark.parametrize(
    "fails",
    [
        "not browser",
        "pytest-tracker.xml",
        "lowest versions",
        "pytest-ageless.xml",
        "pytest-browser.xml",
        "pytest-alone.xml",
        "some-test-passed",
    ],
)
def test_the_run_fails_with_any_of_its_parts(tmp_path: Path, fails: str) -> None:
    code, called = run(tmp_path, fails=fails)
    assert code != 0
    assert len(called) == (7 if fails == "some-test-passed" else 6)


def test_what_is_narrowed_runs_in_two_parts_of_which_one_may_be_empty(tmp_path: Path) -> None:
    code, called = run(tmp_path, "tests/server", fails="-m browser", code=5)
    assert code == 0
    assert ["tests/server" in requested for requested in called] == [True, True, False]
