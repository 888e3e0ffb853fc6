"""Screens with sound: each reports every few seconds and is lost when its reports stop."""

from dataclasses import dataclass

MAX_SCREENS = 100


@dataclass(frozen=True, slots=True, kw_only=True)
class Screen:
    """A screen.

    Attributes:
        armed: Its sound is enabled.
        guiding_by: Who hears its guiding sound; empty while it is off.
        heard_at_s: Time of its last report.
    """

    armed: bool
    guiding_by: str = ""
    heard_at_s: float


class Screens:
    """The reporting screens. Each call passes the present time.

    A screen that never enabled its sound is ignored. One that did and stopped reporting is lost until it
    reports again, another one enables its sound, or its loss is acknowledged.
    """

    def __init__(self, *, lost_after_s: float) -> None:
        self._lost_after_s = lost_after_s
        self._screens: dict[str, Screen] = {}
        self._lost: set[str] = set()

    def report(self, name: str, *, armed: bool, at_s: float, guiding_by: str = "") -> None:
        """Record the sound state of a screen."""
        if name not in self._screens and len(self._screens) >= MAX_SCREENS:
            oldest = min(self._screens, key=lambda one: self._screens[one].heard_at_s)
            del self._screens[oldest]
        is_new = armed and not (name in self._screens and self._screens[name].armed)
        self._screens[name] = Screen(armed=armed, guiding_by=guiding_by, heard_at_s=at_s)
        self._lost.discard(name)
        if is_new:
            self._lost.clear()

    def close(self, name: str) -> None:
        """Remove a screen that was closed."""
        self._screens.pop(name, None)
        self._lost.discard(name)

    def forget_lost(self) -> None:
        """Acknowledge the lost screens."""
        self._lost.clear()

    def armed(self, at_s: float) -> int:
        """Return the number of screens with enabled sound."""
        self._expire(at_s)
        return sum(screen.armed for screen in self._screens.values())

    def guiding(self, at_s: float) -> dict[str, str]:
        """Return the screens whose guiding sound is on, each with who hears it."""
        self._expire(at_s)
        return {name: one.guiding_by for name, one in self._screens.items() if one.guiding_by}

    def lost(self, at_s: float) -> int:
        """Return the number of lost screens."""
        self._expire(at_s)
        return len(self._lost)

    def _expire(self, at_s: float) -> None:
        for name, screen in list(self._screens.items()):
            if at_s - screen.heard_at_s > self._lost_after_s:
                del self._screens[name]
                if screen.armed:
                    self._lost.add(name)
