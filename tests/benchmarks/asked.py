"""What is to be measured."""

from dataclasses import dataclass

from tracker.rehearsal import TheatreSettings


@dataclass(frozen=True, slots=True, kw_only=True)
class Asked:
    """What the command line asked for.

    Attributes:
        seeds: theatres; the live server plays the first.
        seconds: how long each theatre is played, offline; 40 is the whole cycle of its hand.
        rate_hz: images a second, offline.
        live_seconds: how long the server is listened to.
        noise, blur, clutter, light: how hard the rehearsal is, 1 is a good camera in good light.
    """

    seeds: tuple[int, ...] = (1, 2, 3)
    seconds: float = 40.0
    rate_hz: float = 10.0
    live_seconds: float = 40.0
    noise: float = 1.0
    blur: float = 1.0
    clutter: float = 1.0
    light: float = 1.0

    def settings_of(self, seed: int, size_wh_px: tuple[int, int] = (1280, 720)) -> TheatreSettings:
        """The theatre of a seed, as hard as was asked."""
        return TheatreSettings(
            seed=seed,
            size_wh_px=size_wh_px,
            noise=self.noise,
            blur=self.blur,
            clutter=self.clutter,
            light=self.light,
        )
