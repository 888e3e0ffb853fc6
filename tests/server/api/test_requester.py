"""The author of an action is the session's user, at every address that accepts a name."""

import asyncio
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from pydantic import create_model
from starlette.requests import HTTPConnection

from server.api.requester import maker_in_query, set_requester
from server.image_file import png_bytes
from server.security import Person, Role
from server.security.person import STATE_KEY
from server.store import DocumentKind
from server.stream.message import Message
from tests.server.security.guarded_app import Guarded, guarded

ITO = Person(id="o1", name="Dr Ito", role=Role.OPERATOR)
OTHER = "Dr Somebody Else"
NAMES = {"made_by", "by", "signed_by", "done_by", "author", "who", "person", "person_name", "signer"}


@pytest.fixture(scope="module")
def house(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Guarded]:
    with guarded(tmp_path_factory.mktemp("home")) as house:
        yield house


@pytest.fixture(scope="module")
def ito(house: Guarded) -> dict[str, str]:
    return house.bearer(name=ITO.name)


@pytest.fixture(scope="module")
def case_id(house: Guarded, ito: dict[str, str]) -> str:
    case = house.door.post("/api/cases", json={"name": "own"}, headers=ito).json()
    assert house.door.post(f"/api/cases/{case['id']}/open", headers=ito).status_code == 200
    return str(case["id"])


def operations_of(described: dict[str, Any]) -> Iterator[tuple[str, dict[str, Any]]]:
    for path, methods in described["paths"].items():
        for method, operation in methods.items():
            yield f"{method.upper()} {path}", operation


def schemas_in(described: dict[str, Any], node: object, found: set[str]) -> set[str]:
    """Names of all schemas used by a part of the description."""
    if isinstance(node, dict):
        name = str(node.get("$ref", "")).rpartition("/")[2]
        if name and name not in found:
            found.add(name)
            schemas_in(described, described["components"]["schemas"][name], found)
        for inner in node.values():
            schemas_in(described, inner, found)
    elif isinstance(node, list):
        for inner in node:
            schemas_in(described, inner, found)
    return found


def every(kind: type[Message]) -> Iterator[type[Message]]:
    for one in kind.__subclasses__():
        yield one
        yield from every(one)


def read_as_ito(message: type[Message], field: str) -> list[object]:
    """Value of a message's name field in a request of Dr Ito, with another name and with none."""
    described = message.model_fields[field]
    only = create_model("Only", **{field: (described.annotation, described)})  # pyrefly: ignore[no-matching-overload]  # by name

    async def read() -> list[object]:
        await set_requester(HTTPConnection({"type": "http", "state": {STATE_KEY: ITO}}))
        return [getattr(only.model_validate(said), field) for said in ({field: OTHER}, {})]

    return asyncio.run(read())


def test_no_body_names_another_than_who_is_signed_in(house: Guarded) -> None:
    described = house.app.openapi()
    messages = {one.__name__: one for one in every(Message)}
    # Schemas of equal name are distinguished by their modules.
    messages |= {f"{one.__module__}.{one.__name__}".replace(".", "__"): one for one in every(Message)}
    requested: set[str] = set()
    for _, operation in operations_of(described):
        schemas_in(described, operation.get("requestBody", {}), requested)
    found = {
        (name, field)
        for name in requested
        for field in described["components"]["schemas"][name].get("properties", {})
        if field in NAMES or field.endswith("_by")
    }
    assert len(found) > 15, "too few bodies: is the description whole?"
    for name, field in sorted(found):
        assert read_as_ito(messages[name], field) == [ITO.name, ITO.name], (name, field)


def test_no_query_names_another_than_who_is_signed_in(house: Guarded) -> None:
    named = {
        address
        for address, operation in operations_of(house.app.openapi())
        for one in operation.get("parameters", [])
        if one["in"] != "path" and (one["name"] in NAMES or one["name"].endswith("_by"))
    }
    assert len(named) > 6, "too few queries: is the description whole?"
    believing = set(named)
    for route in routes_of(house.app.router.routes):
        dependant = getattr(route, "dependant", None)
        if dependant is None:
            continue
        takes = any(one.call is maker_in_query for one in dependant.dependencies)
        own = any(one.name in NAMES or one.alias in NAMES for one in dependant.query_params)
        if takes and not own:
            believing -= {f"{method} {route.path}" for method in route.methods}
    assert believing == set()


def routes_of(routes: Any) -> Iterator[Any]:  # noqa: ANN401  of FastAPI, of several kinds
    for route in routes:
        inner = getattr(route, "original_router", None)
        if inner is None:
            yield route
        else:
            yield from routes_of(inner.routes)


def test_what_is_withdrawn_is_withdrawn_by_the_session(
    house: Guarded, ito: dict[str, str], case_id: str
) -> None:
    for said in ({"by": OTHER}, {}):
        stored = house.store.put(case_id, DocumentKind.CT, "main", {}, made_by="abe")
        answer = house.door.post(
            f"/api/cases/{case_id}/documents/{stored.id}/withdrawal",
            json={"reason": "wrong", **said},
            headers=ito,
        )
        assert answer.json()["heading"]["withdrawn"]["by"] == ITO.name


@pytest.mark.usefixtures("case_id")
@pytest.mark.parametrize("said", [{"made_by": OTHER}, {}])
def test_what_is_sent_is_made_by_the_session(
    house: Guarded, ito: dict[str, str], said: dict[str, str]
) -> None:
    requested = {"name": "cap", "side_mm": "20", **said}
    answer = house.door.post("/api/markers", params=requested, content=chequered(), headers=ito)
    assert (answer.status_code, answer.json().get("made_by")) == (201, ITO.name), answer.text


def chequered() -> bytes:
    cells = np.random.default_rng(1).integers(0, 2, (8, 8), dtype=np.uint8) * 255
    cells[0], cells[-1], cells[:, 0], cells[:, -1] = 0, 0, 0, 0
    return png_bytes(np.kron(cells, np.ones((40, 40), dtype=np.uint8)))


def test_without_sign_in_a_name_is_required(tmp_path_factory: pytest.TempPathFactory) -> None:
    with guarded(tmp_path_factory.mktemp("open"), required=False) as house:
        case = house.door.post("/api/cases", json={"name": "own"}).json()
        stored = house.store.put(case["id"], DocumentKind.CT, "main", {}, made_by="abe")
        path = f"/api/cases/{case['id']}/documents/{stored.id}/withdrawal"
        for said in ({}, {"by": ""}):
            rejected = house.door.post(path, json={"reason": "wrong", **said})
            assert (rejected.status_code, rejected.json()["message"]) == (422, "body.by: Field required")
        rejected = house.door.delete("/api/plan/active-channel")
        assert (rejected.status_code, rejected.json()["message"]) == (422, "query.made_by: Field required")
        answer = house.door.post(path, json={"reason": "wrong", "by": OTHER})
        assert answer.json()["heading"]["withdrawn"]["by"] == OTHER
