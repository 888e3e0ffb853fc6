"""Modules that a server start must not wait for."""

import json
import subprocess
import sys
from typing import Any

import pytest

Start = dict[str, Any]

# Each takes 0.1 to 0.75 s, and is needed only by jobs, uploads, registration, a migration or a viewer of
# the 3-D scene.
NOT_AT_START = {
    *("alembic", "mako", "networkx", "pydicom", "trimesh", "viser"),
    *(
        "scipy.interpolate",
        "scipy.ndimage",
        "scipy.optimize",
        "scipy.sparse",
        "scipy.spatial",
        "scipy.special",
    ),
    *("skimage.filters", "skimage.measure"),
}
# A web server as far as it serves: what is imported is printed before its set-up is built.
START = """
import json, linecache, sys
import server.app, server.cli.run, server.cli.storage, server.cli.web, server.procedure
modules = sorted({".".join(name.split(".")[:2]) for name in sys.modules})
sources = [name for name in linecache.cache if sys.modules["server"].__path__[0] in name]

from server.config import Config
from server.marker_remarks import reject_ambiguous_markers
from server.setup import build_setup
from tracker.compiled import DISPATCHERS
reject_ambiguous_markers(build_setup(Config()).models)
loaded = [loop.py_func.__name__ for loop in DISPATCHERS if loop.signatures]
json.dump({"modules": modules, "sources": sources, "loops": len(DISPATCHERS), "loaded": loaded}, sys.stdout)
"""


@pytest.fixture(scope="module")
def start() -> Start:
    """What a web server has loaded at its start, in a process of its own."""
    done = subprocess.run([sys.executable, "-c", START], capture_output=True, text=True, check=True)
    loaded: Start = json.loads(done.stdout)
    return loaded


def test_a_start_imports_no_library_that_only_a_job_needs(start: Start) -> None:
    assert "fastapi" in start["modules"]
    assert set(start["modules"]) & NOT_AT_START == set()


def test_a_start_reads_no_source_to_describe_fields(start: Start) -> None:
    assert start["sources"] == []


def test_the_web_server_loads_no_compiled_loop_at_its_start(start: Start) -> None:
    assert start["loops"] > 0
    assert start["loaded"] == []
