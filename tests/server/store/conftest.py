"""Fixtures: a store in a folder of the test, with a clock that the test sets."""

from collections.abc import Iterator
from datetime import UTC, datetime, timedelta
from pathlib import Path

import pytest

from server.store import CaseStore, Home


class Clock:
    """A clock that advances on request only."""

    def __init__(self) -> None:
        self.now = datetime(2026, 11, 21, 8, 0, 0, 250_000, tzinfo=UTC)

    def __call__(self) -> datetime:
        self.now += timedelta(milliseconds=1)
        return self.now


@pytest.fixture
def clock() -> Clock:
    return Clock()


@pytest.fixture
def home(tmp_path: Path) -> Iterator[Home]:
    with Home(tmp_path / "home") as home:
        yield home


@pytest.fixture
def store(home: Home, clock: Clock) -> Iterator[CaseStore]:
    with CaseStore(home, clock=clock) as store:
        yield store
