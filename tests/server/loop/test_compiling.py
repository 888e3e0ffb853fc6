"""The state of the compilation is read from the cache; missing functions are compiled by two processes."""

import os
from pathlib import Path
from types import SimpleNamespace

import pytest

from server.loop import compiling
from server.loop.compiling import PARTS_PER_PROCESS, Progress, compile_tracker, progress
from tracker.compiled import DISPATCHERS
from tracker.warm_up import Part


@pytest.fixture
def loop(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> SimpleNamespace:
    """The only loop: not compiled yet."""
    source = tmp_path / "kernels.py"
    source.touch()
    function = SimpleNamespace(
        __module__="tracker.somewhere.kernels",
        __qualname__="walk",
        __code__=SimpleNamespace(co_filename=str(source)),
    )
    one = SimpleNamespace(py_func=function, stats=SimpleNamespace(cache_path=str(tmp_path / "cache")))
    monkeypatch.setattr(compiling, "DISPATCHERS", [one])
    return one


def put_index(
    loop: SimpleNamespace, *, name: str = "kernels.walk-1.py311.nbi", older_by_s: float = 0.0
) -> None:
    index = Path(loop.stats.cache_path) / name
    index.parent.mkdir(exist_ok=True)
    index.touch()
    source_s = Path(loop.py_func.__code__.co_filename).stat().st_mtime
    os.utime(index, (source_s - older_by_s, source_s - older_by_s))


def test_the_environment_of_these_tests_is_compiled() -> None:
    assert progress().is_complete
    assert progress().total > 150


def test_no_loop_has_the_error_message_of_arrays_of_different_shapes() -> None:
    # Assigning an array to a part of another one compiles the message into the function and its callers.
    compiled = {
        file.name: file.read_bytes()
        for loop in DISPATCHERS
        for file in Path(loop.stats.cache_path).glob(
            f"*.{loop.py_func.__qualname__}-{loop.py_func.__code__.co_firstlineno}.*.nbc"
        )
    }
    assert len(compiled) >= len(DISPATCHERS)
    assert [name for name, code in compiled.items() if b"cannot assign slice" in code] == []


def test_a_loop_counts_once_its_index_is_there(loop: SimpleNamespace) -> None:
    assert progress() == Progress(done=0, total=1)
    put_index(loop, name="kernels.walk_on-1.py311.nbi")
    assert not progress().is_complete, "an index of another loop"
    put_index(loop)
    assert progress() == Progress(done=1, total=1)


def test_an_index_that_is_older_than_the_source_does_not_count(loop: SimpleNamespace) -> None:
    put_index(loop, older_by_s=1.0)
    assert not progress().is_complete


def test_what_is_not_compiled_is_compiled_by_processes_that_share_all_parts(
    loop: SimpleNamespace, monkeypatch: pytest.MonkeyPatch
) -> None:
    started: list[tuple[Part, ...]] = []
    reported: list[Progress] = []

    class Child:
        looks = 2

        def poll(self) -> int | None:
            self.looks -= 1
            if self.looks > 0:
                return None
            put_index(loop)
            return 0

    def child(parts: tuple[Part, ...]) -> Child:
        started.append(parts)
        return Child()

    monkeypatch.setattr(compiling, "_child", child)
    monkeypatch.setattr(compiling, "warm_up", lambda: None)
    monkeypatch.setattr(compiling, "POLL_INTERVAL_S", 0.0)
    compile_tracker(reported.append)
    assert started == list(PARTS_PER_PROCESS)
    assert sorted(part for share in started for part in share) == sorted(Part)
    assert reported[0] == Progress(done=0, total=1)
    assert reported[-1] == Progress(done=1, total=1)
    compile_tracker()
    assert len(started) == len(PARTS_PER_PROCESS), "what is compiled is not compiled again"
