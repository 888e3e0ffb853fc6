"""A number has the same format wherever it is shown."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from server.number_format import NOT_KNOWN, format_number


@pytest.mark.parametrize(
    ("value", "shown"),
    [
        pytest.param(0.04, "0.0", id="rounds-down"),
        pytest.param(0.05, "0.1", id="just-above-half-in-binary"),
        pytest.param(0.25, "0.3", id="half-goes-away-from-zero"),
        pytest.param(-0.25, "-0.3", id="on-both-sides"),
        pytest.param(-0.04, "0.0", id="never-a-negative-zero"),
        pytest.param(12.349, "12.3", id="two-digits"),
        pytest.param(-123.45, "-123.5", id="long"),
        pytest.param(math.inf, NOT_KNOWN, id="infinite"),
        pytest.param(math.nan, NOT_KNOWN, id="not-a-number"),
    ],
)
def test_a_number_is_shown_with_one_decimal(value: float, shown: str) -> None:
    assert format_number(value) == shown


@given(st.floats(-1e6, 1e6))
def test_what_is_shown_is_within_half_a_tenth_of_the_truth(value: float) -> None:
    assert abs(float(format_number(value)) - value) <= 0.05 + 1e-9
    assert format_number(value) != "-0.0"
