"""Small YAML files that the program wrote, or a person: read in one way, whatever they hold."""

from pathlib import Path

import yaml

from tracker.errors import InvalidInput


def yaml_in(path: Path, *, what: str, code: str, remedy: str) -> object:
    """What a YAML or JSON file holds; JSON is YAML too.

    Args:
        path: of the file.
        what: it should be, in words: "camera file".
        code: of the error.
        remedy: what to do instead.

    Raises:
        InvalidInput: `code`; the message names the file.
    """
    context: dict[str, object] = {"file": str(path)}
    try:
        values: object = yaml.safe_load(path.read_text(encoding="utf-8"))
    except OSError as error:
        why = (error.strerror or str(error)).lower()
        raise InvalidInput(code, f"the {what} {path} cannot be read: {why}", remedy, context) from error
    except (ValueError, RecursionError, yaml.YAMLError) as error:
        # No text in UTF-8, a date that there is not, lists in lists without end.
        message = f"the {what} {path} is neither YAML nor JSON that can be read"
        raise InvalidInput(code, message, remedy, context) from error
    return values
