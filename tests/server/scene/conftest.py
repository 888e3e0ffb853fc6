"""The theatre made by hand, as a fixture."""

import pytest
from scene_theatre import Theatre, make_theatre


@pytest.fixture
def theatre() -> Theatre:
    return make_theatre()
