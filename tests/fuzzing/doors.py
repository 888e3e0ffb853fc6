"""REST API and WebSockets as targets: a request or messages of a client, to a server in this process."""

import json
import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from typing import Any

import httpx2
import numpy as np
from fastapi.testclient import TestClient

import server.api.errors
from tests.fuzzing.targets import CHECKOUT, Read, Target
from tests.procedure.conftest import Server, serving

# Streams without an end, and bodies that are files, which have targets of their own.
NOT_REQUESTED = ("/video", "/api/ct", "/api/labels", "/api/surface", "/api/cases/archive")
INTERNAL = 500
MAX_MESSAGES = 20


class LastError:
    """Takes the place of the log of unexpected errors."""

    error: BaseException | None = None

    def exception(self, _event: str, **_fields: object) -> None:
        """Remember the error that is being handled."""
        self.error = sys.exception()


@contextmanager
def api_opened(folder: Path) -> Iterator[Read]:
    """A server with an open case and an image; the input is `METHOD /path?query`, a line end, and a body."""
    with serving(folder / "home") as running:
        case = running.ask("POST", "/api/cases", 201, json={"name": "somebody"})
        running.ask("POST", f"/api/cases/{case['id']}/open", 200)
        running.show(at_s=1.0, image=np.zeros((720, 1280, 3), dtype=np.uint8), rate_hz=30.0)
        logged = LastError()
        server.api.errors._log = logged  # until this process ends

        def read(content: bytes) -> object:
            return _request(running, logged, content)

        yield read


def _request(running: Server, logged: LastError, content: bytes) -> int:
    line, _, body = content.partition(b"\n")
    method, _, path = line.decode("latin-1").partition(" ")
    if method.upper() not in {"GET", "POST", "PUT", "PATCH", "DELETE"} or not path.startswith("/"):
        return 0
    if path.startswith(NOT_REQUESTED) or "video" in path.lower():
        return 0
    logged.error = None
    try:
        answer = running.door.request(
            method.upper(), path, content=body, headers={"Content-Type": "application/json"}
        )
    except (httpx2.InvalidURL, UnicodeError, ValueError):
        return 0
    if logged.error is not None:
        raise logged.error
    if answer.status_code == INTERNAL:
        raise AssertionError(f"{method} {path[:200]}: {answer.text[:300]}")
    return int(answer.status_code)


@cache
def requests_by_schema() -> list[bytes]:
    """One request to each address, as the schema describes it."""
    described = json.loads((CHECKOUT / "web" / "openapi.json").read_text(encoding="utf-8"))
    found = []
    for path, methods in described["paths"].items():
        for method, operation in methods.items():
            place, query = path, []
            for one in operation.get("parameters", []):
                value = _example(one["schema"], described)
                if one["in"] == "path":
                    place = place.replace(f"{{{one['name']}}}", str(value))
                elif one["in"] == "query":
                    query.append(f"{one['name']}={value}")
            content = operation.get("requestBody", {}).get("content", {}).get("application/json")
            schema = None if content is None else content.get("schema")
            body = b"" if schema is None else json.dumps(_example(schema, described)).encode()
            if not place.startswith(NOT_REQUESTED):
                found.append(f"{method.upper()} {place}?{'&'.join(query)}\n".encode() + body)
    return found


def _example(schema: Mapping[str, Any], described: Mapping[str, Any]) -> Any:  # noqa: ANN401  JSON
    """Return a value that a JSON schema allows, as far as its types say."""
    if "$ref" in schema:
        return _example(described["components"]["schemas"][schema["$ref"].rpartition("/")[2]], described)
    for key in ("anyOf", "oneOf", "allOf"):
        if key in schema:
            return _example(schema[key][0], described)
    if "enum" in schema or "const" in schema:
        return schema.get("const", schema.get("enum", [None])[0])
    low = schema.get("minimum", schema.get("exclusiveMinimum", -1) + 1)
    match schema.get("type"):
        case "object":
            return {name: _example(one, described) for name, one in schema.get("properties", {}).items()}
        case "array":
            count = max(schema.get("minItems", 1), 1)
            return [_example(schema.get("items", {}), described)] * count
        case "string":
            return ("0" * 32 if "pattern" in schema else "a" * max(schema.get("minLength", 1), 1))[:32]
        case "boolean":
            return True
        case "integer" | "number":
            return low
        case _:
            return None


def socket_opened(path: str) -> Callable[[Path], Any]:
    """Open a WebSocket for each input, whose lines are messages."""

    @contextmanager
    def opened(folder: Path) -> Iterator[Read]:
        with serving(folder / "home") as running:
            running.show(at_s=1.0, image=np.zeros((720, 1280, 3), dtype=np.uint8), rate_hz=30.0)

            def read(content: bytes) -> object:
                return _messages(running.door, path, content)

            yield read

    return opened


def _messages(door: TestClient, path: str, content: bytes) -> int:
    with door.websocket_connect(f"ws://127.0.0.1:8000{path}") as socket:
        # A socket passes on valid UTF-8 only.
        for line in content.decode("utf-8", errors="replace").split("\n")[:MAX_MESSAGES]:
            socket.send_text(line)
        # This is no message of any socket: the server closes, at the latest now.
        socket.send_bytes(b"!")
        while (message := socket.receive())["type"] != "websocket.close":
            pass
        return int(message["code"])


def view_messages() -> list[bytes]:
    """Messages of the video's socket."""
    return [
        b'{"next": true}\n{"next": true, "showing_ms": 12}\n{"size": "half"}\n{"largest": "quarter"}',
        b'{"interval_ms": 50}\n{"next": true}',
    ]


def room_messages() -> list[bytes]:
    """Messages of the room's socket."""
    plane = {
        **{"ct_id": "0" * 16, "origin_in_vertebra_mm": [0.0, 1.0, 2.0]},
        **{"right_in_vertebra": [1.0, 0.0, 0.0], "down_in_vertebra": [0.0, 1.0, 0.0]},
    }
    at: dict[str, object] = {"image_number": 1, "captured_at_s": 1.0}
    lines: list[Mapping[str, object]] = [
        {"point": {**at, "at": [3.0, 4.0], "plane": plane}},
        {"draw": {**at, "key": "0" * 16, "shape": "freehand", "points": [[1.0, 2.0]], "plane": None}},
        {"extend": {"key": "0" * 16, "points": [[1.0, 2.0], [3.0, 4.0]]}},
        *({"undo": True}, {"clear": "mine"}, {"lift": True}, {"next": True}),
        {"look": {"part": None, "pictures": [], "freshness": "live", "max_age_ms": 40.0}},
    ]
    return [json.dumps(one).encode() for one in lines]


DOORS: tuple[Target, ...] = (
    Target(name="api", seeds=requests_by_schema, opened=api_opened),
    Target(name="socket-view", seeds=view_messages, opened=socket_opened("/ws/view")),
    Target(name="socket-live", seeds=view_messages, opened=socket_opened("/ws/live")),
    Target(name="socket-room", seeds=room_messages, opened=socket_opened("/ws/room?view=theatre")),
)
