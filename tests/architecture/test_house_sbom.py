"""The bill of materials contains each locked package, and the table of SOUP each direct dependency."""

import base64
import json
import os
import re
import subprocess
import sys
import tomllib
import uuid
from collections.abc import Iterator
from importlib import resources
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

import jsonschema_rs
import pytest

from tests.house.traced import guide_rows

ROOT = Path(__file__).parents[2]
SCHEMAS = "http://cyclonedx.org/schema/"
# Only builds the page, but part of what it writes runs there.
GENERATORS = {"@hey-api/openapi-ts"}
NPM_SBOM = [
    "sh",
    ".make/with-node",
    "web",
    "npm",
    "sbom",
    "--sbom-format",
    "cyclonedx",
    "--package-lock-only",
]


@pytest.fixture(scope="module")
def bill(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    folder = tmp_path_factory.mktemp("sbom")
    of_page = subprocess.run(NPM_SBOM, cwd=ROOT, check=True, capture_output=True, text=True)
    (folder / "page.json").write_text(of_page.stdout)
    command = [sys.executable, ".make/sbom.py", str(folder / "page.json"), str(folder / "bill.json")]
    around = {**os.environ, "SOURCE_DATE_EPOCH": "1790000000"}
    subprocess.run(command, cwd=ROOT, env=around, check=True, capture_output=True)
    made: dict[str, Any] = json.loads((folder / "bill.json").read_text(encoding="utf-8"))
    return made


def components(bill: dict[str, Any], ecosystem: str) -> dict[str, dict[str, Any]]:
    """Components of this ecosystem by name and version."""
    return {
        f"{one['name']} {one['version']}": one
        for one in bill["components"]
        if one["purl"].startswith(f"pkg:{ecosystem}/") and one["name"] != "coaxial-page"
    }


def hashes(component: dict[str, Any]) -> set[str]:
    return {one["content"] for one in component["hashes"]}


def packages_of_python() -> Iterator[tuple[str, str, set[str]]]:
    """Name, version and hashes of each package of requirements.lock."""
    lock = (ROOT / "requirements.lock").read_text(encoding="utf-8")
    for name, number, rest in re.findall(r"^([a-z0-9.-]+)==(\S+)((?:.*\\\n)+.*)$", lock, re.MULTILINE):
        yield name, number, set(re.findall(r"sha256:(\w{64})", rest))


def packages_of_page() -> Iterator[tuple[str, dict[str, Any]]]:
    """Name and entry of each package of package-lock.json that is not only for development."""
    lock = json.loads((ROOT / "web/package-lock.json").read_text(encoding="utf-8"))
    for path, entry in lock["packages"].items():
        if path and not entry.get("dev"):
            yield path.rpartition("node_modules/")[2], entry


def is_installed(name: str, number: str) -> bool:
    try:
        return version(name) == number
    except PackageNotFoundError:
        return False


def test_it_has_each_python_package_of_the_lock_and_no_other(bill: dict[str, Any]) -> None:
    packages = list(packages_of_python())
    stated = components(bill, "pypi")
    assert {f"{name} {number}" for name, number, _ in packages} == stated.keys()
    for name, number, locked in packages:
        component = stated[f"{name} {number}"]
        assert hashes(component) == locked
        # A package that this system does not need is locked but not installed, so its licence is unknown.
        assert component.get("licenses") or not is_installed(name, number), f"{name} has no licence"


def test_it_has_each_package_of_the_page_and_no_other(bill: dict[str, Any]) -> None:
    packages = dict(packages_of_page())
    stated = components(bill, "npm")
    assert {f"{name} {entry['version']}" for name, entry in packages.items()} == stated.keys()
    for name, entry in packages.items():
        component = stated[f"{name} {entry['version']}"]
        assert hashes(component) == {base64.b64decode(entry["integrity"].partition("-")[2]).hex()}
        (licence,) = component["licenses"]
        assert entry["license"] in {licence.get("expression"), licence.get("license", {}).get("id")}


def test_it_names_what_depends_on_what_directly(bill: dict[str, Any]) -> None:
    depends = {one["ref"]: set(one.get("dependsOn", ())) for one in bill["dependencies"]}
    (page,) = (one["bom-ref"] for one in bill["components"] if one["name"] == "coaxial-page")
    assert bill["metadata"]["component"]["name"] == "coaxial"
    assert any(ref.startswith("pkg:pypi/numpy@") for ref in depends["coaxial"])
    assert page in depends["coaxial"]
    assert any(ref.startswith("react@") for ref in depends[page])


def test_it_follows_the_schema_of_cyclonedx(bill: dict[str, Any]) -> None:
    folder = resources.files("cyclonedx.schema") / "_res"
    # The last entry refers to the first two by their file names.
    names = [f"{name}.SNAPSHOT.schema.json" for name in ("spdx", "jsf-0.82", "bom-1.6")]
    schemas = [json.loads((folder / name).read_text(encoding="utf-8")) for name in names]
    registry = jsonschema_rs.Registry(
        [(SCHEMAS + name, schema) for name, schema in zip(names, schemas, strict=True)]
    )
    jsonschema_rs.validator_for(schemas[-1], registry=registry).validate(bill)


def test_its_time_and_number_follow_from_its_sources(bill: dict[str, Any]) -> None:
    assert bill["metadata"]["timestamp"] == "2026-09-21T14:13:20+00:00"
    # A random number would be of version 4.
    assert uuid.UUID(bill["serialNumber"]).version == 5


def test_it_states_the_version_of_the_project_for_the_page_too(bill: dict[str, Any]) -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    (page,) = (one for one in bill["components"] if one["name"] == "coaxial-page")
    assert (bill["metadata"]["component"]["version"], page["version"]) == (project["version"],) * 2
    assert page["purl"] == f"pkg:npm/coaxial-page@{project['version']}"


def test_it_names_no_registry_and_no_folder(bill: dict[str, Any]) -> None:
    text = json.dumps(bill)
    assert str(ROOT) not in text
    assert set(re.findall(r"\w+://[^/\"]+", text)) <= {"http://cyclonedx.org"}


def rows_of_soup() -> dict[str, list[str]]:
    """Cells of each table row in the guide, by package."""
    return {package: cells for package, *cells in guide_rows("soup", column="package")}


def direct_dependencies() -> set[str]:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    page = json.loads((ROOT / "web/package.json").read_text(encoding="utf-8"))
    python: list[str] = sum(project["optional-dependencies"].values(), project["dependencies"])
    names: set[str] = {re.split(r"[<>=;\[ ]", one)[0].lower() for one in python} | page["dependencies"].keys()
    return names | GENERATORS


def test_each_direct_dependency_has_a_row_with_reason_licence_risk_and_evidence() -> None:
    rows = rows_of_soup()
    assert rows.keys() == direct_dependencies()
    for name, cells in rows.items():
        assert len(cells) == 4, name
        assert all(cells), name
        assert re.search(r"`tests/[\w/]+\.py`", cells[3]), f"{name} names no test"


def test_the_licence_in_a_row_is_the_one_of_the_package(bill: dict[str, Any]) -> None:
    rows = rows_of_soup()
    stated = {}
    for component in bill["components"]:
        for licence in component.get("licenses", ()):
            named = licence.get("license", {})
            stated[component["name"]] = licence.get("expression") or named.get("id") or named.get("name")
    assert {name: cells[1] for name, cells in rows.items() if name in stated} == {
        name: licence for name, licence in stated.items() if name in rows
    }
    assert rows.keys() - stated.keys() == {
        "pypylon",
        "harvesters",
        "av",
        "pyarrow",
        "distributed",
        *GENERATORS,
    }
