"""Values of the program as JSON and back."""

import json
import math
from collections import deque
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np
import pytest

from server.live import Problem
from server.recording_file import CodecError, decoded_value, encoded_value
from server.recording_file.codec import Value
from tracker.navigation import Absent, AbsentReason
from tracker.navigation.alarms import AlarmLimits
from tracker.navigation.monitoring import LastSeen


def again(value: Value) -> Value:
    return decoded_value(json.loads(json.dumps(encoded_value(value))))


@pytest.mark.parametrize(
    "value",
    [
        0.1 + 0.2,
        5e-324,
        -math.inf,
        True,
        "Säge",
        b"\x00\xff",
        (1, [2, {"a": None}], frozenset({"x"})),
        {1: {"x"}, (2, 3): deque([1.5], maxlen=4)},
        slice(3, 9, None),
        Absent(reason=AbsentReason.NO_PLAN),
        AlarmLimits(hysteresis_mm=0.25),
        Problem(code="A", message="b", remedy="c", context={"n": [1]}),
        LastSeen(seen_at_s=MappingProxyType({"drill": 1.5})),
    ],
    ids=repr,
)
def test_a_value_comes_back_equal_and_of_its_type(value: Value) -> None:
    assert again(value) == value
    assert type(again(value)) is type(value)


def test_an_array_comes_back_with_its_bits_and_its_order() -> None:
    array = np.asfortranarray(np.array([[0.1, np.nan], [-0.0, np.inf], [1e-310, 3.0]]))
    array.flags.writeable = False
    back = again(array)
    assert back.tobytes() == array.tobytes()
    assert back.flags.f_contiguous
    assert not back.flags.writeable
    assert again(np.zeros((0, 3), np.float32)).shape == (0, 3)


@dataclass
class Elsewhere:
    """A class of a module that must not be recorded."""

    x: int = 0


def test_a_class_of_another_module_is_neither_written_nor_made() -> None:
    with pytest.raises(CodecError, match="cannot be recorded"):
        encoded_value(Elsewhere())
    for name in ("subprocess:Popen", "tracker.pipeline:os.system", f"{__name__}:Elsewhere"):
        with pytest.raises(CodecError):
            decoded_value({"class": name, "fields": {}})


def test_nothing_but_a_dataclass_is_made_as_one() -> None:
    with pytest.raises(CodecError, match="is not a dataclass"):
        decoded_value({"class": "tracker.pipeline.tracker:Tracker", "fields": {}})


def test_a_field_that_this_version_lacks_is_an_error_and_a_new_one_has_its_default() -> None:
    content = encoded_value(AlarmLimits(hysteresis_mm=0.25))
    del content["fields"]["realarm_after_mm"]
    assert decoded_value(content) == AlarmLimits(hysteresis_mm=0.25)
    content["fields"]["of_another_version"] = 1
    with pytest.raises(CodecError, match="AlarmLimits has no of_another_version"):
        decoded_value(content)


@pytest.mark.parametrize(
    "content",
    [
        {"array": "AAAA", "dtype": "<f8", "shape": [3], "order": "C", "writeable": True},
        {"array": "", "dtype": "O", "shape": [0], "order": "C", "writeable": True},
        {"enum": "tracker.navigation.snapshot:AbsentReason", "value": "NOBODY_KNOWS"},
        {"unknown": 1},
        {"tuple": [{}]},
        {"deque": [], "maxlen": 10**30},
        {"float": 10**400},
        {"class": "tracker.navigation.snapshot:Absent", "fields": {}},
    ],
    ids=lambda content: next(iter(content)),
)
def test_damaged_content_is_an_error(content: Value) -> None:
    with pytest.raises(CodecError):
        decoded_value(content)
