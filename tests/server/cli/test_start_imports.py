"""Modules that a server start must not wait for."""

import subprocess
import sys

# # Each takes 0.1 to 0.75 s, and is needed only by jobs, uploads, registration, a migration or a viewer of
# # the 3-D scene.
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


def test_a_start_imports_no_library_that_only_a_job_needs() -> None:
    done = subprocess.run([sys.executable, "-c", IMPORT], capture_output=True, text=True, check=True)
    loaded = set(done.stdout.split())
    assert "fastapi" in loaded
    assert loaded & NOT_AT_START == set()
