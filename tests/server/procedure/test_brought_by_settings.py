"""What the settings bring is what the tracking process is prepared with."""

import pytest

from server.config import Config
from server.procedure.steps import brought_by
from server.setup import build_setup


@pytest.mark.parametrize("reference", [False, True], ids=["camera-alone", "beside-a-reference"])
@pytest.mark.parametrize("brings_setup", [False, True], ids=["unknowing", "knowing"])
def test_the_procedure_and_tracking_agree_on_what_there_is(*, reference: bool, brings_setup: bool) -> None:
    config = Config.model_validate({"rehearsal": {"reference": reference, "brings_setup": brings_setup}})
    brought, prepared = brought_by(config), build_setup(config)
    assert brought.reference == prepared.reference
    assert brought.tools == set(prepared.tools)
    assert brought.has_camera is (prepared.camera is not None)
