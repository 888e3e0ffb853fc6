"""Real recordings, from a folder beside the checkout or named by `COAXIAL_DATA`."""

import os
from pathlib import Path

import pytest


def real_data_file(*parts: str) -> Path:
    """Path of a recording; without it the test is skipped, or fails if recordings are required."""
    beside = Path(__file__).resolve().parents[2] / "shared" / "data"
    path = Path(os.environ.get("COAXIAL_DATA") or beside).joinpath(*parts)
    if path.exists():
        return path
    sentence = f"needs the real recording {'/'.join(parts)}: name its folder with COAXIAL_DATA"
    if os.environ.get("COAXIAL_REQUIRE_DATA") == "1":
        pytest.fail(sentence)
    pytest.skip(sentence)
