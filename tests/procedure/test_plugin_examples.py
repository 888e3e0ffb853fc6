"""The plug-in examples of the guide, installed as packages, do what the guide states."""

import csv
import os
import subprocess
import sys
from itertools import count
from pathlib import Path

import cv2
import numpy as np
import pytest

from tests.procedure.real_server import RealServer, real_server

EXAMPLES = Path(__file__).parents[2] / "docs" / "examples"
SIZE_WH_PX = (320, 240)


@pytest.fixture(scope="module")
def packages(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the installed examples."""
    folder = tmp_path_factory.mktemp("packages")
    # Without isolation the build needs no network.
    install = ["-m", "uv", "pip", "install", "--no-config", "--no-cache", "--offline", "--no-deps"]
    build = ["--no-build-isolation", "--python", sys.executable, "--target", str(folder)]
    examples = [str(example) for example in sorted(EXAMPLES.iterdir())]
    subprocess.run([sys.executable, *install, *build, *examples], check=True, capture_output=True)
    return folder


def replace_picture(path: Path, seed: int) -> None:
    """Replace the picture at this path atomically, as the source expects."""
    width, height = SIZE_WH_PX
    picture = np.random.default_rng(seed).integers(0, 255, (height, width, 3), np.uint8)
    new = path.with_name("new.png")
    assert cv2.imwrite(str(new), picture)
    new.replace(path)


def images_of(server: RealServer) -> int:
    source = server.ask("GET", "/health", 200)["source"]
    return 0 if source is None or source["state"] != "running" else int(source["images"])


def test_a_picture_file_is_the_camera_and_a_table_receives_what_is_published(
    tmp_path: Path, packages: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    picture, table = tmp_path / "newest.png", tmp_path / "table.csv"
    monkeypatch.setenv("COAXIAL_CSV", str(table))
    replace_picture(picture, 0)
    settings = {"camera": {"source": f"plugin:file:{picture}"}, "plugins": {"sinks": ["csv"]}}
    with real_server(tmp_path / "server", settings, packages=packages) as server:
        seeds = count(1)

        def images_come() -> bool:
            replace_picture(picture, next(seeds))
            return images_of(server) >= 3 and any(row["image_number"] for row in rows(table))

        server.until("images come, and are in the table", images_come)
        assert server.ask("GET", "/api/live", 200)["source"]["name"] == "plugin:file"
        (sink,) = server.ask("GET", "/health", 200)["sinks"]
        assert (sink["name"], sink["problem"]) == ("csv", None)
        os.truncate(picture, 0)
        server.until(
            "the missing image is a problem", lambda: source_problem(server) == "PLUGIN_SOURCE_FAILED"
        )
    newest = rows(table)[-1]
    assert newest["image_number"] == "", "an image that is gone is in the table as if it were there"
    assert newest["headline"]


def rows(table: Path) -> list[dict[str, str]]:
    if not table.exists():
        return []
    with table.open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def source_problem(server: RealServer) -> str | None:
    problem = server.ask("GET", "/health", 200)["source"]["problem"]
    return None if problem is None else str(problem["code"])
