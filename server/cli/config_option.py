"""The option of all commands that read the settings file."""

from pathlib import Path
from typing import Annotated

import typer

ConfigOption = Annotated[
    Path | None,
    typer.Option("--config", help="Settings file; default: ./config.yaml if it exists.", metavar="FILE"),
]
