"""Warning about a usable result."""

from collections.abc import Mapping
from dataclasses import dataclass, field


@dataclass(frozen=True, slots=True, kw_only=True)
class Remark:
    """A warning with a code, as an error has, about work that was completed.

    Attributes:
        code: stable identifier in UPPER_SNAKE_CASE, for machines.
        message: what was found in numbers, without a final full stop.
        remedy: what to do about it, one full sentence.
        context: the numbers of the message by name, each with its unit in the name.
    """

    code: str
    message: str
    remedy: str
    context: Mapping[str, object] = field(default_factory=dict)
