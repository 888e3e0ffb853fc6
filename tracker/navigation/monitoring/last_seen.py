"""Time since each marker was last seen."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from types import MappingProxyType

from tracker.pose import Seen, Sighting


@dataclass(frozen=True, slots=True, kw_only=True)
class NeverSeen:
    """A marker not seen since the monitor started."""


@dataclass(frozen=True, slots=True, kw_only=True)
class LastSeen:
    """Time at which each marker was last seen; immutable.

    Attributes:
        seen_at_s: by marker; a marker that was never seen is missing.
    """

    seen_at_s: Mapping[str, float] = field(default_factory=lambda: MappingProxyType({}))

    def after(self, sightings: Mapping[str, Sighting], *, at_s: float) -> "LastSeen":
        """Return the record after one more image."""
        seen = {name: at_s for name, sighting in sightings.items() if isinstance(sighting, Seen)}
        return LastSeen(seen_at_s=MappingProxyType({**self.seen_at_s, **seen}))

    def age_s(self, marker: str, *, at_s: float) -> float | NeverSeen:
        """Return the time since a marker was seen; 0 in the image that shows it."""
        seen_at_s = self.seen_at_s.get(marker)
        return NeverSeen() if seen_at_s is None else max(at_s - seen_at_s, 0.0)

    def ages_s(self, markers: Iterable[str], *, at_s: float) -> dict[str, float | NeverSeen]:
        """Return the same for several markers, by name."""
        return {marker: self.age_s(marker, at_s=at_s) for marker in markers}
