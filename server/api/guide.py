"""The user guide at `/docs/`: the files built by `make docs`, or instructions to build them.

The guide contains no patient data and needs no sign-in, like the files of the page. Each of its pages has a
few inline scripts of the theme (colour scheme, storage scope). The Content-Security-Policy allows them by
their hashes, per page and only under `/docs/`.
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

from server.installation import file_candidates
from server.security import page_policy

GUIDE_FOLDERS = file_candidates("guide", "docs/site")
ADDRESS = "/docs"
# Only scripts without attributes are executed; the policy does not apply to JSON data.
INLINE_SCRIPT = re.compile(rb"<script>(.*?)</script>", re.DOTALL)

NOT_BUILT = """<!doctype html><html lang="en"><head><meta charset="utf-8"><title>Coaxial guide</title></head>
<body><h1>The user guide is not built</h1>
<p>Run <code>make docs</code> in the checkout, start the server again, and load this page again. Meanwhile the
guide can be read as text in the folder <code>docs/guide</code>.</p>
<p>The API is documented at <a href="/api/docs">/api/docs</a>.</p></body></html>
"""


class GuideFiles(StaticFiles):
    """Static files of the guide; browsers revalidate them, because a new build keeps the file names."""

    def lookup_path(self, path: str) -> tuple[str, os.stat_result | None]:
        """Look up a file, except the 404 page of the generator, whose links expect the server root."""
        return ("", None) if path == "404.html" else super().lookup_path(path)

    def file_response(
        self,
        full_path: str | os.PathLike[str],
        stat_result: os.stat_result,
        scope: Scope,
        status_code: int = 200,
    ) -> Response:
        """Return the file or 304; HTML pages carry a policy that allows their inline scripts."""
        response = super().file_response(full_path, stat_result, scope, status_code)
        response.headers["Cache-Control"] = "no-cache"
        if os.fspath(full_path).endswith(".html"):
            hashes = inline_script_hashes(os.fspath(full_path), stat_result.st_mtime_ns)
            host = Headers(scope=scope).get("host", "")
            # Also on a 304, because a browser updates its stored headers from it.
            response.headers["Content-Security-Policy"] = page_policy(host, scripts=hashes)
        return response


@lru_cache(maxsize=64)
def inline_script_hashes(path: str, _mtime_ns: int) -> tuple[str, ...]:
    """Return the CSP sources `'sha256-...'` of the inline scripts in an HTML file."""
    scripts = INLINE_SCRIPT.findall(Path(path).read_bytes())
    digests = {base64.b64encode(hashlib.sha256(script).digest()).decode() for script in scripts}
    return tuple(f"'sha256-{digest}'" for digest in sorted(digests))


def guide_folder(folders: tuple[Path, ...] = GUIDE_FOLDERS) -> Path | None:
    """Return the folder of the built guide; None if it is not built."""
    return next((folder for folder in folders if (folder / "index.html").is_file()), None)


def is_guide(path: str) -> bool:
    """Return whether a path belongs to the guide."""
    return path == ADDRESS or (path.startswith(f"{ADDRESS}/") and not {".", ".."} & set(path.split("/")))


def mount_guide(app: FastAPI, *, folder: Path | None) -> None:
    """Serve the guide at `/docs/`."""

    @app.get(ADDRESS, include_in_schema=False, name="guide")
    async def with_slash() -> RedirectResponse:
        return RedirectResponse(f"{ADDRESS}/")

    if folder is not None:
        app.mount(ADDRESS, GuideFiles(directory=folder, html=True), name="guide")
        return

    # The page's help leads to places within the guide.
    @app.get(f"{ADDRESS}/{{path:path}}", response_class=HTMLResponse, include_in_schema=False, name="guide")
    async def not_built(path: str) -> HTMLResponse:  # noqa: ARG001  the same for each
        return HTMLResponse(NOT_BUILT, status_code=503)
