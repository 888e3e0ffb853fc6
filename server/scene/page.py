"""The page of viser, hardened, without external requests, and monitored by `watch.js`."""

import gzip
import hashlib
import json
import re
from dataclasses import dataclass
from pathlib import Path

import viser
from starlette.requests import Request
from starlette.responses import Response

from server.scene.drills import CONE_NODE, TIP_NODE
from server.scene.nodes import BONE_NODE, CHANNEL_NODE
from server.scene.stage import NUMBER_BASE, NUMBER_NODE
from server.scene.views import ANGLE_DEG, VIEWS_NODE

# Hides all present and future controls of viser: only the drawing is visible, and invisible elements
# receive no touches.
STYLE = """
html, body, #root { background: #0b0f14 !important; }
body * { visibility: hidden !important; }
body canvas { visibility: visible !important; }
html:not([data-coaxial=live]) body canvas { opacity: 0.12 !important; filter: grayscale(1); }
#coaxial-stale { display: none; position: fixed; inset: 0; place-content: center; pointer-events: none;
  color: #ffd24a; font: 700 6vmin system-ui, sans-serif; letter-spacing: 0.05em; }
html:not([data-coaxial=live]) #coaxial-stale { display: grid; }
"""

HOST = re.compile(r"[A-Za-z0-9.\-]+(:\d+)?|\[[0-9A-Fa-f:.]+\](:\d+)?")


@dataclass(frozen=True, slots=True, kw_only=True)
class Page:
    """The HTML document.

    Attributes:
        plain: Uncompressed content.
        zipped: Content compressed with gzip.
        etag: ETag of the content.
    """

    plain: bytes
    zipped: bytes
    etag: str

    def answer(self, request: Request) -> Response:
        """Return the document, or 304 if the browser has it."""
        headers = {
            "Cache-Control": "no-cache",
            "ETag": self.etag,
            "Vary": "Accept-Encoding",
            "Content-Security-Policy": content_security_policy(request.headers.get("host")),
            "Referrer-Policy": "no-referrer",
            "X-Content-Type-Options": "nosniff",
        }
        known = {
            tag.strip().removeprefix("W/") for tag in request.headers.get("if-none-match", "").split(",")
        }
        if self.etag in known:
            return Response(status_code=304, headers=headers)
        body = self.plain
        if "gzip" in request.headers.get("accept-encoding", ""):
            body, headers["Content-Encoding"] = self.zipped, "gzip"
        return Response(body, headers=headers, media_type="text/html; charset=utf-8")


def content_security_policy(host: str | None) -> str:
    """Return the Content-Security-Policy of this document, which allows connections to this server only.

    The page of viser unpacks code and styles into inline elements, runs WebAssembly, and opens its WebSocket
    in a worker made from a blob. It does not need eval; only the sorting of splats does, which is not used.
    The WebSocket address is listed, because some browsers do not count ws: as 'self'.
    """
    lines = f" ws://{host} wss://{host}" if host is not None and HOST.fullmatch(host) else ""
    return (
        "default-src 'none'; script-src 'unsafe-inline' 'wasm-unsafe-eval' blob:; worker-src blob: data:; "
        "style-src 'unsafe-inline'; img-src data: blob:; font-src data:; "
        f"connect-src 'self' data: blob:{lines}; base-uri 'none'; form-action 'none'; frame-ancestors 'self'"
    )


def make_page(*, stale_after_ms: float, silent_after_ms: float) -> Page:
    """Return the page of viser with script and style inserted before `</head>`."""
    source = Path(viser.__file__).parent / "client" / "build" / "index.html"
    script = Path(__file__).with_name("watch.js").read_text(encoding="utf-8")
    values = {
        "__STALE_AFTER_MS__": stale_after_ms,
        "__SILENT_AFTER_MS__": silent_after_ms,
        "__NUMBER_NODE__": NUMBER_NODE,
        "__NUMBER_BASE__": NUMBER_BASE,
        "__SEEN_THROUGH__": [BONE_NODE, CHANNEL_NODE, TIP_NODE, CONE_NODE],
        "__VIEWS_NODE__": VIEWS_NODE,
        "__BONE_NODE__": BONE_NODE,
        "__VIEW_ANGLES_DEG__": ANGLE_DEG,
    }
    for token, value in values.items():
        script = script.replace(token, json.dumps(value))
    head = f"<script>{script}</script><style>{STYLE}</style>"
    html = source.read_text(encoding="utf-8").replace("<title>Viser</title>", "<title>Coaxial scene</title>")
    # Before viser's loader, which is in the head as well and must find the wrapped functions.
    html = html.replace("<head>", f"<head>{head}", 1)
    plain = html.encode()
    return Page(
        plain=plain,
        zipped=gzip.compress(plain, mtime=0),
        etag=f'"{hashlib.sha256(plain).hexdigest()[:32]}"',
    )
