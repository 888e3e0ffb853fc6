"""The report of a soak: what has grown since the first quarter is counted."""

from dataclasses import replace
from typing import Any

import pytest

from tests.procedure.soak import Sample, _report

AT_REST = Sample(at_s=0.0, web_mb=200.0, descriptors=30, threads=12, processes=4, files=9)


def exceeded(*, age_ms: float = 50.0, left: tuple[str, ...] = (), **last: Any) -> int:  # noqa: ANN401  fields
    """Limits that a soak of 100 s exceeds whose last sample and last ages are these."""
    samples = [replace(AT_REST, at_s=float(at)) for at in range(0, 100, 10)]
    samples.append(replace(AT_REST, at_s=100.0, **last))
    ages = [(float(at), 50.0 if at < 70 else age_ms) for at in range(100)]
    return _report(samples, ages, left, kills=0, began_s=0.0)


@pytest.mark.parametrize(
    ("changed", "count"),
    [
        pytest.param({}, 0, id="nothing"),
        pytest.param({"web_mb": 209.0, "age_ms": 60.0}, 0, id="within-the-limits"),
        pytest.param({"web_mb": 211.0}, 1, id="memory"),
        pytest.param({"descriptors": 31, "threads": 13}, 2, id="descriptors-and-threads"),
        pytest.param({"processes": 5, "files": 10}, 2, id="processes-and-files"),
        pytest.param({"age_ms": 70.0}, 1, id="ages"),
        pytest.param({"left": ("process 7 of the killed server lives on",)}, 1, id="a-process-that-is-left"),
        pytest.param({"descriptors": 3, "web_mb": 50.0}, 0, id="less"),
    ],
)
def test_what_has_grown_since_the_first_quarter_is_counted(changed: dict[str, Any], count: int) -> None:
    assert exceeded(**changed) == count
