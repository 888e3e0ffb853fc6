"""Read small YAML or JSON files with uniform error messages."""

import re
from collections.abc import Collection, Mapping
from pathlib import Path

import yaml

from tracker.errors import InvalidInput

# A second of parsing; the files that are read have a few kB.
MAX_CHARACTERS = 2**20
MAX_PAIRS, MAX_VALUES = 10_000, 200_000
# The largest float has 1024.
MAX_BITS = 1023
LONE_SURROGATE = re.compile("[\ud800-\udfff]")


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


class BoundedLoader(yaml.SafeLoader):
    """SafeLoader for texts of strangers: merged mappings (`<<`) cannot multiply without end."""

    def flatten_mapping(self, node: yaml.MappingNode) -> None:
        """Insert the pairs of merged mappings."""
        super().flatten_mapping(node)
        if len(node.value) > MAX_PAIRS:
            raise yaml.YAMLError(f"merged mappings have more than {MAX_PAIRS} keys")


def parsed_yaml(text: str, loader: type[BoundedLoader] = BoundedLoader) -> object:
    """Return the values of YAML or JSON.

    Raises:
        ValueError: it is neither, is too long or nested too deeply, or unfolds to too many values;
            yaml.YAMLError is its cause, where there is one.
    """
    if len(text) > MAX_CHARACTERS:
        raise ValueError(f"it has more than {MAX_CHARACTERS // 2**20} MB")
    try:
        values: object = yaml.load(text, Loader=loader)  # noqa: S506  a SafeLoader
    except (RecursionError, yaml.YAMLError) as error:
        # An invalid date is a ValueError by itself.
        raise ValueError(str(error) or "it is nested too deeply") from error
    _count(values, {})
    return values


def _count(values: object, counts: dict[int, int]) -> int:
    """Return the number of values, with those of aliases at each place.

    Raises:
        ValueError: they are too many, one contains itself, an integer is too large for a float, or a text
            cannot be encoded.
    """
    if isinstance(values, int) and values.bit_length() > MAX_BITS:
        raise ValueError("a number is too long")
    if isinstance(values, str) and LONE_SURROGATE.search(values):
        raise ValueError("a text is no valid Unicode")
    if not isinstance(values, Collection) or isinstance(values, str | bytes):
        return 1
    if (known := counts.get(id(values))) is not None:
        if not known:
            raise ValueError("a value contains itself")
        return known
    counts[id(values)] = 0
    inside = [*values.keys(), *values.values()] if isinstance(values, Mapping) else values
    count = 1 + sum(_count(one, counts) for one in inside)
    if count > MAX_VALUES:
        raise ValueError(f"its aliases unfold to more than {MAX_VALUES} values")
    counts[id(values)] = count
    return count
