"""Modules that a server start must not wait for."""

import subprocess
import sys

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
IMPORT = """
import sys
import server.app, server.cli.run, server.cli.storage, server.cli.web, server.procedure
print(*sorted({".".join(name.split(".")[:2]) for name in sys.modules}))
"""
SOURCES = """
import linecache, sys
import server.app, server.cli.run, server.cli.storage, server.cli.web, server.procedure
print(*(sys.modules["server"].__path__[0] in name for name in linecache.cache))
"""
LOOPS = """
import server.app, server.cli.run, server.cli.storage, server.cli.web, server.procedure
from server.config import Config
from server.marker_remarks import reject_ambiguous_markers
from server.setup import build_setup
from tracker.compiled import DISPATCHERS
reject_ambiguous_markers(build_setup(Config()).models)
print(len(DISPATCHERS), *(loop.py_func.__name__ for loop in DISPATCHERS if loop.signatures))
"""


def test_a_start_imports_no_library_that_only_a_job_needs() -> None:
    done = subprocess.run([sys.executable, "-c", IMPORT], capture_output=True, text=True, check=True)
    loaded = set(done.stdout.split())
    assert "fastapi" in loaded
    assert loaded & NOT_AT_START == set()


def test_a_start_reads_no_source_to_describe_fields() -> None:
    done = subprocess.run([sys.executable, "-c", SOURCES], capture_output=True, text=True, check=True)
    assert "True" not in done.stdout.split()


def test_the_web_server_loads_no_compiled_loop_at_its_start() -> None:
    done = subprocess.run([sys.executable, "-c", LOOPS], capture_output=True, text=True, check=True)
    known, *loaded = done.stdout.split()
    assert int(known) > 0
    assert loaded == []
