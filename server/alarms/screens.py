"""Which screens would be heard: each says so every few seconds, and is lost when it stops saying so."""

from dataclasses import dataclass

MAX_SCREENS = 100


@dataclass(frozen=True, slots=True, kw_only=True)
class Screen:
    """One screen.

    Attributes:
        armed: its sound is on.
        heard_at_s: when it last said anything.
    """

    armed: bool
    heard_at_s: float


class Screens:
    """The screens that have said something. Mutable; time is brought by each call.

    A screen that never armed its sound is not missed. One that did, and fell silent, is lost until it comes
    back, another one is armed in its place, or somebody acknowledges that it is gone.
    """

    def __init__(self, *, lost_after_s: float) -> None:
        self._lost_after_s = lost_after_s
        self._screens: dict[str, Screen] = {}
        self._lost: set[str] = set()

    def said(self, name: str, *, armed: bool, at_s: float) -> None:
        """A screen says whether its sound is armed."""
        if name not in self._screens and len(self._screens) >= MAX_SCREENS:
            oldest = min(self._screens, key=lambda one: self._screens[one].heard_at_s)
            del self._screens[oldest]
        is_new = armed and not (name in self._screens and self._screens[name].armed)
        self._screens[name] = Screen(armed=armed, heard_at_s=at_s)
        self._lost.discard(name)
        if is_new:
            self._lost.clear()

    def left(self, name: str) -> None:
        """A screen says that it is closed."""
        self._screens.pop(name, None)
        self._lost.discard(name)

    def forget_lost(self) -> None:
        """Somebody knows that they are gone."""
        self._lost.clear()

    def armed(self, at_s: float) -> int:
        """How many would be heard now."""
        self._look(at_s)
        return sum(screen.armed for screen in self._screens.values())

    def lost(self, at_s: float) -> int:
        """How many were armed, and went without saying so."""
        self._look(at_s)
        return len(self._lost)

    def _look(self, at_s: float) -> None:
        for name, screen in list(self._screens.items()):
            if at_s - screen.heard_at_s > self._lost_after_s:
                del self._screens[name]
                if screen.armed:
                    self._lost.add(name)
