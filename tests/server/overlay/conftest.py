"""The drill is judged in all that is drawn here."""

from collections.abc import Callable
from functools import partial

import pytest

from tracker.navigation import NavigationSnapshot


@pytest.fixture(scope="session")
def snapshot_of(snapshot_of: Callable[..., NavigationSnapshot]) -> Callable[..., NavigationSnapshot]:
    return partial(snapshot_of, judged=True)
