"""Location of the data folder."""

import os
from collections.abc import Mapping
from pathlib import Path

import platformdirs

FOLDER_VARIABLE = "COAXIAL_HOME"


def home_folder(environment: Mapping[str, str] = os.environ) -> Path:
    """Return the data folder: `COAXIAL_HOME`, or the user data directory of the system."""
    named = environment.get(FOLDER_VARIABLE, "").strip()
    return Path(named).expanduser().absolute() if named else platformdirs.user_data_path("coaxial")
