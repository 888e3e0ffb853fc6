"""Command-line options of the benchmark."""

from dataclasses import dataclass

from tracker.rehearsal import TheatreSettings


@dataclass(frozen=True, slots=True, kw_only=True)
class BenchmarkOptions:
    """Options of a benchmark run.

    Attributes:
        seeds: theatres; the live server plays the first.
        seconds: how long each theatre is played, offline; 40 is the whole cycle of its hand.
        rate_hz: images a second, offline.
        live_seconds: how long the server is listened to.
        noise, blur, clutter, light: how hard the rehearsal is, 1 is a good camera in good light.
        rigs: letters of the cameras of the limits.
        conditions: of the limits, by name; none for all, and for hands, pace and empty images too.
        images: of each condition of the limits.
        seed: of their first image.
        runs: simulated calibrations of each kind of tool.
        viewers: how many watch at once, one stretch after the other.
    """

    seeds: tuple[int, ...] = (1, 2, 3)
    seconds: float = 40.0
    rate_hz: float = 10.0
    live_seconds: float = 40.0
    noise: float = 1.0
    blur: float = 1.0
    clutter: float = 1.0
    light: float = 1.0
    rigs: str = "AB"
    conditions: tuple[str, ...] = ()
    images: int = 18
    seed: int = 0
    runs: int = 200
    viewers: tuple[int, ...] = (1, 10, 30)

    @property
    def has_default_difficulty(self) -> bool:
        """Return whether the rehearsal has its default difficulty."""
        return self.noise == self.blur == self.clutter == self.light == 1.0

    @property
    def theatres_summary(self) -> str:
        """Return a sentence that describes the theatres."""
        seeds = ", ".join(map(str, self.seeds))
        return (
            f"Seeds {seeds} (a server plays the first); offline {self.seconds:g} s each at "
            f"{self.rate_hz:g} Hz; noise {self.noise:g}, blur {self.blur:g}, clutter {self.clutter:g}, "
            f"light {self.light:g}."
        )

    @property
    def limits_summary(self) -> str:
        """Return a sentence that describes the scenes."""
        which = ", ".join(self.conditions) or "all conditions"
        return f"Cameras {self.rigs}; {which}; {self.images} scenes of each from seed {self.seed} on."

    @property
    def tools_summary(self) -> str:
        """Return a sentence that describes the calibrations."""
        return f"{self.runs} simulated calibrations of each kind, of 60 poses where nothing else is said."

    @property
    def load_summary(self) -> str:
        """Return a sentence that describes the viewers."""
        return f"Viewers {', '.join(map(str, self.viewers))}; 1280x720 px at 30 Hz, theatre {self.seeds[0]}."

    def settings_of(self, seed: int, size_wh_px: tuple[int, int] = (1280, 720)) -> TheatreSettings:
        """Return the theatre settings of a seed, with the requested difficulty."""
        return TheatreSettings(
            seed=seed,
            size_wh_px=size_wh_px,
            noise=self.noise,
            blur=self.blur,
            clutter=self.clutter,
            light=self.light,
        )
