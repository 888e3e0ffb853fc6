"""The Dockerfile: properties that can be checked without an engine."""

import json
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


def instructions(text: str) -> list[tuple[str, str]]:
    """Instructions and arguments in order, without comments, with continued lines joined."""
    bare = "\n".join(line for line in text.splitlines() if not line.lstrip().startswith("#"))
    lines = re.sub(r"\\\n\s*", "", bare).splitlines()
    return [(word.upper(), rest.strip()) for word, _, rest in (line.partition(" ") for line in lines if line)]


@pytest.fixture(scope="module")
def all_stages() -> list[tuple[str, str]]:
    return instructions((ROOT / "Dockerfile").read_text(encoding="utf-8"))


@pytest.fixture(scope="module")
def last_stage(all_stages: list[tuple[str, str]]) -> list[tuple[str, str]]:
    starts = [n for n, (word, _) in enumerate(all_stages) if word == "FROM"]
    return all_stages[starts[-1] :]


def test_it_runs_as_a_numbered_user_who_is_not_root(last_stage: list[tuple[str, str]]) -> None:
    users = [rest for word, rest in last_stage if word == "USER"]
    # A number, because an orchestrator that forbids root cannot resolve a name.
    assert users
    assert int(users[-1]) > 0


def test_nothing_is_done_as_root_after_the_user_is_set(last_stage: list[tuple[str, str]]) -> None:
    assert [word for word, _ in last_stage].count("USER") == 1


def test_its_health_is_asked_without_another_program(last_stage: list[tuple[str, str]]) -> None:
    check = next(rest for word, rest in last_stage if word == "HEALTHCHECK")
    command = json.loads(check[check.index("[") :])
    assert command[:2] == ["python", "-c"]
    compile(command[2], "HEALTHCHECK", "exec")
    assert "/health" in command[2]
    assert "timeout=" in command[2]


def test_state_lies_on_a_volume(last_stage: list[tuple[str, str]]) -> None:
    home = next(
        match[1]
        for word, rest in last_stage
        if word == "ENV" and (match := re.search(r"COAXIAL_HOME=(\S+)", rest))
    )
    assert ("VOLUME", home) in last_stage
    assert ("EXPOSE", "8000") in last_stage


def test_packages_from_outside_come_with_hashes(all_stages: list[tuple[str, str]]) -> None:
    commands = [c for word, rest in all_stages if word == "RUN" for c in rest.split("&&")]
    installs = [command for command in commands if "pip" in command and " install " in command]
    assert installs
    assert [c for c in installs if "--require-hashes" not in c and "--no-index" not in c] == []
    assert [c for c in commands if re.search(r"npm (install|i)\b|curl|wget", c)] == []


def test_it_starts_the_server_and_nothing_else(last_stage: list[tuple[str, str]]) -> None:
    assert ("ENTRYPOINT", '["coaxial"]') in last_stage
    assert ("CMD", '["run"]') in last_stage


def test_each_base_is_pinned_to_a_release(all_stages: list[tuple[str, str]]) -> None:
    bases = [rest.split()[0] for word, rest in all_stages if word == "FROM"]
    assert [base for base in bases if not re.search(r":\d", base)] == []


def test_what_is_copied_in_reaches_the_builder(all_stages: list[tuple[str, str]]) -> None:
    ignored = (ROOT / ".dockerignore").read_text(encoding="utf-8").splitlines()
    let_through = {line[1:] for line in ignored if line.startswith("!")}
    assert "*" in ignored
    sources = {
        source.split("/")[0]
        for word, rest in all_stages
        if word == "COPY" and not rest.startswith("--from")
        for source in rest.split()[:-1]
    }
    assert sources <= let_through
    assert [source for source in sources if not (ROOT / source).exists()] == []
