"""Each default stated in config.yaml equals the default in the code."""

from pathlib import Path

import yaml

from server.config import Config

ROOT = Path(__file__).parents[2]


def test_the_config_that_is_shown_is_the_config_that_is_built_in() -> None:
    shown = yaml.safe_load((ROOT / "config.yaml").read_text(encoding="utf-8"))
    assert shown == Config().model_dump(mode="json")
