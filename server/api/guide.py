"""The user guide at `/docs/`: its built files, how its build proceeds, or instructions to build it.

`make run` builds it after what the start needs, while the server runs, so that the folder is looked up at
each request.

The guide contains no patient data and needs no sign-in, like the files of the page. Each of its pages has a
few inline scripts of the theme (colour scheme, storage scope). The Content-Security-Policy allows them by
their hashes, per page and only under `/docs/`.
"""

import base64
import hashlib
import html
import os
import re
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

from fastapi import FastAPI
from fastapi.responses import HTMLResponse, RedirectResponse
from starlette.datastructures import Headers
from starlette.responses import Response
from starlette.staticfiles import StaticFiles
from starlette.types import Receive, Scope, Send

from server.installation import file_candidates
from server.security import page_policy

GUIDE_FOLDERS = file_candidates("guide", "docs/site")
# Written by `.make/build-guide`, whose steps have a log each in the same folder.
STATE_FILES = file_candidates("guide.state", ".venv/log/guide.state")
LOGS = ("guide.txt", "docs-packages.txt")
LOG_LINES = 20
RELOAD_AFTER_S = 5
ADDRESS = "/docs"
# Only scripts without attributes are executed; the policy does not apply to JSON data.
INLINE_SCRIPT = re.compile(rb"<script>(.*?)</script>", re.DOTALL)

_PAGE = """<!doctype html><html lang="en"><head><meta charset="utf-8"><title>Coaxial guide</title>{head}
</head><body><h1>{title}</h1>
{body}
<p>The API is documented at <a href="/api/docs">/api/docs</a>.</p></body></html>
"""
NOT_BUILT = _PAGE.format(
    head="",
    title="The user guide is not built",
    body="""<p>Run <code>make docs</code> in the checkout, and load this page again. Meanwhile the guide
can be read as text in the folder <code>docs/guide</code>.</p>""",
)
BEING_BUILT = _PAGE.format(
    head=f'<meta http-equiv="refresh" content="{RELOAD_AFTER_S}">',
    title="The user guide is being built",
    body="""<p>This takes up to a few minutes after the first start. The page loads again by itself.</p>""",
)


@dataclass(frozen=True, slots=True, kw_only=True)
class GuidePlaces:
    """Where the guide and the state of its build may be: in the installed package, or in the checkout."""

    folders: tuple[Path, ...] = GUIDE_FOLDERS
    states: tuple[Path, ...] = STATE_FILES


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


def build_failure(state: Path) -> str:
    """Return the end of the newest log of a failed build, as HTML."""
    logs = [log for log in (state.parent / name for name in LOGS) if log.is_file()]
    if not logs:
        return ""
    log = max(logs, key=lambda one: one.stat().st_mtime)
    lines = log.read_text(encoding="utf-8", errors="replace").splitlines()[-LOG_LINES:]
    end = html.escape("\n".join(lines))
    return f"<p>The end of <code>{html.escape(str(log))}</code>:</p><pre>{end}</pre>"


def absent_guide(states: tuple[Path, ...]) -> str | None:
    """Return the page in place of a guide that is being built or whose build failed; None without a build."""
    state = next((one for one in states if one.is_file()), None)
    if state is None:
        return None
    stated = state.read_text(encoding="utf-8").strip()
    if stated.isdigit() and _is_running(int(stated)):
        return BEING_BUILT
    body = f"<p>Building it failed. Run <code>make docs</code> in the checkout.</p>\n{build_failure(state)}"
    return _PAGE.format(head="", title="The user guide is not built", body=body)


def _is_running(process: int) -> bool:
    try:
        os.kill(process, 0)
    except PermissionError:
        return True
    except (OSError, OverflowError):
        return False
    return True


class Guide:
    """The guide as it is at each request; an ASGI application."""

    def __init__(self, places: GuidePlaces) -> None:
        self._places = places

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer with a file of the guide, or with 503 and the reason for its absence."""
        folder, page = guide_folder(self._places.folders), absent_guide(self._places.states)
        # A build removes the former guide first, and a failed one may leave a part.
        if page is None and folder is not None:
            await GuideFiles(directory=folder, html=True)(scope, receive, send)
            return
        headers = {"Cache-Control": "no-store"}
        await HTMLResponse(page or NOT_BUILT, status_code=503, headers=headers)(scope, receive, send)


def mount_guide(app: FastAPI, *, places: GuidePlaces | None = None) -> None:
    """Serve the guide at `/docs/`."""

    @app.get(ADDRESS, include_in_schema=False, name="guide")
    async def with_slash() -> RedirectResponse:
        return RedirectResponse(f"{ADDRESS}/")

    app.mount(ADDRESS, Guide(places or GuidePlaces()), name="guide")
