"""A drill that moves at random through a bone of known size, with all outputs of each moment.

    PYTHONPATH=. python -m tests.server.texts.random_drilling --seeds 20

prints how many moments and different states were visited, and ends at the first contradiction.

"""

import random
from argparse import ArgumentParser
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from datetime import UTC, datetime, timedelta

import numpy as np

from server.alarms import AlarmService, ProcedureFacts
from server.alarms.entries import Entry
from server.alarms.log import NoLog
from server.config import Config
from server.live import Instant, ProcessState, ProcessStatus, SourceState, SourceStatus
from server.stream.messages import LiveMessage, live_message
from tests.server.texts.drilled_rod import UNSEEN, concluded, seen_at, setup_of
from tests.tracker.navigation.assessed import drill_reference
from tracker.navigation import NavigationSnapshot, min_errors_95_mm
from tracker.navigation.alarms import AlarmSnapshot
from tracker.pose import Sighting

RUNS = SourceStatus(name="rehearsal", state=SourceState.RUNNING)
WORKS = ProcessStatus(state=ProcessState.RUNNING)
START = datetime(2026, 1, 2, 10, 41, 13, tzinfo=UTC)

# Targets of the hand: (depth, medial, cranial, medial_deg, cranial_deg), and the factor of the uncertainty.
PLACES: Sequence[tuple[float, float, float, float, float, float]] = [
    (-15.0, 0.2, 0.1, 0.3, 0.2, 1.0),  # before the entry, on path
    (25.0, 0.1, 0.0, 0.2, 0.1, 1.0),  # inside, on path
    (-10.0, 3.0, -2.0, 1.0, 0.0, 1.0),  # entry off
    (3.0, -0.2, 0.1, -4.0, 7.0, 1.0),  # angle off
    (1.0, 1.6, 0.0, 2.0, 0.0, 1.0),  # within both, and through at the end
    (30.0, 2.4, 0.0, 0.0, 0.0, 1.0),  # near the medial wall
    (30.0, 3.1, 0.0, 0.0, 0.0, 1.0),  # just through the medial wall
    (35.0, -4.5, 0.0, 0.0, 0.0, 1.0),  # through the lateral wall
    (32.0, 0.0, 3.6, 0.0, 0.0, 1.0),  # through the cranial wall
    (32.0, 0.0, -3.05, 0.0, 0.0, 1.5),  # at the caudal wall
    (55.0, 0.0, 0.2, 0.0, 0.0, 1.0),  # at the planned depth
    (56.5, 0.0, 0.0, 0.0, 0.0, 1.0),  # too deep
    (25.0, 0.0, 0.0, 0.0, 0.0, 11.0),  # uncertain
    (28.0, 0.0, 1.3, 0.0, 0.0, 5.5),  # a breach is likely
    (5.0, 0.0, 0.0, 88.0, 0.0, 1.0),  # across
    (60.0, 55.0, 10.0, 0.0, 0.0, 1.0),  # beside the patient
]


@dataclass(slots=True)
class MemoryLog(NoLog):
    """The log's lines, as passed to the disk."""

    lines: list[Mapping[str, object]] = field(default_factory=list)

    def append(self, entries: Sequence[Entry]) -> None:
        self.lines += [entry.line for entry in entries]


@dataclass(frozen=True, slots=True, kw_only=True)
class Moment:
    """All outputs of one moment.

    Attributes:
        at_s: time of the moment.
        snapshot: of the image of this moment; None without an image.
        alarms: from the engine.
        message: as sent.
        lines: added to the log.

    """

    at_s: float
    snapshot: NavigationSnapshot | None
    alarms: AlarmSnapshot
    message: LiveMessage
    lines: Sequence[Mapping[str, object]]


class RandomDrilling:
    """The same seed gives the same moments. One or two tools, at 5 to 30 images a second."""

    def __init__(self, seed: int) -> None:
        self.random = random.Random(seed)
        self.rate_hz = self.random.choice([5.0, 12.0, 30.0])
        names = ["drill"] if seed % 3 else ["drill", "awl"]
        self.drill_reference = drill_reference(self.random.choice([1.0, 1.8]))
        # In every third, the registration leaves 1.1 mm.
        self.setup = setup_of(names, registered_sd_mm=0.45 if seed % 3 == 1 else 0.0)
        self.setup = replace(self.setup, min_errors_95_mm=min_errors_95_mm(self.setup, self.drill_reference))
        self.at_s = 1000.0
        self.log = MemoryLog()
        self.service = AlarmService(
            Config(),
            log=self.log,
            clock=lambda: self.at_s,
            wall_clock=lambda: START + timedelta(seconds=self.at_s - 1000.0),
        )
        self.where = {name: np.array(PLACES[0]) for name in names}
        self.sequence = 0

    def moments(self, images: int) -> Iterator[Moment]:
        """This many images, with gaps and user actions between them."""
        number = 0
        while number < images:
            targets = {name: np.array(self.random.choice(PLACES)) for name in self.setup.tools}
            hidden = self.random.random() < 0.15
            for _ in range(self.random.randint(2, max(3, round(2.5 * self.rate_hz)))):
                number += 1
                self.at_s += 1.0 / self.rate_hz
                self._move(targets)
                yield self._moment(self._concluded(number, hidden=hidden))
                yield from self._person()
            if self.random.random() < 0.1:
                yield from self._silence()

    def _move(self, targets: Mapping[str, np.ndarray]) -> None:
        quick = 1.0 - 0.5 ** (8.0 / self.rate_hz)
        noise = np.array([0.1, 0.05, 0.05, 0.1, 0.1, 0.0])
        for name, target in targets.items():
            tremor = np.array([self.random.gauss(0.0, 1.0) for _ in noise])
            self.where[name] = self.where[name] + quick * (target - self.where[name]) + noise * tremor

    def _concluded(self, number: int, *, hidden: bool) -> NavigationSnapshot:
        sightings: dict[str, Sighting] = {}
        for name, tool in self.setup.tools.items():
            is_hidden = hidden and (name == "drill" or self.random.random() < 0.5)
            sightings[name] = UNSEEN if is_hidden else seen_at(self.where[name], tool)
        return concluded(
            self.setup, self.drill_reference, sightings, number=number, captured_at_s=self.at_s - 0.02
        )

    def _person(self) -> Iterator[Moment]:
        """Occasionally a user acknowledges, pauses, or changes what the registration depends on."""
        probability = self.random.random()
        if probability < 0.02:
            numbers = [alarm.number for alarm in self.service.picture.alarms]
            if numbers:
                self.service.acknowledge(
                    self.random.sample(numbers, self.random.randint(1, len(numbers))), by="Ito"
                )
        elif probability < 0.025:
            self.service.pause(self.random.uniform(1.0, 60.0), by="Ito")
        elif probability < 0.03:
            self.service.set_facts(ProcedureFacts(registration_current=self.random.random() < 0.7))
        else:
            return
        yield self._moment(None)

    def _silence(self) -> Iterator[Moment]:
        for _ in range(self.random.randint(2, 30)):
            self.at_s += 0.05
            yield self._moment(None)

    def _moment(self, snapshot: NavigationSnapshot | None) -> Moment:
        before = len(self.log.lines)
        alarms = self.service.observe(snapshot, RUNS, WORKS)
        self.sequence += 1
        instant = Instant(
            sequence=self.sequence, source=RUNS, process=WORKS, snapshot=snapshot, alarms=alarms
        )
        return Moment(
            at_s=self.at_s,
            snapshot=snapshot,
            alarms=alarms,
            message=live_message(instant, now_s=self.at_s),
            lines=self.log.lines[before:],
        )


def state_of(moment: Moment) -> tuple[object, ...]:
    """Kind of a moment: headline or none, and each alarm with its state and presence."""
    return (
        moment.message.headline.verdict,
        moment.message.headline.tone,
        frozenset((alarm.condition, alarm.state, alarm.presence) for alarm in moment.alarms.alarms),
    )


def main() -> None:
    """Visit many moments, and print the number of different states."""
    from tests.server.texts.contradictions import ContradictionCheck  # noqa: PLC0415  it needs the moments of this file

    parser = ArgumentParser()
    parser.add_argument("--seeds", type=int, default=20)
    parser.add_argument("--images", type=int, default=1500)
    requested = parser.parse_args()
    states: set[tuple[object, ...]] = set()
    moments = 0
    for seed in range(requested.seeds):
        check = ContradictionCheck()
        for moment in RandomDrilling(seed).moments(requested.images):
            check.check(moment)
            states.add(state_of(moment))
            moments += 1
    print(f"seeds 0 to {requested.seeds - 1}: {moments} moments in {len(states)} states, no contradiction")  # noqa: T201


if __name__ == "__main__":
    main()
