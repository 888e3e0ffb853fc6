"""The installation steps: their messages on a machine where something is missing."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


@pytest.fixture
def bare_path(tmp_path: Path) -> Path:
    """A folder for PATH with basic shell tools but without Python, Node or a browser."""
    folder = tmp_path / "bin"
    folder.mkdir()
    for name in ("sh", "cat", "tail", "mkdir", "date", "id", "env", "dirname", "rm", "ln", "chmod"):
        found = next(p for p in (Path("/bin") / name, Path("/usr/bin") / name) if p.exists())
        (folder / name).symlink_to(found)
    return folder


def put(folder: Path, name: str, script: str) -> None:
    program = folder / name
    program.write_text(f"#!/bin/sh\n{script}\n")
    program.chmod(0o755)


def step(
    name: str, *arguments: str, path: Path, cwd: Path = ROOT, **environment: str
) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [str(path / "sh"), str(ROOT / ".make" / name), *arguments],
        env={"PATH": str(path), **environment},
        cwd=cwd,
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        check=False,
    )


def test_a_machine_without_python_gets_a_message_with_the_requirement(bare_path: Path) -> None:
    said = step("find-python", path=bare_path)
    assert said.returncode == 1
    assert said.stdout == ""
    assert "needs Python 3.11 or newer, and none was found" in said.stderr
    assert "Traceback" not in said.stderr


def python_of_version(major: int, minor: int) -> str:
    """A script that answers like a Python of this version."""
    pretend = f"import sys; sys.version_info = ({major}, {minor}, 0, 'final', 0); exec(sys.argv[1])"
    return f'exec {sys.executable} -c "{pretend}" "$2"'


@pytest.mark.parametrize(("minor", "taken"), [(9, False), (10, False), (11, True), (14, True)])
def test_a_python_is_taken_from_3_11_on(bare_path: Path, minor: int, *, taken: bool) -> None:
    put(bare_path, "python3", python_of_version(3, minor))
    said = step("find-python", path=bare_path)
    assert (said.returncode == 0) is taken
    assert (f"is 3.{minor}." in said.stderr and "PYTHON=" in said.stderr) is not taken


def test_a_python_without_venv_gets_a_message_with_the_package(bare_path: Path) -> None:
    real = sys.executable
    put(bare_path, "python3.12", f'case "$2" in *ensurepip*) exit 1;; *) exec {real} "$@";; esac')
    said = step("find-python", path=bare_path)
    assert said.returncode == 1
    assert f"python{sys.version_info[0]}.{sys.version_info[1]}-venv" in said.stderr


def test_a_launcher_that_starts_nothing_is_passed_over(bare_path: Path) -> None:
    put(bare_path, "python3.13", "echo no such version >&2; exit 127")
    put(bare_path, "python3", f'exec {sys.executable} "$@"')
    said = step("find-python", path=bare_path)
    assert said.returncode == 0
    assert Path(said.stdout.strip()).exists()


def test_a_python_that_was_named_is_the_one_that_is_taken(bare_path: Path) -> None:
    put(bare_path, "python3", "exit 1")
    said = step("find-python", path=bare_path, PYTHON=sys.executable)
    assert said.stdout.strip() == sys.executable


def test_a_machine_without_browser_gets_a_message_how_to_name_one(bare_path: Path) -> None:
    said = step("find-chromium", path=bare_path)
    assert said.returncode == 1
    assert "COAXIAL_CHROMIUM=" in said.stderr


def test_a_browser_that_was_named_wrongly_is_not_replaced_silently(bare_path: Path) -> None:
    put(bare_path, "chromium", "exit 0")
    said = step("find-chromium", path=bare_path, COAXIAL_CHROMIUM="/no/such/chromium")
    assert said.returncode == 1
    assert "/no/such/chromium" in said.stderr


def test_a_browser_on_the_path_is_found(bare_path: Path) -> None:
    put(bare_path, "chromium", "exit 0")
    assert step("find-chromium", path=bare_path).stdout.strip() == str(bare_path / "chromium")
    put(bare_path, "chromium-headless-shell", "exit 0")
    assert step("find-chromium", path=bare_path).stdout.strip() == str(bare_path / "chromium-headless-shell")


def test_programs_for_dicom_are_taken_from_the_path_or_said_to_be_missing(bare_path: Path) -> None:
    assert "dcmtk and orthanc" in step("find-dicom-tools", path=bare_path).stderr
    for program in ("dsrdump", "Orthanc"):
        put(bare_path, program, "exit 0")
    said = step("find-dicom-tools", path=bare_path)
    assert (said.returncode, said.stderr) == (0, "")


@pytest.mark.parametrize(
    ("version", "taken"),
    [
        ("20.20.2", False),
        ("22.17.1", False),
        ("22.18.0", True),
        ("24.0.0", True),
        ("26.1.0", True),
    ],
)
def test_the_machine_s_node_is_taken_only_if_it_can_build_the_page(
    bare_path: Path, tmp_path: Path, version: str, *, taken: bool
) -> None:
    put(bare_path, "node", f"echo v{version}")
    put(bare_path, "npm", "echo 11")
    said = step("with-node", ".", "cat", "/dev/null", path=bare_path, cwd=tmp_path)
    # Without the machine's node it uses the environment, which this folder does not have.
    assert (said.returncode == 0) is taken
    assert (".venv/bin/python" in said.stderr) is not taken


def test_a_machine_without_a_builder_of_images_gets_a_message_what_to_install(bare_path: Path) -> None:
    said = step("image", path=bare_path)
    assert said.returncode == 1
    assert "buildah" in said.stderr


def test_a_docker_without_its_daemon_is_no_builder(bare_path: Path) -> None:
    put(bare_path, "docker", "exit 1")
    said = step("image", path=bare_path)
    assert said.returncode == 1
    assert "reaches no daemon" in said.stderr


@pytest.mark.parametrize(
    ("found", "taken"),
    [(["docker"], "docker build"), (["docker", "podman"], "podman build --format docker")],
    ids=["docker-alone", "podman-first"],
)
def test_the_builder_that_needs_no_root_builds_the_image(
    bare_path: Path, found: list[str], taken: str
) -> None:
    for name in found:
        put(bare_path, name, f'[ "$1" = info ] || echo "{name} $*"')
    assert step("image", path=bare_path).stdout == f"{taken} --tag coaxial .\n"


def test_a_successful_step_prints_one_line(bare_path: Path, tmp_path: Path) -> None:
    put(bare_path, "chatter", "echo much; echo more >&2")
    said = step("step", "talk", "Talking", "Be quiet.", "chatter", path=bare_path, cwd=tmp_path)
    assert (said.returncode, said.stdout, said.stderr) == (0, "Talking ...\n", "")


def test_a_failed_step_prints_reason_and_remedy(bare_path: Path, tmp_path: Path) -> None:
    put(bare_path, "broken", "echo the cable is out >&2; exit 7")
    said = step("step", "plug", "Plugging in", "Look at the cable.", "broken", path=bare_path, cwd=tmp_path)
    assert said.returncode == 1
    assert "the cable is out" in said.stderr
    assert "Failed: Plugging in. Look at the cable." in said.stderr


@pytest.mark.parametrize(
    ("suite", "passes"),
    [
        pytest.param('<testsuite tests="3" skipped="3"/>', False, id="all-skipped"),
        pytest.param('<testsuite tests="0" skipped="0"/>', False, id="none"),
        pytest.param('<testsuite tests="3" skipped="2"/>', True, id="one-ran"),
    ],
)
def test_a_run_that_executed_nothing_is_no_pass(tmp_path: Path, suite: str, *, passes: bool) -> None:
    report = tmp_path / "report.xml"
    report.write_text(f"<testsuites>{suite}</testsuites>")
    judged = subprocess.run(
        [sys.executable, str(ROOT / ".make" / "some-test-passed"), str(report)],
        check=False,
        capture_output=True,
    )
    assert (judged.returncode == 0) is passes


def test_cleaning_keeps_the_cases_and_states_it(tmp_path: Path) -> None:
    shutil.copy(ROOT / "Makefile", tmp_path)
    for made in ("tracker", "server", "tests", ".venv", ".coaxial/cases/1"):
        (tmp_path / made).mkdir(parents=True)
    said = subprocess.run(["make", "clean"], cwd=tmp_path, check=True, capture_output=True, text=True).stdout
    assert not (tmp_path / ".venv").exists()
    assert (tmp_path / ".coaxial" / "cases" / "1").exists()
    assert "Kept: .coaxial" in said


STEPS_THAT_PASS = ("place", "packages", "project", "page-packages", "page", "dev")


def stands_ready(folder: Path, fails: str) -> None:
    """A checkout with everything installed and nothing compiled; calls are recorded, or fail."""
    shutil.copy(ROOT / "Makefile", folder)
    for made in ("tracker", "web/src", ".make", ".venv/bin", ".venv/stamps"):
        (folder / made).mkdir(parents=True)
    for lock in ("", "-build", "-installer", "-dev", "-node"):
        (folder / f"requirements{lock}.lock").touch()
    for file in ("pyproject.toml", "web/package-lock.json"):
        (folder / file).touch()
    called = f'echo "${{0##*/}} $*" >>{folder}/called; case "${{0##*/}} $*" in *"{fails}"*) exit 1;; esac'
    for program in ("python", "lint-imports", "pyrefly"):
        put(folder / ".venv" / "bin", program, called)
    put(folder / ".make", "step", 'shift 3; exec "$@"')
    for program in ("with-node", "find-chromium", "find-dicom-tools", "run-tests"):
        put(folder / ".make", program, called)
    for name in STEPS_THAT_PASS:
        (folder / ".venv" / "stamps" / name).write_text(f"{folder.resolve()}\n")


@pytest.mark.parametrize(
    "fails",
    [
        "server.loop.compiling",
        "ruff check",
        "lint-imports",
        "pyrefly",
        "--silent test",
        "run-tests",
        "nothing",
    ],
)
def test_the_gate_fails_with_any_of_its_parts_and_tests_only_what_was_compiled_and_checked(
    tmp_path: Path, fails: str
) -> None:
    stands_ready(tmp_path, fails)
    said = subprocess.run(["make", "test"], cwd=tmp_path, check=False, capture_output=True, text=True)
    called = (tmp_path / "called").read_text()
    assert (said.returncode == 0) is (fails == "nothing"), said.stderr
    assert "server.loop.compiling" in called
    assert ("run-tests" in called) is (fails in {"run-tests", "nothing"})
    if "run-tests" in called:
        assert called.index("run-tests") > max(
            called.index("server.loop.compiling"), called.index("--silent test")
        )


def test_what_python_compiles_is_kept_whatever_the_shell_around_has_set(tmp_path: Path) -> None:
    stands_ready(tmp_path, "nothing")
    put(tmp_path / ".make", "run-tests", f'echo "${{PYTHONDONTWRITEBYTECODE-kept}}" >{tmp_path}/told')
    around = {**os.environ, "PYTHONDONTWRITEBYTECODE": "1"}
    subprocess.run(["make", "test"], cwd=tmp_path, env=around, check=True, capture_output=True)
    assert (tmp_path / "told").read_text() == "kept\n"
