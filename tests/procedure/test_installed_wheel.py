"""The wheel of `make wheel`: its contents, and that it runs outside of a checkout."""

import email
import os
import re
import shutil
import signal
import subprocess
import sys
import sysconfig
import tarfile
import tomllib
import zipfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import httpx2
import pytest

from tests.procedure.real_server import PATIENCE_S, RealServer, port_of

ROOT = Path(__file__).parents[2]
PYPROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
INFO = f"coaxial-{PYPROJECT['project']['version']}.dist-info"
# Files of an unrelated program in the folder in which Coaxial is started.
DECOYS = ("server.py", "tracker.py", "numpy.py", "yaml.py", "numba.py")
CODE_PLACES = """
from server.installation import prepare_process
prepare_process()
import tracker.warm_up
from tracker.compiled import DISPATCHERS
for loop in DISPATCHERS:
    print(loop.py_func.__code__.co_filename, loop.stats.cache_path, sep="\\t")
"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Built:
    """What was built out of a copy of the checkout.

    Attributes:
        folder: the copy.
        wheel: the wheel of the copy.
        sdist: its source archive.
        wheel_of_sdist: the wheel of the unpacked source archive.
    """

    folder: Path
    wheel: Path
    sdist: Path
    wheel_of_sdist: Path


def in_git(*folders: str) -> list[str]:
    listed = subprocess.run(
        [
            "git",
            "-c",
            "safe.directory=*",
            "ls-files",
            "-z",
            "--cached",
            "--others",
            "--exclude-standard",
            *folders,
        ],
        cwd=ROOT,
        check=True,
        capture_output=True,
        text=True,
    )
    return [name for name in listed.stdout.split("\0") if name and (ROOT / name).exists()]


def build(folder: Path, *targets: str) -> None:
    wanted = [word for target in targets for word in ("-t", target)]
    command = [sys.executable, "-m", "hatchling", "build", "-d", "dist", *wanted]
    subprocess.run(command, cwd=folder, check=True, capture_output=True)


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> Built:
    folder = tmp_path_factory.mktemp("builder") / "checkout"
    for name in in_git():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy2(ROOT / name, folder / name)
    assert (ROOT / "web/dist/index.html").is_file(), "the page is not built: make ready"
    shutil.copytree(ROOT / "web/dist", folder / "web/dist")
    guide = [
        sys.executable,
        "-m",
        "zensical",
        "build",
        "--strict",
        "--clean",
        "--config-file",
        "docs/zensical.toml",
    ]
    subprocess.run(guide, cwd=folder, check=True, capture_output=True)
    # Neither ignored folders nor stray files may be included.
    (folder / "recording.mcap").touch()
    (folder / ".coaxial").mkdir()
    (folder / ".coaxial/coaxial.sqlite3").touch()
    build(folder, "sdist", "wheel")
    (wheel,), (sdist,) = (folder / "dist").glob("*.whl"), (folder / "dist").glob("*.tar.gz")
    unpacked = folder.parent / "unpacked"
    with tarfile.open(sdist) as archive:
        archive.extractall(unpacked, filter="data")
    (source,) = unpacked.iterdir()
    build(source, "wheel")
    return Built(folder=folder, wheel=wheel, sdist=sdist, wheel_of_sdist=source / "dist" / wheel.name)


def contents(wheel: Path) -> dict[str, bytes]:
    with zipfile.ZipFile(wheel) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


def test_it_holds_program_page_guide_and_settings_and_nothing_else(built: Built) -> None:
    members = contents(built.wheel)
    assert {name.split("/")[0] for name in members} == {"server", "tracker", INFO}
    assert set(in_git("server", "tracker")) <= members.keys()
    of_page = {
        f"server/page/{file.relative_to(ROOT / 'web/dist').as_posix()}"
        for file in files_in(ROOT / "web/dist")
    }
    assert of_page <= members.keys()
    assert {"server/page/index.html", "server/guide/index.html", "server/config.yaml"} <= members.keys()
    assert [
        name
        for name in members
        if re.search(r"(^|/)(tests|node_modules|__pycache__)/|\.(nb[ic]|mcap)$", name)
    ] == []


def files_in(folder: Path) -> list[Path]:
    return [file for file in folder.rglob("*") if file.is_file()]


def test_it_names_no_folder_of_its_builder(built: Built) -> None:
    places = [str(built.folder).encode(), f"{ROOT}/web".encode(), sys.prefix.encode()]
    assert [
        name for name, content in contents(built.wheel).items() if any(place in content for place in places)
    ] == []


def test_the_source_archive_lacks_nothing_and_has_nothing_that_is_no_source(built: Built) -> None:
    assert contents(built.wheel_of_sdist) == contents(built.wheel)
    # Reproducible: built in another folder at another time, and still the same bytes.
    assert built.wheel_of_sdist.read_bytes() == built.wheel.read_bytes()
    with tarfile.open(built.sdist) as archive:
        members = {name.split("/", 1)[1] for name in archive.getnames()}
    made = {name for name in members if name.startswith(("web/dist/", "docs/site/"))}
    assert members - made == {*in_git(), "PKG-INFO"}


def test_its_metadata_are_those_of_the_project(built: Built) -> None:
    project = PYPROJECT["project"]
    members = contents(built.wheel)
    metadata = email.message_from_bytes(members[f"{INFO}/METADATA"])
    required = [re.sub(r"[\s'\"]", "", one) for one in metadata.get_all("Requires-Dist", [])]
    needed = {one.split(">")[0].split("=")[0] for one in project["dependencies"]}
    assert {re.split(r"[<>=;]", one)[0] for one in required if "extra==" not in one} == {
        n.lower() for n in needed
    }
    assert set(metadata.get_all("Provides-Extra", [])) == set(project["optional-dependencies"])
    assert metadata["License-Expression"] == "Apache-2.0"
    assert "not a medical device" in metadata["Summary"]
    assert b"coaxial = server.__main__:main" in members[f"{INFO}/entry_points.txt"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Installed:
    """The wheel in an environment of its own.

    Attributes:
        environment: the folder of the environment.
        packages: its site-packages.
        home: the home folder of the user.
        cwd: the folder in which commands are started.
    """

    environment: Path
    packages: Path
    home: Path
    cwd: Path

    @property
    def variables(self) -> dict[str, str]:
        return {"HOME": str(self.home), "PATH": os.defpath}

    def run(self, program: str, *arguments: str) -> str:
        command = [str(self.environment / "bin" / program), *arguments]
        done = subprocess.run(
            command, cwd=self.cwd, env=self.variables, check=True, capture_output=True, text=True
        )
        return done.stdout


@pytest.fixture(scope="module")
def installed(built: Built, tmp_path_factory: pytest.TempPathFactory) -> Installed:
    """The wheel with an empty home folder, and with the checkout's packages as its dependencies."""
    folder = tmp_path_factory.mktemp("user")
    environment = folder / "environment"
    subprocess.run([sys.executable, "-m", "venv", "--without-pip", str(environment)], check=True)
    (packages,) = environment.glob("lib/python*/site-packages")
    (packages / "dependencies.pth").write_text(sysconfig.get_path("purelib") + "\n")
    uv = [sys.executable, "-m", "uv", "pip", "install", "--no-config", "--no-cache", "--offline", "--no-deps"]
    target = ["--python", str(environment / "bin/python")]
    subprocess.run([*uv, *target, str(built.wheel)], check=True, capture_output=True)
    home, cwd = folder / "home", folder / "cwd"
    home.mkdir()
    cwd.mkdir()
    for decoy in DECOYS:
        (cwd / decoy).write_text(f"raise ImportError('{decoy} of the current folder was imported')\n")
    return Installed(environment=environment, packages=packages, home=home, cwd=cwd)


def take_over_compiled_code(installed: Installed) -> None:
    """Copy the checkout's compiled code to where the installation looks for its own, which saves a minute.

    Numba compares times of sources, so each gets the time of the equal file in the checkout.
    """
    for line in installed.run("python", "-P", "-c", CODE_PLACES).splitlines():
        source, place = map(Path, line.split("\t"))
        own = ROOT / source.relative_to(installed.packages)
        assert source.read_bytes() == own.read_bytes()
        written_at = own.stat()
        os.utime(source, ns=(written_at.st_atime_ns, written_at.st_mtime_ns))
        place.mkdir(parents=True, exist_ok=True)
        for compiled in (own.parent / "__pycache__").glob(f"{own.stem}.*.nb[ic]"):
            shutil.copy2(compiled, place)


@pytest.fixture(scope="module")
def served(installed: Installed) -> Iterator[RealServer]:
    take_over_compiled_code(installed)
    command = [str(installed.environment / "bin" / "coaxial"), "run", "--port", "0"]
    with subprocess.Popen(
        command, cwd=installed.cwd, env=installed.variables, stdout=subprocess.PIPE, text=True
    ) as process:
        try:
            port = port_of(process)
            with httpx2.Client(base_url=f"http://127.0.0.1:{port}", timeout=PATIENCE_S) as door:
                yield RealServer(port=port, process=process, door=door)
        finally:
            process.send_signal(signal.SIGTERM)
            process.wait(PATIENCE_S)
    assert process.returncode == 0


def test_its_commands_run_in_any_folder(installed: Installed) -> None:
    assert installed.run("coaxial", "--version") == f"Coaxial {PYPROJECT['project']['version']}\n"
    assert installed.run("coaxial", "config") == (ROOT / "config.yaml").read_text(encoding="utf-8")


def test_it_serves_its_page_and_its_guide(served: RealServer) -> None:
    page = served.door.get("/").raise_for_status().text
    script = re.search(r'src="(/assets/[^"]+\.js)"', page)
    assert script is not None
    assert served.door.get(script[1]).raise_for_status().content
    assert "<title>" in served.door.get("/docs/").raise_for_status().text


def test_it_tracks_the_rehearsal(served: RealServer) -> None:
    served.until("an image is tracked", lambda: served.door.get("/health").json()["status"] == "ok")


@pytest.mark.usefixtures("served")
def test_its_data_lie_in_the_folders_of_the_user(installed: Installed) -> None:
    assert len(list(installed.home.rglob("coaxial.sqlite3"))) == 1
    assert list(installed.home.rglob("*.nbi"))
    assert list(installed.packages.rglob("*.nbi")) == []
    assert sorted(file.name for file in installed.cwd.iterdir()) == sorted(DECOYS)
