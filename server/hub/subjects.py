"""Names of subjects, streams and buckets. Hospital and theatre are single tokens (`Name` of the settings)."""

import re
from dataclasses import dataclass
from enum import StrEnum


class Leaf(StrEnum):
    """Last token of a theatre's subjects."""

    STATE = "state"  # twice a second: headline and alarms without figures
    LIVE = "live"  # the live message of each image, as on /ws/live
    PICTURE = "picture"  # a live message and the small JPEG of its image, with lines and without figures
    ALARM = "alarm"  # line of the alarm log; stored
    AUDIT = "audit"  # end of the audit log's hash chain; stored


STORED = (Leaf.ALARM, Leaf.AUDIT)


@dataclass(frozen=True, slots=True)
class Hospital:
    """Names on the NATS server for one hospital."""

    name: str

    def subject(self, theatre: str, leaf: Leaf) -> str:
        """Subject of a theatre; `*` for all theatres."""
        return f"coaxial.{self.name}.theatre.{theatre}.{leaf}"

    def requests(self, theatre: str) -> str:
        """Subject on which a theatre receives requests of supervisors."""
        return f"coaxial.{self.name}.theatre.{theatre}.request"

    def beats(self, hub: str) -> str:
        """Subject on which a hub sends its clock; `*` for all hubs."""
        return f"coaxial.{self.name}.hub.{hub}.beat"

    @property
    def stream(self) -> str:
        """Stream of alarms and audit heads."""
        return f"COAXIAL_{self.name}"

    @property
    def claims(self) -> str:
        """Key-value bucket of the theatres' names."""
        return f"coaxial_{self.name}"


def is_theatre_name(name: str) -> bool:
    """Return whether a theatre can have this name, which is one token without wildcards."""
    return re.fullmatch(r"[A-Za-z0-9][A-Za-z0-9_-]{0,39}", name) is not None


def theatre_of(subject: str) -> str:
    """Theatre of one of its subjects."""
    return subject.split(".")[3]
