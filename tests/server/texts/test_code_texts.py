"""Each value that reaches a sentence by its code has a text."""

from collections.abc import Mapping
from enum import StrEnum

import pytest

from server.procedure.state import StepName
from server.store import DocumentKind
from server.texts import Text
from server.texts.steps import CONFIRM, KINDS, METHODS, STEPS
from tracker.registration import AnchoredTo, Method


@pytest.mark.parametrize(
    ("name", "texts", "values"),
    [
        pytest.param("CONFIRM", CONFIRM, AnchoredTo, id="anchors"),
        pytest.param("KINDS", KINDS, DocumentKind, id="documents"),
        pytest.param("METHODS", METHODS, Method, id="registration-methods"),
        pytest.param("STEPS", STEPS, StepName, id="steps"),
    ],
)
def test_each_value_has_a_text(name: str, texts: Mapping[str, Text], values: type[StrEnum]) -> None:
    differing = set(texts) ^ {one.value for one in values}
    assert not differing, f"server/texts/steps.py, {name}: add or remove {sorted(differing)}"
