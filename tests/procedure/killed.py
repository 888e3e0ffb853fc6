"""Kill a whole server with `kill -9` during a procedure: the web process, tracking, or both.

    make kills MINUTES=15
    PYTHONPATH=. python -m tests.procedure.killed --times 50 --seed 1 [--from empty] [--kills-each 10]

Users do the procedure on the rehearsal through the API. After each kill the server is started again with the
same folder, and everything that it had confirmed must exist: documents, the open case, the steps, the alarm
log. No numbers may appear before a person has confirmed (or checked), and then they must return. Odd
procedures have a patient marker, even ones do not.

"""

import argparse
import math
import random
import sys
import tempfile
import threading
import time
from collections.abc import Iterator
from contextlib import ExitStack
from dataclasses import dataclass, field
from itertools import count
from pathlib import Path
from typing import Any

import httpx2

from server.config import Config
from tests.procedure.killing.people import VALID_STATES, KilledUnderUs, Listener, People, WatchedServer
from tests.procedure.killing.processes import Family, family_of, kill, left_behind
from tests.procedure.killing.promised import Promised
from tests.procedure.killing.theatre import prepare, settings_of
from tests.procedure.real_server import unended_server
from tests.procedure.team import Team

TARGETS = ("web", "tracking", "both")
MAX_KILLS = 100_000
STOPPED = {"NOT_CONFIRMED", "NOT_CHECKED"}
COLUMNS = "{:>4} {:<9} {:<4} {:<22} {:>7} {:>9} {:>7}  {}\n"


@dataclass(slots=True, kw_only=True)
class Kill:
    """One kill and its result."""

    target: str
    doing: str = ""
    confirmed: int = 0
    back_s: float = 0.0
    stopped_by: str = ""
    broken: list[str] = field(default_factory=list)


class Theatre:
    """A server that is repeatedly killed and restarted in one folder, and its users."""

    def __init__(self, folder: Path, *, reference: bool, rng: random.Random, empty: bool) -> None:
        self._folder, self._settings = folder, settings_of(reference=reference)
        self._config = Config.model_validate(self._settings)
        self._reference, self._probability = reference, rng
        self._promised, self._numbers = Promised(), count(1)
        self._ending = ExitStack()
        folder.mkdir(parents=True)
        if not empty:
            prepare(folder / "home", self._config)
        self._start()
        self._promised.observe(self._server)

    def kill_once(self, target: str, *, after_s: float) -> Kill:
        """Let users work for this long, kill, restart, and verify."""
        one, struck = Kill(target=target), list[Family]()
        before = self._promised.changes

        def strike() -> None:
            family = family_of(self._server.process.pid)
            if target == "tracking" and family.tracking is not None:
                kill((family.tracking,))
            else:
                one.target = "web" if target == "tracking" else target
                both = (family.web, *(() if family.tracking is None else (family.tracking,)))
                kill(both if one.target == "both" else (family.web,))
            struck.append(family)
            self._server.killed.set()

        timer = threading.Timer(after_s, strike)
        timer.start()
        try:
            self._people.work()
        except (KilledUnderUs, httpx2.TransportError):
            timer.join()
        finally:
            timer.cancel()
        one.doing, one.confirmed = self._people.doing, self._promised.changes - before
        began_s = time.monotonic()
        if one.target == "tracking":
            one.broken += self._tracking_again(struck[0])
        else:
            self._ending.close()
            one.broken += left_behind(struck[0])
            self._start()
        one.back_s = time.monotonic() - began_s
        one.broken += self._promised.broken(self._server)
        one.broken += self._changed_steps(one.target)
        one.stopped_by = self._goes_on_once_confirmed(one)
        self._promised.observe(self._server)
        return one

    def end(self) -> None:
        """Kill the last server."""
        family = family_of(self._server.process.pid)
        kill(family.pids)
        self._ending.close()

    def _start(self) -> None:
        server = unended_server(self._ending, self._folder, self._settings)
        self._server = WatchedServer(
            port=server.port, process=server.process, door=server.door, promised=self._promised
        )
        self._hear()
        team = Team(server=self._server, config=self._config)
        self._people = People(team, self._server, self._probability, self._numbers)

    def _hear(self) -> None:
        self._listener = Listener(port=self._server.port).start()
        self._ending.callback(self._listener.stop)

    def _tracking_again(self, struck: Family) -> Iterator[str]:
        """Wait until another process has replaced the killed tracking process."""
        self._server.killed.clear()
        self._server.until("another tracking process", lambda: self._process()["state"] == "running")
        now = family_of(self._server.process.pid)
        if now.tracking == struck.tracking:
            yield "it tracks on in a process that was killed"

    def _process(self) -> dict[str, Any]:
        live: dict[str, Any] = self._server.ask("GET", "/api/live", 200)
        # A message from before the kill does not count.
        is_another = family_of(self._server.process.pid).tracking is not None and live["snapshot"] is not None
        return {**live["process"], "state": live["process"]["state"] if is_another else "none"}

    def _changed_steps(self, target: str) -> Iterator[str]:
        """Yield the steps whose state changed; after a start the check of an unmonitored camera is due."""
        allowed = {"navigate"} if target == "tracking" or self._reference else {"check", "navigate"}
        for step, (was, now) in self._promised.changed_steps(self._server).items():
            if step not in allowed:
                yield f"the step {step} was {was}, and is {now}"

    def _goes_on_once_confirmed(self, one: Kill) -> str:
        """When all is set up: no numbers before the confirmation, numbers after it; return its reason."""
        reported = self._server.ask("GET", "/api/procedure", 200)
        states = {step["step"]: step["state"] for step in reported["steps"]}
        ready = all(state in VALID_STATES for step, state in states.items() if step != "navigate")
        goes_on = one.target == "tracking" and (self._reference or reported["confirmation"] is None)
        if not ready:
            return next(f"{step} {state}" for step, state in states.items() if state not in VALID_STATES)
        process = int(self._server.ask("GET", "/api/live", 200)["process"]["restarts"])
        heard = self._listener
        if goes_on:
            self._server.until("numbers again", lambda: self._has_numbers(process))
            return "-"
        if reported["confirmation"] is None:
            one.broken.append("nobody is asked whether all stands as it did")
            return "nothing"
        self._server.until("a word that it is stopped", lambda: heard.reasons.get(process, set()) & STOPPED)
        if process in heard.numbers:
            one.broken.append("numbers were given before anybody confirmed them")
        self._people.confirm()
        self._server.until("numbers again", lambda: self._has_numbers(process))
        return str(reported["confirmation"]["because"])

    def _has_numbers(self, process: int) -> bool:
        """Whether numbers return. On a busy machine tracking may restart once more meanwhile."""
        if any(heard >= process for heard in self._listener.numbers):
            return True
        self._people.confirm()
        return False


def kills(times: int, *, seed: int, empty: bool, each: int, longest_s: float) -> Iterator[Kill]:
    """Run this many kills, in as many procedures as needed."""
    rng = random.Random(seed)
    with tempfile.TemporaryDirectory() as folder:
        for first in range(0, times, each):
            odd = first // each % 2 == 0
            theatre = Theatre(Path(folder) / f"{first}", reference=odd, rng=rng, empty=empty)
            try:
                for _ in range(min(each, times - first)):
                    after_s = rng.uniform(0.2, longest_s)
                    yield theatre.kill_once(rng.choice(TARGETS), after_s=after_s)
            finally:
                theatre.end()


def main() -> None:
    """Run the kills and print the results."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--times", type=int, help="number of kills; 50 unless minutes are given")
    parser.add_argument("--minutes", type=float, default=math.inf, help="no kill begins after them")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--from", dest="start", choices=("prepared", "empty"), default="prepared")
    parser.add_argument("--kills-each", type=int, default=10, help="in one procedure")
    parser.add_argument("--longest-s", type=float, default=6.0, help="that people work before a kill")
    given = parser.parse_args()
    times = given.times or (50 if math.isinf(given.minutes) else MAX_KILLS)
    end_s = time.monotonic() + 60.0 * given.minutes
    tell = sys.stdout.write
    tell(COLUMNS.format("kill", "killed", "", "while", "changes", "back in s", "broken", "stopped by"))
    reported: list[Kill] = []
    for one in kills(
        times,
        seed=given.seed,
        empty=given.start == "empty",
        each=given.kills_each,
        longest_s=given.longest_s,
    ):
        reported.append(one)
        row = (len(reported), one.target, "", one.doing, one.confirmed, f"{one.back_s:.1f}", len(one.broken))
        tell(COLUMNS.format(*row, one.stopped_by))
        tell("".join(f"       {what}\n" for what in one.broken))
        sys.stdout.flush()
        if time.monotonic() > end_s:
            break
    broken = sum(len(one.broken) for one in reported)
    changes = sum(one.confirmed for one in reported)
    tell(f"{len(reported)} kills, {changes} confirmed changes, {broken} promises broken\n")
    sys.exit(1 if broken else 0)


if __name__ == "__main__":
    main()
