"""Latency from the first image of a breach to the alarm at a WebSocket client of a running server."""

import time
from collections.abc import Mapping
from dataclasses import dataclass

from websockets.sync.client import connect

from server.config import Config
from server.setup import build_setup
from server.stream.messages import LiveMessage
from tests.benchmarks.alarms.drilling_theatre import clearance_mm
from tests.benchmarks.options import BenchmarkOptions
from tests.benchmarks.running_server import PATIENCE_S, running_server
from tests.benchmarks.tables import Table, number, percentile
from tracker.navigation.alarms import Condition
from tracker.plan import Channel

RATE_HZ = 30.0
# Periodically the drill is through the wall with its shaft for half a second, while it is in the bone.
EVERY_S, LASTS_S, JUMP_MM = 1.9, 0.5, 7.0
# An alarm clears after a second; an earlier breach is the same one.
APART_S = 1.2
# Detection of a shallower breach depends on tracker noise, not on latency.
MIN_MM = 0.3
GOAL_MS = 250.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Breach:
    """A true breach, and when a client received its alarm.

    Attributes:
        first_number: of the first image that shows it.
        depth_mm: how far it is through the wall where it is deepest.
        late_ms: from the grab of that image to the message in the client's hands; None if nothing came.
    """

    first_number: int
    depth_mm: float
    late_ms: float | None


def breach_table(options: BenchmarkOptions, *, seconds: float) -> Table:
    """Table of the latency of breach alarms at a connected client."""
    breaches = _breaches(options, seconds=seconds)
    late = [one.late_ms for one in breaches if one.late_ms is not None]
    return Table(
        title="From the grab of the first image that shows a breach to the client that hears its alarm",
        columns=["breaches", "never announced", "median ms", "p99 ms", "most ms", "goal, p99 ms"],
        rows=[
            [
                str(len(breaches)),
                str(len(breaches) - len(late)),
                number(percentile(late, 50.0), 0),
                number(percentile(late, 99.0), 0),
                number(max(late, default=float("nan")), 0),
                number(GOAL_MS, 0),
            ]
        ],
        note=(
            "The image that shows it is the first one, taken or skipped, in which the true drill is through "
            f"the true wall; breaches that stay under {MIN_MM:g} mm are left out. Two images in a row must "
            "show it, so that one spoilt image raises nothing."
        ),
    )


def _breaches(options: BenchmarkOptions, *, seconds: float) -> list[Breach]:
    event = {"kind": "drill_jumps", "at_s": 1.0, "lasts_s": LASTS_S, "every_s": EVERY_S, "size_mm": JUMP_MM}
    played = {"skill": "good", "events": [event]}
    # Compilation at the start delays images, which is no stalled camera.
    with running_server(options, seed=options.seeds[0], live_rate_hz=RATE_HZ, rehearsal=played) as server:
        received: dict[int, tuple[int, float, float]] = {}
        first_s = 0.0
        with connect(server.socket_address("/ws/live"), proxy=None, compression=None) as socket:
            while True:
                text = socket.recv(timeout=PATIENCE_S)
                came_s = time.monotonic()
                message = LiveMessage.model_validate_json(text)
                if message.snapshot is None:
                    continue
                image, captured_s = message.snapshot.image_number, message.snapshot.captured_at_s
                first_s = first_s or captured_s
                for alarm in message.alarms.alarms:
                    if alarm.condition is Condition.BREACH and alarm.number not in received:
                        received[alarm.number] = (image, captured_s, came_s)
                if captured_s - first_s > seconds:
                    break
    starts = _true_starts(options, played, last_number=image)
    return [_announced(start, depth, list(received.values())) for start, depth in starts]


def _true_starts(
    options: BenchmarkOptions, played: Mapping[str, object], *, last_number: int
) -> list[tuple[int, float]]:
    """Return the first image and the maximum depth of each breach."""
    rehearsal = {"seed": options.seeds[0], "rate_hz": RATE_HZ, **played}
    preparation = build_setup(Config.model_validate({"rehearsal": rehearsal}))
    theatre, channel = preparation.theatre, preparation.channel
    if theatre is None or not isinstance(channel, Channel):
        raise RuntimeError("the rehearsal brings neither theatre nor channel")
    wall = preparation.drill_reference_for(channel).wall
    starts: list[tuple[int, float]] = []
    through_last = -1e9
    # The alarms of the last images may not have arrived yet.
    for image in range(last_number - round(RATE_HZ)):
        truth = theatre.truth_at(image / RATE_HZ)
        placed = truth.camera_from_vertebra.inverse @ truth.camera_from_tool
        depth_mm = -clearance_mm(placed, channel, wall, theatre)
        if depth_mm <= 0.0:
            continue
        if image - through_last > APART_S * RATE_HZ:
            starts.append((image, depth_mm))
        starts[-1] = (starts[-1][0], max(starts[-1][1], depth_mm))
        through_last = image
    return [one for one in starts if one[1] >= MIN_MM]


def _announced(start: int, depth_mm: float, received: list[tuple[int, float, float]]) -> Breach:
    # A skipped image was due before the one that arrived.
    late = [
        (came_s - captured_s) * 1e3 + (image - start) / RATE_HZ * 1e3
        for image, captured_s, came_s in received
        if start <= image <= start + LASTS_S * RATE_HZ
    ]
    return Breach(first_number=start, depth_mm=depth_mm, late_ms=min(late, default=None))
