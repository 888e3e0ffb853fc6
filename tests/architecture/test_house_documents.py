"""The documents: everything they name exists, and the first screen contains what a newcomer needs."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
READMES = [
    ROOT / room / "README.md" for room in ("tracker", "server", "web", "tests", "docs", "tests/benchmarks")
]
DOCUMENTS = sorted([*ROOT.glob("*.md"), *READMES, *(ROOT / "docs" / "guide").glob("*.md")])
OF_TODAY = [document for document in DOCUMENTS if document.name != "CHANGELOG.md"]
SOURCES = [
    str(path.relative_to(ROOT))
    for top in ("tracker", "server", "tests", "web/src")
    for path in (ROOT / top).rglob("*")
    if path.suffix in {".py", ".ts", ".tsx"}
]
FIRST_SCREEN = 30  # lines
MAX_PICTURE_BYTES = 300_000
MAX_LINES_OF_ARCHITECTURE = 150


def text_of(path: Path) -> str:
    return path.read_text(encoding="utf-8")


def targets(makefile: str) -> set[str]:
    return set(re.findall(r"^([a-z][a-z-]*):", makefile, re.MULTILINE))


def links(text: str) -> list[str]:
    """Targets of the document's links to project files; those that begin with / belong to the server."""
    found = re.findall(r"\]\(([^)\s]+)\)", text)
    return [link.split("#")[0] for link in found if "://" not in link and not link.startswith(("#", "/"))]


def files_named(text: str) -> list[str]:
    """Project files that the document names by their full path, with `{en,de}` expanded."""
    named = re.findall(r"`((?:tracker|server|web|tests|docs)/[\w/.{},-]+\.\w+)`", text)
    lists = [re.split(r"[{}]", name) for name in named]
    return [
        "".join((parts[0], choice, *parts[2:]))
        for parts in lists
        for choice in (parts[1].split(",") if len(parts) > 1 else [""])
    ]


def sources_named(text: str) -> set[str]:
    """Sources that the document names by the end of their path: `steps.py`, `procedure/steps.py`."""
    return set(re.findall(r"`([\w/.]+\.(?:py|tsx?))`", text))


def is_source(name: str, sources: list[str]) -> bool:
    """Whether a path ends in this name."""
    return any(source == name or source.endswith(f"/{name}") for source in sources)


def headings(text: str) -> set[str]:
    """Anchors of the document's headings."""
    named = re.findall(r"^#+ (.+)$", text, re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in named}


def commands(text: str) -> set[str]:
    """Make targets in code lines or sentences of the document."""
    return set(re.findall(r"(?:^|`)make ([a-z][a-z-]*)", text, re.MULTILINE))


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda path: str(path.relative_to(ROOT)))
def test_every_link_leads_to_a_file(document: Path) -> None:
    assert [link for link in links(text_of(document)) if not (document.parent / link).exists()] == []


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda path: str(path.relative_to(ROOT)))
def test_every_link_to_a_part_leads_to_its_heading(document: Path) -> None:
    parts = re.findall(r"\]\(([^)\s#:]*\.md)?#([^)\s]+)\)", text_of(document))
    dead = [
        part
        for file, part in parts
        if part not in headings(text_of(document.parent / file if file else document))
    ]
    assert dead == []


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda path: str(path.relative_to(ROOT)))
def test_every_command_can_be_made(document: Path) -> None:
    assert commands(text_of(document)) - targets(text_of(ROOT / "Makefile")) == set()


@pytest.mark.parametrize("document", OF_TODAY, ids=lambda path: str(path.relative_to(ROOT)))
def test_every_file_that_is_named_exists(document: Path) -> None:
    assert [file for file in files_named(text_of(document)) if not (ROOT / file).exists()] == []


def test_a_dead_link_and_a_dead_command_are_seen() -> None:
    text = (
        "[there](nowhere.md#part), [out](https://example.org)\n```sh\nmake coffee   # now\n```\nor `make tea`"
    )
    assert links(text) == ["nowhere.md"]
    assert commands(text) == {"coffee", "tea"}
    assert files_named("`web/{en,de}.ts` `server/a.py`") == ["web/en.ts", "web/de.ts", "server/a.py"]
    assert headings("# Cases, and settings\n## `/ws/view`\n") == {"cases-and-settings", "wsview"}


def test_the_first_screen_has_what_a_newcomer_must_know() -> None:
    screen = "\n".join(text_of(ROOT / "README.md").splitlines()[:FIRST_SCREEN])
    assert "Research software, not a medical device" in screen
    assert "](web/dashboard.png)" in screen
    assert {"run", "test"} <= commands(screen)


def test_the_architecture_is_read_in_one_sitting() -> None:
    assert len(text_of(ROOT / "ARCHITECTURE.md").splitlines()) <= MAX_LINES_OF_ARCHITECTURE


def test_the_picture_is_small() -> None:
    assert (ROOT / "web" / "dashboard.png").stat().st_size < MAX_PICTURE_BYTES


def test_help_lists_every_target_that_the_documents_name() -> None:
    makefile = text_of(ROOT / "Makefile")
    helped = set(re.findall(r"^([a-z][a-z-]*):.*## ", makefile, re.MULTILINE))
    assert set().union(*(commands(text_of(document)) for document in DOCUMENTS)) <= helped


def test_the_licence_is_the_one_that_is_promised() -> None:
    licence = text_of(ROOT / "LICENSE")
    assert licence.split("\n", 2)[1].strip() == "Apache License"
    assert "END OF TERMS AND CONDITIONS" in licence
    assert 'license = "Apache-2.0"' in text_of(ROOT / "pyproject.toml")


def test_the_gate_calls_what_a_person_calls() -> None:
    gate = text_of(ROOT / ".ci" / "run")
    assert gate.splitlines()[-1].startswith("exec make test")
    assert "\nset -euo pipefail\n" in gate
    assert (ROOT / ".ci" / "run").stat().st_mode & 0o111


@pytest.mark.parametrize("document", OF_TODAY, ids=lambda path: str(path.relative_to(ROOT)))
def test_every_source_that_is_named_exists(document: Path) -> None:
    assert [name for name in sorted(sources_named(text_of(document))) if not is_source(name, SOURCES)] == []


def test_a_source_that_was_renamed_is_found() -> None:
    named = sources_named("`service.py`, `alarms/service.py`, `gone.py`, `web/src/App.tsx` and `make test`")
    assert named == {"service.py", "alarms/service.py", "gone.py", "web/src/App.tsx"}
    sources = ["server/alarms/service.py", "web/src/App.tsx"]
    assert [name for name in sorted(named) if not is_source(name, sources)] == ["gone.py"]
