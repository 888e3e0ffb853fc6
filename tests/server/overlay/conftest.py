"""Fixtures: the drill is assessed in all drawn images."""

from collections.abc import Callable
from functools import partial

import pytest

from tracker.navigation import NavigationSnapshot


@pytest.fixture(scope="session")
def snapshot_of(snapshot_of: Callable[..., NavigationSnapshot]) -> Callable[..., NavigationSnapshot]:
    return partial(snapshot_of, judged=True)
