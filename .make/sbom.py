"""Writes the software bill of materials of what runs: CycloneDX 1.6 as JSON.

    sbom.py PAGE OUTPUT

Names, versions, markers and hashes of Python packages are those of requirements.lock. Licences come from
the metadata of the installed packages, where the locked version is installed. PAGE is the output of
`npm sbom` without `--omit dev`, which also omits some packages that the page needs.

With SOURCE_DATE_EPOCH, two runs with the same packages write the same bytes.
"""

import json
import os
import re
import sys
import tomllib
import uuid
from collections.abc import Iterator
from datetime import UTC, datetime
from importlib.metadata import PackageNotFoundError, metadata
from pathlib import Path

from cyclonedx.contrib.license.factories import LicenseFactory
from cyclonedx.model import HashAlgorithm, HashType, Property
from cyclonedx.model.bom import Bom
from cyclonedx.model.component import Component, ComponentType
from cyclonedx.output.json import JsonV1Dot6
from packageurl import PackageURL
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

ROOT = Path(__file__).resolve().parents[1]
SHA256 = re.compile(r"--hash=sha256:([0-9a-f]{64})")
# Classifiers that mean exactly one licence. "BSD License" is none of them.
CLASSIFIED = {"MIT License": "MIT", "Mozilla Public License 2.0 (MPL 2.0)": "MPL-2.0"}
MAX_NAME_LENGTH = 60


def locked(text: str) -> Iterator[tuple[Requirement, list[str]]]:
    """Each requirement of a lock with the SHA-256 of its files."""
    lines = (line for line in text.splitlines() if not line.lstrip().startswith("#"))
    for entry in "\n".join(lines).replace("\\\n", " ").splitlines():
        if entry.strip():
            yield Requirement(entry.split("--hash")[0].strip()), SHA256.findall(entry)


def licence_of(name: str, version: str) -> str | None:
    """The licence that the installed package states; None if this version is not installed or states none."""
    try:
        stated = metadata(name)
    except PackageNotFoundError:
        return None
    if stated["Version"] != version:
        return None
    classifiers = [
        one.rpartition(" :: ")[2] for one in stated.get_all("Classifier", []) if "License ::" in one
    ]
    written = stated["License-Expression"] or stated["License"] or ""
    # Some packages write the whole text of their licence there.
    is_name = 0 < len(written) <= MAX_NAME_LENGTH and "\n" not in written
    return written if is_name else next((CLASSIFIED.get(one, one) for one in classifiers), None)


def python_components(lock: str) -> Iterator[Component]:
    """The packages of a lock."""
    licences = LicenseFactory()
    for requirement, hashes in locked(lock):
        name = canonicalize_name(requirement.name)
        (version,) = (one.version for one in requirement.specifier)
        licence = licence_of(name, version)
        place = PackageURL("pypi", name=name, version=version)
        yield Component(
            name=name,
            version=version,
            type=ComponentType.LIBRARY,
            purl=place,
            bom_ref=str(place),
            hashes=[HashType(alg=HashAlgorithm.SHA_256, content=one) for one in hashes],
            licenses=[] if licence is None else [licences.make_from_string(licence)],
            properties=[Property(name="coaxial:marker", value=str(requirement.marker))]
            if requirement.marker
            else [],
        )


def is_for_development(component: Component) -> bool:
    """Whether npm marks the component as needed to build the page only."""
    return any(
        one.name == "cdx:npm:package:development" and one.value == "true" for one in component.properties
    )


def bill(page: Bom) -> Bom:
    """What runs: this project's Python packages, and the page with its packages."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    python = list(python_components((ROOT / "requirements.lock").read_text(encoding="utf-8")))
    shown = [page.metadata.component, *(one for one in page.components if not is_for_development(one))]
    made = Bom(components=[*python, *shown])
    dependencies = {one.ref: {other.ref for other in one.dependencies} for one in page.dependencies}
    made.metadata.component = Component(
        name=project["name"],
        version=project["version"],
        type=ComponentType.APPLICATION,
        bom_ref=project["name"],
        licenses=[LicenseFactory().make_from_string(project["license"])],
        description=project["description"],
    )
    direct = {canonicalize_name(Requirement(one).name) for one in project["dependencies"]}
    # npm takes the name of the folder for a package that is not published; its version is the project's.
    page.metadata.component.name = page.metadata.component.purl.name
    page.metadata.component.version = project["version"]
    page.metadata.component.purl = PackageURL(
        "npm", name=page.metadata.component.name, version=project["version"]
    )
    for one in shown:
        made.register_dependency(
            one, [other for other in shown if other.bom_ref in dependencies[one.bom_ref]]
        )
    made.register_dependency(
        made.metadata.component, [page.metadata.component, *(one for one in python if one.name in direct)]
    )
    if "SOURCE_DATE_EPOCH" in os.environ:
        made.metadata.timestamp = datetime.fromtimestamp(int(os.environ["SOURCE_DATE_EPOCH"]), UTC)
        versions = " ".join(sorted(str(one.purl) for one in made.components))
        made.serial_number = uuid.uuid5(uuid.NAMESPACE_URL, versions)
    return made


def main(page: str, output: str) -> None:
    """Write the bill of materials."""
    of_page = Bom.from_json(json.loads(Path(page).read_text(encoding="utf-8")))
    Path(output).parent.mkdir(parents=True, exist_ok=True)
    Path(output).write_text(JsonV1Dot6(bill(of_page)).output_as_string(indent=2) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main(*sys.argv[1:])
