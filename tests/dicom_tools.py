"""Programs of others that read what Coaxial writes: dcmtk's tools and Orthanc, both packages of Debian."""

import os
import shutil
from pathlib import Path

import pytest

# Debian has Orthanc where only root's path leads.
WHERE = os.pathsep.join([os.environ.get("PATH", os.defpath), "/usr/sbin", "/usr/local/sbin"])


def dicom_tool(name: str) -> Path:
    """Path of a program; without it the test is skipped, or fails in continuous integration."""
    found = shutil.which(name, path=WHERE)
    if found is not None:
        return Path(found)
    sentence = f"needs {name}: install the packages dcmtk and orthanc, as .make/find-dicom-tools does"
    if os.environ.get("CI") == "true":
        pytest.fail(sentence)
    pytest.skip(sentence)
