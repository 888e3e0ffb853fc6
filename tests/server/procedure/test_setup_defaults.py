"""The set-up of the settings prepares the tracking process."""

import pytest

from server.config import Config
from server.procedure.steps import defaults_from_config
from server.setup import build_setup
from tracker.plan import Channel


@pytest.mark.parametrize("reference", [False, True], ids=["camera-alone", "beside-a-reference"])
@pytest.mark.parametrize("provides_setup", [False, True], ids=["unknowing", "knowing"])
def test_the_procedure_and_tracking_agree_on_what_there_is(*, reference: bool, provides_setup: bool) -> None:
    config = Config.model_validate({"rehearsal": {"reference": reference, "provides_setup": provides_setup}})
    defaults, prepared = defaults_from_config(config), build_setup(config)
    assert defaults.reference == prepared.reference
    assert defaults.tools == set(prepared.tools)
    assert defaults.has_camera is (prepared.camera is not None)
    assert defaults.has_plan is isinstance(prepared.channel, Channel)
