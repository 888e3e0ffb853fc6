"""Static files of the web page, with cache lifetimes."""

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from fastapi import FastAPI
from fastapi.responses import HTMLResponse
from starlette.responses import Response
from starlette.staticfiles import StaticFiles
from starlette.types import Scope

from server.installation import file_candidates
from server.security.headers import CAMERA_PAGE_PERMISSIONS

PAGE_FOLDERS = file_candidates("page", "web/dist")
# Client-side routes of the page, all served by its one HTML file.
CAMERA_VIEW = "camera"
VIEWS = frozenset({"theatre", "operator", "supervisor", "theatres", "enter", CAMERA_VIEW})
# File names of these assets contain a hash of their content.
FOREVER = "public, max-age=31536000, immutable"
REVALIDATE = "no-cache"

NOT_BUILT = """<!doctype html><html lang="en"><head><meta charset="utf-8"><title>Coaxial</title></head>
<body><h1>Coaxial is running, but its page is not built</h1>
<p>Run <code>make run</code> in the checkout, or <code>npm ci</code> and then <code>npm run build</code> in
its folder <code>web</code>, and load this page again.</p>
<p>Meanwhile: <a href="/video/{camera}.mjpg">the video</a>, <a href="/scene/">the 3-D scene</a>,
<a href="/api/docs">the API documentation</a>.</p>
<p>Research software, not a medical device.</p></body></html>
"""


class PageFiles(StaticFiles):
    """Static files of the page: hashed assets are immutable, all others are revalidated."""

    async def get_response(self, path: str, scope: Scope) -> Response:
        """Return the file with its Cache-Control header."""
        view = path.split("/", 1)[0]
        if view in VIEWS:
            path = "index.html"
        response = await super().get_response(path, scope)
        hashed = path.startswith("assets/") and response.status_code < 400
        response.headers["Cache-Control"] = FOREVER if hashed else REVALIDATE
        if view == CAMERA_VIEW:
            response.headers["Permissions-Policy"] = CAMERA_PAGE_PERMISSIONS
        return response


def page_folder(folders: tuple[Path, ...] = PAGE_FOLDERS) -> Path | None:
    """Return the folder of the built page; None if it is not built."""
    return next((folder for folder in folders if (folder / "index.html").is_file()), None)


def page_addresses(folder: Path | None) -> Callable[[str], bool]:
    """Return a predicate for paths of the page, which contain no patient data and need no sign-in.

    Everything under `assets` counts, because a build while the server runs creates new names there.
    """
    files = () if folder is None else folder.rglob("*")
    known = {"/"} | {f"/{file.relative_to(folder or file).as_posix()}" for file in files if file.is_file()}

    def is_page(path: str) -> bool:
        parts = path.split("/")
        if folder is None or path in known or {".", ".."} & set(parts):
            return path in known
        return parts[1] in VIEWS or (parts[1] == "assets" and len(parts) == 3 and parts[2] != "")

    return is_page


def mount_page(app: FastAPI, *, camera: str, folder: Path | None) -> None:
    """Mount the page at `/`. Must be the last route, because it matches every path."""
    if folder is not None:
        app.mount("/", PageFiles(directory=folder, html=True), name="page")
        return
    headers: Mapping[str, Any] = {"Cache-Control": "no-store"}

    @app.get("/", response_class=HTMLResponse, include_in_schema=False)
    async def not_built() -> HTMLResponse:
        return HTMLResponse(NOT_BUILT.format(camera=camera), status_code=503, headers=dict(headers))
