"""The whole API against its own schema: no internal error, and no undocumented answer.

The test sends each address the same few requests each time. A search with more of them, others each time:

    PYTHONPATH=. python tests/procedure/test_api_by_its_schema.py --tries 100
"""

import argparse
import tempfile
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import schemathesis
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st
from schemathesis.checks import not_a_server_error
from schemathesis.core.result import Ok
from schemathesis.specs.openapi.checks import (
    content_type_conformance,
    response_schema_conformance,
    status_code_conformance,
)

from tests.procedure.conftest import serving
from tests.served import served

# A rejection of schema-valid input is correct: what a case allows is not part of the schema.
CHECKS = [
    not_a_server_error,
    status_code_conformance,
    content_type_conformance,
    response_schema_conformance,
]
TRIES = 6
# An endless stream.
ENDLESS = "/video/{camera}.mjpg"
FILES = ("application/zip", "model/stl", "model/obj", "model/ply")

for kind in FILES:
    schemathesis.openapi.media_type(kind, st.binary(max_size=200))


@contextmanager
def schema_of_server(folder: Path) -> Iterator[schemathesis.BaseSchema]:
    """A server with an open case and a live image."""
    with serving(folder) as server:
        case = server.ask("POST", "/api/cases", 201, json={"name": "somebody"})
        server.ask("POST", f"/api/cases/{case['id']}/open", 200)
        server.show(at_s=1.0, image=np.zeros((720, 1280, 3), dtype=np.uint8), rate_hz=30.0)
        described = server.ask("GET", "/api/openapi.json", 200)
        with served(server.door.app, begun=True) as port:  # pyrefly: ignore[bad-argument-type]  # a FastAPI app
            schema = schemathesis.openapi.from_dict(described)
            schema.config.update(base_url=f"http://127.0.0.1:{port}")
            yield schema


def request_every_address(
    schema: schemathesis.BaseSchema, *, tries: int, is_repeated: bool
) -> tuple[Counter[str], Counter[str]]:
    """Check the answers to requests that the schema allows; return the number of all and of accepted ones."""
    requested: Counter[str] = Counter()
    accepted: Counter[str] = Counter()

    def hold_to_its_word(case: schemathesis.Case[Any]) -> None:
        answer = case.call()
        requested[case.operation.label] += 1
        accepted[case.operation.label] += answer.status_code < 300
        case.validate_response(answer, checks=CHECKS)

    sampled = settings(
        max_examples=tries,
        derandomize=is_repeated,
        deadline=None,
        database=None,
        suppress_health_check=list(HealthCheck),
        phases=[Phase.explicit, Phase.generate],
    )
    for found in schema.get_all_operations():
        assert isinstance(found, Ok), found
        operation = found.ok()
        if operation.path != ENDLESS:
            sampled(given(operation.as_strategy())(hold_to_its_word))()
    return requested, accepted


def test_every_address_answers_as_it_is_described(tmp_path: Path) -> None:
    with schema_of_server(tmp_path) as schema:
        requested, accepted = request_every_address(schema, tries=TRIES, is_repeated=True)
    assert len(requested) > 100, "too few addresses were asked: is the description whole?"
    assert sum(count > 0 for count in accepted.values()) > 25, "nearly everything was refused"


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("--tries", type=int, default=100, help="requests to each address")
    with tempfile.TemporaryDirectory() as home, schema_of_server(Path(home)) as described:
        sent, _ = request_every_address(described, tries=parser.parse_args().tries, is_repeated=False)
    print(f"{sent.total()} requests to {len(sent)} addresses: all answers are as described")  # noqa: T201
