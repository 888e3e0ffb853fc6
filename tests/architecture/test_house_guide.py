"""The user guide: everything it names exists in the program, and its site has no dead or external links."""

import re
import shlex
import shutil
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from html.parser import HTMLParser
from pathlib import Path
from typing import Any
from urllib.parse import urldefrag, urljoin, urlsplit

import pytest
import typer

from server.cli.commands import app
from server.security.access_rules import SOCKET, rules_of
from server.texts.phrases import ENGLISH

ROOT = Path(__file__).parents[2]
PAGES = sorted((ROOT / "docs" / "guide").glob("*.md"))
WRITTEN = [ROOT / "README.md", *PAGES]
HERE = "https://coaxial.invalid/docs/"
# Server addresses outside of its route table: the page's views and the guide itself.
VIEWS = {"/", "/theatre", "/operator", "/operator/camera", "/supervisor", "/docs/"}
NO_ADDRESS = {"/api/...", "/api"}


def text_of(path: Path) -> str:
    return path.read_text(encoding="utf-8")


def typed(text: str) -> list[list[str]]:
    """Arguments of `coaxial` in code lines and sentences, and in `make run ARGS="..."`."""
    code = "\n".join(re.findall(r"```sh\n(.*?)```", text, re.DOTALL)).replace("\\\n", " ")
    lines = re.findall(r"^(?:\.venv/bin/)?coaxial (.+)", code, re.MULTILINE)
    lines += re.findall(r"`coaxial ([^`]+)`", text)
    run = re.findall(r'make run ARGS="([^"]+)"', text)
    return [shlex.split(line, comments=True) for line in lines] + [["run", *shlex.split(one)] for one in run]


def fault_of(words: list[str]) -> str:
    """Unknown parts of a command; empty if all exist."""
    command: Any = typer.main.get_command(app)
    while hasattr(command, "commands"):
        if not words or words[0] not in command.commands:
            return f"there is no command {' '.join(words)}"
        command, words = command.commands[words[0]], words[1:]
    options = {name for one in command.params for name in (*one.opts, *one.secondary_opts)} | {"--help"}
    unknown = [word for word in words if word.startswith("--") and word not in options]
    return f"{command.name} has no option {unknown[0]}" if unknown else ""


def addresses(text: str) -> set[tuple[str, str]]:
    """Methods and paths of the server that the text names."""
    named = set(re.findall(r"\b(GET|POST|PUT|PATCH|DELETE) (/[a-z][^\s`\"')]*)", text))
    requested = {
        (method or "GET", path)
        for method, path in re.findall(r"curl (?:-s )?(?:-X (\w+) )?127\.0\.0\.1:8000(/\S+)", text)
    }
    sockets = {(SOCKET, path) for path in re.findall(r"`WS (/[a-z/]+)", text)}
    return {(method, path) for method, path in named | requested | sockets if path not in NO_ADDRESS}


class Links(HTMLParser):
    """Links, resources and ids of a page."""

    def __init__(self, page: str) -> None:
        super().__init__()
        self.leads: list[str] = []
        self.loads: list[str] = []
        self.ids: set[str] = set()
        self.feed(page)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        given = {name: value for name, value in attrs if value is not None}
        self.ids |= {given[name] for name in ("id", "name") if name in given}
        if tag == "a" and "href" in given:
            self.leads.append(given["href"])
        elif "src" in given or (tag == "link" and "href" in given):
            self.loads.append(given.get("src", given.get("href", "")))


def dead_links(site: Path) -> list[str]:
    """Links of a built site to missing pages, files or anchors."""
    pages = {
        page.relative_to(site).as_posix().removesuffix("index.html"): Links(text_of(page))
        for page in site.rglob("*.html")
        if page.name != "404.html"
    }
    dead = []
    for address, page in pages.items():
        for link in (*page.leads, *page.loads):
            target, part = urldefrag(urljoin(HERE + address, link))
            if not target.startswith(HERE):
                continue
            path = urlsplit(target).path.removeprefix("/docs/")
            to = pages.get(path)
            if (to is None and not (site / path).is_file()) or (
                part and to is not None and part not in to.ids
            ):
                dead.append(f"{address}: {link}")
    return dead


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The guide as `make docs` builds it."""
    folder = tmp_path_factory.mktemp("docs")
    shutil.copytree(ROOT / "docs" / "guide", folder / "guide")
    shutil.copy(ROOT / "docs" / "zensical.toml", folder)
    subprocess.run(
        [sys.executable, "-m", "zensical", "build", "--strict", "--config-file", "zensical.toml"],
        cwd=folder,
        check=True,
        capture_output=True,
    )
    return folder / "site"


@pytest.mark.parametrize("document", WRITTEN, ids=lambda path: path.name)
def test_every_command_exists_with_its_options(document: Path) -> None:
    assert [fault for words in typed(text_of(document)) if (fault := fault_of(words))] == []


@pytest.mark.parametrize("document", WRITTEN, ids=lambda path: path.name)
def test_every_address_exists(document: Path) -> None:
    requested = addresses(text_of(document))
    assert {one for one in requested if not rules_of(*one)[0] and one[1] not in VIEWS} == set()


def test_a_command_and_an_address_that_do_not_exist_are_seen() -> None:
    text = (
        "```sh\n.venv/bin/coaxial brew --strong\n.venv/bin/coaxial run --strong # --weak\n```\n`GET /api/tea`"
    )
    assert [fault_of(words) for words in typed(text)] == [
        "there is no command brew --strong",
        "run has no option --strong",
    ]
    assert [one for one in addresses(text) if not rules_of(*one)[0]] == [("GET", "/api/tea")]


def test_every_alarm_is_explained_by_its_title() -> None:
    rows = re.findall(
        r"^\| ([A-Z -]+) \| (?:high|medium|low) ", text_of(ROOT / "docs/guide/alarms.md"), re.MULTILINE
    )
    titles = {phrases.title for phrases in ENGLISH.values()}
    assert set(rows) == titles, (
        f"rows of docs/guide/alarms.md without or beside an alarm: {set(rows) ^ titles}"
    )
    assert len(rows) == len(titles), "an alarm has two rows in docs/guide/alarms.md"


def test_every_page_is_in_the_navigation() -> None:
    settings = tomllib.loads(text_of(ROOT / "docs" / "zensical.toml"))

    def pages_of(entries: list[Any]) -> Iterator[str]:
        for entry in entries:
            for value in entry.values():
                yield from [value] if isinstance(value, str) else pages_of(value)

    assert sorted(pages_of(settings["project"]["nav"])) == [page.name for page in PAGES]


def test_the_site_has_no_dead_link(site: Path) -> None:
    assert len(list(site.rglob("*.html"))) > len(PAGES)
    assert dead_links(site) == []


def test_the_help_of_every_page_leads_to_a_place_of_the_site(site: Path) -> None:
    table = text_of(ROOT / "web" / "src" / "help" / "guide.ts")
    places = dict(re.findall(r'^  (\w+): "(.*)",$', table, re.MULTILINE))
    assert {"signIn", "camera", "theatre", "supervisor"} <= set(places)
    links = "".join(f"<a href='./{place}'></a>" for place in places.values())
    (site / "help.html").write_text(links, encoding="utf-8")
    dead = [link for link in dead_links(site) if link.startswith("help.html: ")]
    (site / "help.html").unlink()
    assert dead == []


def test_the_site_loads_nothing_from_elsewhere(site: Path) -> None:
    loaded = {link for page in site.rglob("*.html") for link in Links(text_of(page)).loads}
    assert loaded
    assert {link for link in loaded if "//" in link} == set()


def test_dead_links_are_seen(tmp_path: Path) -> None:
    (tmp_path / "a").mkdir()
    (tmp_path / "a" / "index.html").write_text("<h1 id=there></h1>")
    (tmp_path / "index.html").write_text(
        "<a href='a/'></a><a href='a/#there'></a><a href='a/#gone'></a><a href='b/'></a><a href='/api'></a>"
    )
    assert dead_links(tmp_path) == [": a/#gone", ": b/"]
