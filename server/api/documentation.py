"""`/api/docs`: HTML documentation of the API, rendered from its OpenAPI document without scripts.

Swagger UI and ReDoc load scripts from a CDN and need inline scripts, which the Content-Security-Policy of
this server forbids.
"""

from collections.abc import Callable, Iterable, Mapping
from html import escape
from typing import Any

from fastapi import APIRouter, FastAPI
from fastapi.responses import HTMLResponse

from server.api.errors import PROBLEM_CONTENT, STATUS_TEXTS

Schema = Mapping[str, Any]

FRAMEWORK_ERROR_SCHEMA = "HTTPValidationError"
FRAMEWORK_SCHEMAS = (FRAMEWORK_ERROR_SCHEMA, "ValidationError")
PROBLEM_422 = {"description": STATUS_TEXTS[422], "content": PROBLEM_CONTENT}
# Every request with a body can time out.
PROBLEM_408 = {"description": STATUS_TEXTS[408], "content": PROBLEM_CONTENT}
# Every change is written to the audit log before the response.
PROBLEM_507 = {"description": STATUS_TEXTS[507], "content": PROBLEM_CONTENT}

STYLE = """
:root { color-scheme: light dark; font: 16px/1.5 system-ui, sans-serif; }
body { max-width: 60rem; margin: 2rem auto; padding: 0 1rem; }
code, pre { font-family: ui-monospace, monospace; font-size: 0.92em; }
h2, h3 { border-top: 1px solid #8886; padding-top: 1rem; }
table { border-collapse: collapse; width: 100%; }
td, th { text-align: left; vertical-align: top; padding: 0.2rem 0.8rem 0.2rem 0; }
.method { font-weight: 700; }
p.notice { font-weight: 700; }
"""


class DocumentedApi(FastAPI):
    """Application whose OpenAPI document describes error responses as `ProblemMessage`."""

    def openapi(self) -> dict[str, Any]:
        """Return the OpenAPI document with the validation error of FastAPI replaced by `ProblemMessage`."""
        if self.openapi_schema is None:
            document = super().openapi()
            for method, operation in (
                one for methods in document["paths"].values() for one in methods.items()
            ):
                answers = operation["responses"]
                if method != "get":
                    answers.setdefault("507", PROBLEM_507)
                if "requestBody" in operation:
                    answers.setdefault("408", PROBLEM_408)
                if FRAMEWORK_ERROR_SCHEMA in str(answers.get("422")):
                    answers["422"] = PROBLEM_422
            for name in FRAMEWORK_SCHEMAS:
                document["components"]["schemas"].pop(name, None)
            self.openapi_schema = document
        return self.openapi_schema


def documentation_router(openapi: Callable[[], dict[str, Any]], *, openapi_path: str) -> APIRouter:
    """Return the router of `GET /api/docs`."""
    router = APIRouter(prefix="/api", tags=["page"])

    @router.get("/docs", response_class=HTMLResponse, include_in_schema=False)
    async def documentation() -> HTMLResponse:
        return HTMLResponse(documentation_page(openapi(), openapi_path=openapi_path))

    return router


def documentation_page(document: Mapping[str, Any], *, openapi_path: str) -> str:
    """Return the HTML page of an OpenAPI document."""
    title = f"{document['info']['title']} {document['info']['version']}"
    schemas: Mapping[str, Schema] = document.get("components", {}).get("schemas", {})
    parts = [
        f"<h1>{escape(title)}</h1>",
        *_paragraphs(document["info"].get("description", "")),
        f'<p>For machines: <a href="{escape(openapi_path)}">{escape(openapi_path)}</a></p>',
        "<h2>Addresses</h2>",
        *(
            _operation(method, path, operation)
            for path, methods in document["paths"].items()
            for method, operation in methods.items()
        ),
        "<h2>Messages</h2>",
        *(_schema(name, schema) for name, schema in schemas.items()),
    ]
    return (
        f'<!doctype html><html lang="en"><head><meta charset="utf-8"><title>{escape(title)}</title>'
        '<meta name="viewport" content="width=device-width, initial-scale=1"><link rel="icon" href="data:,">'
        f"<style>{STYLE}</style></head><body>{''.join(parts)}</body></html>"
    )


def _paragraphs(words: str) -> Iterable[str]:
    for paragraph in words.strip().split("\n\n"):
        if paragraph.startswith("    "):
            yield f"<pre>{escape(paragraph)}</pre>"
        elif paragraph:
            # Every second piece between backticks is code.
            pieces = escape(paragraph).split("`")
            marked = (f"<code>{piece}</code>" if index % 2 else piece for index, piece in enumerate(pieces))
            yield f"<p>{''.join(marked)}</p>"


def _operation(method: str, path: str, operation: Mapping[str, Any]) -> str:
    rows = [
        _row(
            f"<code>{escape(parameter['name'])}</code> ({escape(parameter['in'])})",
            _type(parameter.get("schema", {})),
        )
        for parameter in operation.get("parameters", [])
    ]
    rows += [
        _row(f"answers {escape(status)}", f"{escape(answer.get('description', ''))} {_answer_type(answer)}")
        for status, answer in operation.get("responses", {}).items()
    ]
    head = f'<span class="method">{escape(method.upper())}</span> <code>{escape(path)}</code>'
    words = "".join(_paragraphs(operation.get("description", "")))
    return f"<h3>{head}</h3>{words}<table>{''.join(rows)}</table>"


def _answer_type(answer: Mapping[str, Any]) -> str:
    return ", ".join(
        _type(content["schema"]) if content.get("schema") else f"<code>{escape(media)}</code>"
        for media, content in answer.get("content", {}).items()
    )


def _schema(name: str, schema: Schema) -> str:
    needed = set(schema.get("required", []))
    rows = [
        _row(
            f"<code>{escape(key)}</code>{'' if key in needed else ' (optional)'}",
            f"{_type(value)} {escape(value.get('description', ''))}",
        )
        for key, value in schema.get("properties", {}).items()
    ]
    if "enum" in schema:
        rows.append(_row("one of", ", ".join(f"<code>{escape(str(v))}</code>" for v in schema["enum"])))
    words = "".join(_paragraphs(schema.get("description", "")))
    return f'<h3 id="{escape(name)}"><code>{escape(name)}</code></h3>{words}<table>{"".join(rows)}</table>'


def _type(schema: Schema) -> str:
    """Return a short description of the type of a schema, with a link if it is named."""
    if "$ref" in schema:
        name = escape(schema["$ref"].rsplit("/", 1)[-1])
        return f'<a href="#{name}"><code>{name}</code></a>'
    for choice in ("anyOf", "oneOf", "allOf"):
        if choice in schema:
            return " or ".join(_type(option) for option in schema[choice])
    if "const" in schema:
        return f"<code>{escape(repr(schema['const']))}</code>"
    if schema.get("type") == "array":
        return f"list of {_type(schema.get('items', {}))}"
    if schema.get("type") == "object" and isinstance(schema.get("additionalProperties"), Mapping):
        return f"{_type(schema['additionalProperties'])} by name"
    return f"<code>{escape(str(schema.get('type', 'anything')))}</code>"


def _row(left: str, right: str) -> str:
    return f"<tr><td>{left}</td><td>{right}</td></tr>"
