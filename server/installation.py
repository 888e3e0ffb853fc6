"""Differences between an installation from a wheel and a checkout."""

import hashlib
import os
import sys
from collections.abc import MutableMapping, Sequence
from importlib.metadata import PackageNotFoundError, distribution, version
from importlib.resources import files
from pathlib import Path

import platformdirs

from server.home_folder import home_folder

DISTRIBUTION = "coaxial"
PACKAGE = Path(str(files("server")))
CODE_CACHE_VARIABLE = "NUMBA_CACHE_DIR"
UNIT_EXECUTABLE = "/opt/coaxial/bin/coaxial"
SAFE_PATH_VARIABLE = "PYTHONSAFEPATH"


def product_version() -> str:
    """Return the installed version; "unknown" if the package is not installed."""
    try:
        return version(DISTRIBUTION)
    except PackageNotFoundError:
        return "unknown"


def file_candidates(packaged: str, in_checkout: str) -> tuple[Path, Path]:
    """Return where a file or folder lies in the installed package, and where it lies in a checkout."""
    return PACKAGE / packaged, PACKAGE.parent / in_checkout


def service_unit(executable: Path) -> str:
    """Return a systemd unit that starts this `coaxial`."""
    # systemd splits at spaces, and expands specifiers after a per cent sign.
    quoted = str(executable).replace("%", "%%")
    quoted = f'"{quoted}"' if " " in quoted else quoted
    return (PACKAGE / "coaxial.service").read_text(encoding="utf-8").replace(UNIT_EXECUTABLE, quoted)


def default_settings() -> str:
    """Return the text of config.yaml, with the default and the meaning of every key."""
    file = next(file for file in file_candidates("config.yaml", "config.yaml") if file.is_file())
    return file.read_text(encoding="utf-8")


def isolate_imports(environment: MutableMapping[str, str], path: Sequence[str]) -> None:
    """Make child processes ignore the current folder on import, unless this process imports from it.

    Otherwise a `server.py` in the folder in which an installed `coaxial` is started replaces the package in
    the tracking process. Python reads the variable before it extends the import path.
    """
    if not {"", str(Path.cwd())} & set(path):
        environment.setdefault(SAFE_PATH_VARIABLE, "1")


def place_code_cache(environment: MutableMapping[str, str], record: str | None) -> None:
    """Set the folder of Numba's compiled code for an installation; call it before Numba is imported.

    Numba checks only the file of a function, not those of its callees, so each content of the tracker has a
    folder of its own and an update cannot run old code. A checkout compiles beside its sources, and `make`
    deletes outdated code.

    Args:
        environment: The environment of this process. A folder that is set there already is used as it is.
        record: The text of the distribution's RECORD, with a hash of each installed file; None without one.
    """
    sources = sorted(
        line for line in (record or "").splitlines() if line.startswith("tracker/") and ".py," in line
    )
    if environment.get(CODE_CACHE_VARIABLE) or not sources:
        return
    name = f"compiled-{hashlib.sha256(chr(10).join(sources).encode()).hexdigest()[:16]}"
    for parent in (platformdirs.user_cache_path(DISTRIBUTION), home_folder() / "cache"):
        try:
            (parent / name).mkdir(parents=True, exist_ok=True)
        except OSError:
            continue
        if os.access(parent / name, os.W_OK):
            environment[CODE_CACHE_VARIABLE] = str(parent / name)
            return


def installed_record() -> str | None:
    """Return the text of the distribution's RECORD; None if Coaxial is not installed."""
    try:
        return distribution(DISTRIBUTION).read_text("RECORD")
    except PackageNotFoundError:
        return None


def prepare_process() -> None:
    """Apply `isolate_imports` and `place_code_cache` to this process and its children."""
    isolate_imports(os.environ, sys.path)
    place_code_cache(os.environ, installed_record())
