"""Cost of the whole server, and age of a picture at a viewer."""

import json
import os
import time
from dataclasses import dataclass
from pathlib import Path

from websockets.sync.client import connect

from server.stream.messages import LiveMessage
from server.stream.view_socket import HEADER_LENGTH, NEXT_REQUEST
from tests.benchmarks.running_server import PATIENCE_S, RunningServer
from tests.benchmarks.tables import NOTHING, Table, number, pair

SETTLING_S, WATCHED_S = 2.0, 10.0


@dataclass(frozen=True, slots=True, kw_only=True)
class ViewerMeasurement:
    """What one viewer of `/ws/view` received.

    Attributes:
        latency_ms: of each image, from its grab to the whole message in the viewer's hands.
        image_bytes: size of each JPEG.
        spent_s: how long it was watched.
        cpu_ratio_of_process: share of one core by process, None where the system does not tell.
    """

    latency_ms: list[float]
    image_bytes: list[int]
    spent_s: float
    cpu_ratio_of_process: dict[str, float] | None


def measure_viewer(server: RunningServer) -> list[Table]:
    """Measure one viewer that requests each next image as soon as it has one."""
    watched = _watch(server)
    shares = watched.cpu_ratio_of_process
    row = [
        number(len(watched.latency_ms) / watched.spent_s, 1),
        pair(watched.latency_ms, 99.0, 1),
        f"{sum(watched.image_bytes) / max(len(watched.image_bytes), 1) / 1000:.0f}",
        *(
            NOTHING if shares is None else f"{100.0 * shares.get(name, 0.0):.0f} %"
            for name in ("web", "tracking")
        ),
    ]
    columns = [
        "images a second",
        "grab to received ms",
        "JPEG kB",
        "web server, of a core",
        "capture (with the theatre's rendering) and tracking, of a core",
    ]
    return [Table(title="", columns=columns, rows=[row])]


def _watch(server: RunningServer) -> ViewerMeasurement:
    latency_ms, image_bytes = list[float](), list[int]()
    begun_s, begun_cpu = time.monotonic() + SETTLING_S, None
    with connect(server.socket_address("/ws/view"), proxy=None, compression=None, max_size=None) as socket:
        while time.monotonic() < begun_s + WATCHED_S:
            socket.send(json.dumps(NEXT_REQUEST))
            content = socket.recv(timeout=PATIENCE_S, decode=False)
            came_s = time.monotonic()
            if came_s < begun_s:
                continue
            if begun_cpu is None:
                begun_cpu, begun_s = cpu_s(server.pid), came_s
            (length,) = HEADER_LENGTH.unpack_from(content)
            header = content[HEADER_LENGTH.size : HEADER_LENGTH.size + length]
            message = LiveMessage.model_validate_json(header)
            if message.snapshot is not None:
                latency_ms.append((came_s - message.snapshot.captured_at_s) * 1e3)
                image_bytes.append(len(content) - HEADER_LENGTH.size - length)
        spent_s, ended_cpu = time.monotonic() - begun_s, cpu_s(server.pid)
    shares = None
    if begun_cpu is not None and ended_cpu is not None:
        shares = {name: (ended_cpu[name] - begun_cpu.get(name, 0.0)) / spent_s for name in ended_cpu}
    return ViewerMeasurement(
        latency_ms=latency_ms, image_bytes=image_bytes, spent_s=spent_s, cpu_ratio_of_process=shares
    )


def cpu_s(pid: int) -> dict[str, float] | None:
    """Return the processor seconds of the web server and its children; None without /proc."""
    if not Path(f"/proc/{pid}/stat").exists():
        return None
    return {"web": _cpu_s_of(pid), "tracking": sum(map(_cpu_s_of, _descendants(pid)))}


def _descendants(pid: int) -> list[int]:
    children = [
        int(child)
        for task in Path(f"/proc/{pid}/task").iterdir()
        for child in (task / "children").read_text(encoding="ascii").split()
    ]
    return [one for child in children for one in (child, *_descendants(child))]


def _cpu_s_of(pid: int) -> float:
    # The name in brackets may contain spaces: count from behind it. 14 and 15 are user and system time.
    fields = Path(f"/proc/{pid}/stat").read_text(encoding="ascii").rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / float(os.sysconf("SC_CLK_TCK"))
