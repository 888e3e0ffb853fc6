"""The theatre made by hand, as a fixture."""

import pytest

from tests.server.scene.scene_theatre import Theatre, make_theatre


@pytest.fixture
def theatre() -> Theatre:
    return make_theatre()
