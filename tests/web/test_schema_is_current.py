"""The page's types are made from `web/openapi.json`: it must say what the server says.

After a wanted change of the messages, from the checkout's top folder:

    PYTHONPATH=. python tests/web/test_schema_is_current.py
"""

import json
from pathlib import Path
from typing import Any

from server.app import AppParts, create_app
from server.config import Config
from server.live import LiveHub

OPENAPI_FILE = Path(__file__).resolve().parents[2] / "web" / "openapi.json"
USED_BY_THE_PAGE = ("/api/dashboard", "/api/live")


def schema_of_server() -> dict[str, Any]:
    """What the server answers at `/api/openapi.json`, without what changes by itself (version, prose)."""
    schema = create_app(AppParts(hub=LiveHub(), config=Config())).openapi()
    schema["info"] = {"title": schema["info"]["title"], "version": ""}
    return schema


def text_of(schema: dict[str, Any]) -> str:
    return json.dumps(schema, indent=2, ensure_ascii=False) + "\n"


def test_page_is_built_from_the_schema_that_the_server_has() -> None:
    written = json.loads(OPENAPI_FILE.read_text(encoding="utf-8"))
    assert written == schema_of_server(), (
        "web/openapi.json is not what the server says; write it anew as the top of this file tells"
    )


def test_every_answer_that_the_page_reads_has_a_schema_of_its_own() -> None:
    paths = schema_of_server()["paths"]
    for path in USED_BY_THE_PAGE:
        content = paths[path]["get"]["responses"]["200"]["content"]["application/json"]
        assert content["schema"]["$ref"].startswith("#/components/schemas/"), path


if __name__ == "__main__":
    OPENAPI_FILE.write_text(text_of(schema_of_server()), encoding="utf-8")
