"""The locks: exact, with hashes, consistent with each other and the requirements, and without addresses."""

import json
import re
import tomllib
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).parents[2]
LOCKS = (
    "requirements.lock",
    "requirements-build.lock",
    "requirements-installer.lock",
    "requirements-lowest.lock",
    "requirements-node.lock",
    "requirements-docs.lock",
    "requirements-dev.lock",
)
PIN = re.compile(r"^([a-z0-9][a-z0-9.-]*)==(\S+)")
PLACE = re.compile(r"://|\bfile:|^-|--(index|find|extra|trusted)|@ |(^|\s)[./~]", re.MULTILINE)


def text_of(lock: str) -> str:
    return (ROOT / lock).read_text(encoding="utf-8")


def entries(text: str) -> list[str]:
    """One entry per package, without comments, with continued lines joined."""
    bare = "\n".join(line for line in text.splitlines() if not line.lstrip().startswith("#"))
    return [line for line in bare.replace("\\\n", " ").splitlines() if line.strip()]


def faults_of(text: str) -> list[str]:
    faults = []
    for entry in entries(text):
        name = entry.split()[0]
        if not PIN.match(entry):
            faults.append(f"{name} is not pinned to one version")
        if not re.search(r"--hash=sha256:[0-9a-f]{64}", entry):
            faults.append(f"{name} has no hash")
        if PLACE.search(re.sub(r"--hash=\S+", "", entry)):
            faults.append(f"{name} names a place")
    return faults


def versions(lock: str) -> dict[str, str]:
    matches = (PIN.match(entry) for entry in entries(text_of(lock)))
    return {match[1]: match[2] for match in matches if match}


def required_packages() -> dict[str, list[str]]:
    """Requirements of pyproject.toml, by the lock that must contain them."""
    project: dict[str, Any] = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    groups = project["dependency-groups"]

    def names(requirements: list[Any]) -> list[str]:
        strings = [r for r in requirements if isinstance(r, str)]
        return [re.split(r"[^A-Za-z0-9._-]", r)[0].lower().replace("_", "-") for r in strings]

    runtime = names(project["project"]["dependencies"])
    return {
        "requirements.lock": runtime,
        "requirements-build.lock": names(groups["build"]),
        "requirements-installer.lock": names(groups["installer"]),
        "requirements-node.lock": names(groups["node"]),
        "requirements-docs.lock": names(groups["docs"]),
        "requirements-lowest.lock": runtime + names(groups["test"]),
        "requirements-dev.lock": runtime
        + names(groups["test"] + groups["build"] + groups["installer"] + groups["docs"] + groups["dev"]),
    }


@pytest.mark.parametrize("lock", LOCKS)
def test_every_package_is_pinned_with_hashes_and_without_a_place(lock: str) -> None:
    assert versions(lock)
    assert faults_of(text_of(lock)) == []


@pytest.mark.parametrize(
    ("line", "fault"),
    [
        pytest.param("numpy>=2 --hash=sha256:" + "a" * 64, "is not pinned", id="a-range"),
        pytest.param("numpy==2.0", "has no hash", id="no-hash"),
        pytest.param("--find-links wheels", "names a place", id="a-folder-of-wheels"),
        pytest.param("-i somewhere", "names a place", id="an-index"),
        pytest.param("a @ file:///x.whl --hash=sha256:" + "a" * 64, "names a place", id="a-local-file"),
    ],
)
def test_what_must_not_be_in_a_lock_is_seen(line: str, fault: str) -> None:
    assert any(fault in reported for reported in faults_of(line))


@pytest.mark.parametrize("lock", LOCKS)
def test_a_lock_holds_what_the_project_asks_for(lock: str) -> None:
    assert set(required_packages()[lock]) <= versions(lock).keys()


@pytest.mark.parametrize(
    "lock",
    [
        "requirements.lock",
        "requirements-build.lock",
        "requirements-installer.lock",
        "requirements-docs.lock",
    ],
)
def test_what_runs_is_what_was_tested(lock: str) -> None:
    tested = versions("requirements-dev.lock")
    assert {name: tested.get(name) for name in versions(lock)} == versions(lock)


def test_the_page_s_lock_has_hashes_and_names_no_registry() -> None:
    lock = json.loads((ROOT / "web" / "package-lock.json").read_text(encoding="utf-8"))
    packages = {name: entry for name, entry in lock["packages"].items() if name}
    assert packages
    assert [name for name, entry in packages.items() if "resolved" in entry] == []
    assert [name for name, entry in packages.items() if "integrity" not in entry] == []


def test_the_lowest_versions_are_those_that_are_declared() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    matches = (
        re.match(r"([\w-]+)[>=]=([\d.]+)", requirement) for requirement in project["project"]["dependencies"]
    )
    declared = {match[1]: match[2] for match in matches if match}
    lowest = versions("requirements-lowest.lock")
    # Another Numba would compile the tracker again.
    assert lowest["numba"] == versions("requirements-dev.lock")["numba"]
    differing = {
        name: (declared[name], lowest[name.lower()])
        for name in declared.keys() - {"numba"}
        if not f"{lowest[name.lower()]}.".startswith(f"{declared[name]}.")
    }
    assert differing == {}


def test_the_audit_reads_every_lock() -> None:
    """Those that it leaves out have no package that the others lack; the lowest versions never run."""
    audit = text_of(".make/audit")
    read = [lock for lock in LOCKS if lock in audit]
    known = {entry.split(";")[0].split()[0] for lock in read for entry in entries(text_of(lock))}
    for lock in set(LOCKS) - {"requirements-lowest.lock"}:
        assert {entry.split(";")[0].split()[0] for entry in entries(text_of(lock))} <= known, lock
    assert "web npm audit" in audit
    # Otherwise it passes without an answer for any package.
    assert "--strict" in audit
