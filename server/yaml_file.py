"""Read small YAML or JSON files with uniform error messages."""

from pathlib import Path

import yaml

from tracker.errors import InvalidInput


def yaml_in(path: Path, *, what: str, code: str, remedy: str) -> object:
    """Parse a YAML or JSON file (JSON is a subset of YAML).

    Args:
        path: The file.
        what: Kind of file for the message, such as "camera file".
        code: Error code.
        remedy: Remedy of the error.

    Raises:
        InvalidInput: `code`; the message names the file.
    """
    context: dict[str, object] = {"file": str(path)}
    try:
        return parsed_yaml(path.read_text(encoding="utf-8"))
    except OSError as error:
        why = (error.strerror or str(error)).lower()
        raise InvalidInput(code, f"the {what} {path} cannot be read: {why}", remedy, context) from error
    except ValueError as error:
        message = f"the {what} {path} is neither valid YAML nor JSON"
        raise InvalidInput(code, message, remedy, context) from error


def parsed_yaml(text: str) -> object:
    """Return the values of YAML or JSON.

    Raises:
        ValueError: it is neither.
    """
    try:
        values: object = yaml.safe_load(text)
    except (RecursionError, yaml.YAMLError) as error:
        # Nested too deeply; an invalid date is a ValueError by itself.
        raise ValueError(str(error)) from error
    return values
