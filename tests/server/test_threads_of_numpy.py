"""Number of threads of NumPy's matrix functions, which take cores from other work."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

REPOSITORY = Path(__file__).parents[2]
pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="threads are counted where Linux lists them")

THREADS = "OPENBLAS_NUM_THREADS"


def reported_by_process(**environment: str) -> list[str]:
    """Output of a process that has loaded the server and then NumPy: the setting, and its threads."""
    stored = {name: value for name, value in os.environ.items() if name != THREADS}
    reported = subprocess.run(
        [
            sys.executable,
            "-c",
            "import os, server, numpy, scipy.linalg;"
            f"print(os.environ['{THREADS}'], *os.listdir('/proc/self/task'))",
        ],
        cwd=REPOSITORY,
        env={**stored, **environment},
        capture_output=True,
        text=True,
        check=True,
    )
    return reported.stdout.split()


def test_a_process_that_loads_numpy_has_one_thread() -> None:
    setting, *threads = reported_by_process()
    assert (setting, len(threads)) == ("1", 1)


def test_who_sets_another_number_has_it() -> None:
    assert reported_by_process(**{THREADS: "2"})[0] == "2"
