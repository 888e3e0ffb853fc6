"""The user guide at `/docs/`: the files that `make docs` builds, or a sentence that says how to build them.

The guide says nothing of a patient, so it is open to everybody, like the page's own files. The theme of its
generator has a few inline scripts in each page (colour scheme, scope of its storage). They are allowed by
their hashes, each page its own and under `/docs/` alone; everything else stays without inline scripts.
"""

import base64
import hashlib
import os
import re
from functools import lru_cache
from pathlib import Path

from fastapi import FastAPI
from fastapi.responses import HTMLResponse, RedirectResponse
from starlette.datastructures import Headers
from starlette.responses import Response
from starlette.staticfiles import StaticFiles
from starlette.types import Scope

from server.security import page_policy

SERVER_FOLDER = Path(__file__).resolve().parent.parent
# Installed, the guide lies in the package; in a checkout, where its build puts it.
GUIDE_FOLDERS = (SERVER_FOLDER / "guide", SERVER_FOLDER.parent / "docs" / "site")
ADDRESS = "/docs"
# Scripts without attributes run; those with a type of JSON are data, which no policy is about.
INLINE_SCRIPT = re.compile(rb"<script>(.*?)</script>", re.DOTALL)

NOT_BUILT = """<!doctype html><html lang="en"><head><meta charset="utf-8"><title>Coaxial guide</title></head>
<body><h1>The user guide is not built</h1>
<p>Run <code>make docs</code> in the checkout, start the server again, and load this page again. Meanwhile the
guide can be read as text in the folder <code>docs/guide</code>.</p>
<p>The interface for machines is documented at <a href="/api/docs">/api/docs</a>.</p></body></html>
"""


class GuideFiles(StaticFiles):
    """The built guide; browsers revalidate every file, because it is built anew under the same names."""

    def lookup_path(self, path: str) -> tuple[str, os.stat_result | None]:
        """Not the generator's 404 page, which looks for its own files at the root of the server."""
        return ("", None) if path == "404.html" else super().lookup_path(path)

    def file_response(
        self,
        full_path: str | os.PathLike[str],
        stat_result: os.stat_result,
        scope: Scope,
        status_code: int = 200,
    ) -> Response:
        """The file, or 304; an HTML page with a policy that allows its own inline scripts."""
        response = super().file_response(full_path, stat_result, scope, status_code)
        response.headers["Cache-Control"] = "no-cache"
        if os.fspath(full_path).endswith(".html"):
            hashes = inline_script_hashes(os.fspath(full_path), stat_result.st_mtime_ns)
            host = Headers(scope=scope).get("host", "")
            # Also on a 304: a browser takes over the headers that come with it.
            response.headers["Content-Security-Policy"] = page_policy(host, scripts=hashes)
        return response


@lru_cache(maxsize=64)
def inline_script_hashes(path: str, _mtime_ns: int) -> tuple[str, ...]:
    """Sources of a Content-Security-Policy, `'sha256-...'`, of the inline scripts in an HTML file."""
    scripts = INLINE_SCRIPT.findall(Path(path).read_bytes())
    digests = {base64.b64encode(hashlib.sha256(script).digest()).decode() for script in scripts}
    return tuple(f"'sha256-{digest}'" for digest in sorted(digests))


def guide_folder(folders: tuple[Path, ...] = GUIDE_FOLDERS) -> Path | None:
    """Where the built guide is, None when it is not built."""
    return next((folder for folder in folders if (folder / "index.html").is_file()), None)


def is_guide(path: str) -> bool:
    """Whether a path is of the guide."""
    return path == ADDRESS or (path.startswith(f"{ADDRESS}/") and not {".", ".."} & set(path.split("/")))


def mount_guide(app: FastAPI, *, folder: Path | None) -> None:
    """Serve the guide at `/docs/`."""

    @app.get(ADDRESS, include_in_schema=False, name="guide")
    async def with_slash() -> RedirectResponse:
        return RedirectResponse(f"{ADDRESS}/")

    if folder is not None:
        app.mount(ADDRESS, GuideFiles(directory=folder, html=True), name="guide")
        return

    @app.get(f"{ADDRESS}/", response_class=HTMLResponse, include_in_schema=False, name="guide")
    async def not_built() -> HTMLResponse:
        return HTMLResponse(NOT_BUILT, status_code=503)
