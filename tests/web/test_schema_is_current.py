"""The page's types are made from `web/openapi.json`: it must say what the server says.

After a wanted change of the server's messages, from the checkout's top folder:

    PYTHONPATH=. python tests/web/test_schema_is_current.py
"""

import json
import tempfile
from pathlib import Path
from typing import Any

from server.config import Config
from server.hub.connection import HubAddress
from server.hub.subjects import Hospital
from server.hub_app import create_hub_app
from tests.procedure.conftest import serving

# A file to keep; its format version is part of it.
FREE_FORM = {"/api/plan/export", "/api/plan/markups", "/api/certificates/{marker}/json"}
OPENAPI_FILE = Path(__file__).resolve().parents[2] / "web" / "openapi.json"


def schema_of_server(home: Path) -> dict[str, Any]:
    """The schema of a server with all of its parts, and of the hub, without its version."""
    with serving(home) as server:
        whole: dict[str, Any] = server.ask("GET", "/api/openapi.json", 200)
    hub = schema_of_hub()
    schemas: dict[str, Any] = whole["components"]["schemas"]
    assert {
        name for name, one in hub["components"]["schemas"].items() if schemas.get(name, one) != one
    } == set()
    whole["paths"] |= hub["paths"]
    schemas |= hub["components"]["schemas"]
    whole["info"] = {"title": whole["info"]["title"], "version": ""}
    return whole


def schema_of_hub() -> dict[str, Any]:
    address = HubAddress(url="nats://127.0.0.1:4222", hospital=Hospital("clinic"))
    return create_hub_app(Config(), address, None).openapi()


def text_of(schema: dict[str, Any]) -> str:
    return json.dumps(schema, indent=2, ensure_ascii=False) + "\n"


def test_page_is_built_from_the_schema_that_the_server_has(tmp_path: Path) -> None:
    written = json.loads(OPENAPI_FILE.read_text(encoding="utf-8"))
    assert written == schema_of_server(tmp_path), (
        "web/openapi.json is not the server's schema. After a wanted change of its messages or limits: "
        "PYTHONPATH=. python tests/web/test_schema_is_current.py"
    )


def test_every_answer_in_json_has_a_schema_of_its_own(tmp_path: Path) -> None:
    schema = schema_of_server(tmp_path)
    nameless = [
        f"{method} {path}"
        for path, methods in schema["paths"].items()
        if path not in FREE_FORM
        for method, operation in methods.items()
        for status, answer in operation["responses"].items()
        if status.startswith("2")
        and not str(answer.get("content", {}).get("application/json", {"schema": "#/"})).count("#/")
    ]
    assert nameless == []
    assert {"LiveMessage", "DashboardMessage", "DeviationMessage"} <= set(schema["components"]["schemas"])


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as folder:
        OPENAPI_FILE.write_text(text_of(schema_of_server(Path(folder))), encoding="utf-8")
