"""The page's types are made from `web/openapi.json`: it must say what the server says.

The file holds the answers that the page reads, and no others. After a wanted change of them, from the
checkout's top folder:

    PYTHONPATH=. python tests/web/test_schema_is_current.py
"""

import json
import re
from pathlib import Path
from typing import Any

from server.app import AppParts, create_app
from server.config import Config
from server.live import LiveHub

OPENAPI_FILE = Path(__file__).resolve().parents[2] / "web" / "openapi.json"
USED_BY_THE_PAGE = (
    "/api/dashboard",
    "/api/live",
    "/api/alarms/acknowledgement",
    "/api/alarms/pause",
    "/api/alarms/resumption",
    "/api/alarms/screens",
)
REFERENCE = re.compile(r'"#/components/schemas/(\w+)"')


def schema_of_server() -> dict[str, Any]:
    """What the server says of the answers that the page reads."""
    whole = create_app(AppParts(hub=LiveHub(), config=Config())).openapi()
    paths = {path: whole["paths"][path] for path in USED_BY_THE_PAGE}
    schemas = whole["components"]["schemas"]
    return {
        "openapi": whole["openapi"],
        "info": {"title": whole["info"]["title"], "version": ""},
        "paths": paths,
        "components": {"schemas": {name: schemas[name] for name in sorted(reached(paths, schemas))}},
    }


def reached(start: object, schemas: dict[str, Any]) -> set[str]:
    """Names of all schemas that are referred to from here on."""
    names: set[str] = set()
    fresh = set(REFERENCE.findall(json.dumps(start)))
    while fresh:
        names |= fresh
        fresh = set(REFERENCE.findall(json.dumps([schemas[name] for name in fresh]))) - names
    return names


def text_of(schema: dict[str, Any]) -> str:
    return json.dumps(schema, indent=2, ensure_ascii=False) + "\n"


def test_page_is_built_from_the_schema_that_the_server_has() -> None:
    written = json.loads(OPENAPI_FILE.read_text(encoding="utf-8"))
    assert written == schema_of_server(), (
        "web/openapi.json is not what the server says; write it anew as the top of this file tells"
    )


def test_every_answer_that_the_page_reads_has_a_schema_of_its_own() -> None:
    schema = schema_of_server()
    for path in USED_BY_THE_PAGE:
        for asked in schema["paths"][path].values():
            content = asked["responses"]["200"]["content"]["application/json"]
            assert content["schema"]["$ref"].startswith("#/components/schemas/"), path
    assert {"LiveMessage", "DashboardMessage", "DeviationMessage"} <= set(schema["components"]["schemas"])


if __name__ == "__main__":
    OPENAPI_FILE.write_text(text_of(schema_of_server()), encoding="utf-8")
