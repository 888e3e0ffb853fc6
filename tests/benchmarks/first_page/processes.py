"""Processor time by process, read from /proc."""

import os
import re
from dataclasses import dataclass
from pathlib import Path

TICKS_PER_S = float(os.sysconf("SC_CLK_TCK"))
PROC = Path("/proc")
# Chromium rewrites its own command line, with blanks in place of zeros.
PROCESS_KIND = re.compile(r"--type=([\w-]+)")
BROWSER_PARTS = {
    "": "browser: main process",
    "renderer": "browser: page and 3-D scene",
    "gpu-process": "browser: drawing (GPU process)",
}
OTHER_BROWSER_PART = "browser: network and the rest"
OTHER_WORK = "other work on this machine"


@dataclass(frozen=True, slots=True, kw_only=True)
class ProcessorTime:
    """Seconds of processor time since the start of each process.

    Attributes:
        own_s: by the name of a part of the server or of the browser.
        machine_s: of everything on this machine, and of its host while this machine waits for a processor.
    """

    own_s: dict[str, float]
    machine_s: float


def processor_time(server_pid: int, browser_pid: int) -> ProcessorTime:
    """Return the processor time of a running server and of a browser with its child processes."""
    own_s: dict[str, float] = {"server: web process": cpu_s_of(server_pid), "server: tracking process": 0.0}
    for pid in descendants(server_pid):
        own_s["server: tracking process"] += cpu_s_of(pid)
    for pid in (browser_pid, *descendants(browser_pid)):
        name = _browser_part(pid)
        if name is not None:
            own_s[name] = own_s.get(name, 0.0) + cpu_s_of(pid)
    return ProcessorTime(own_s=own_s, machine_s=_machine_s())


def processor_use(before: ProcessorTime, after: ProcessorTime, seconds: float) -> dict[str, float]:
    """Return the share of one core by process between two readings, and that of other programs."""
    used = {name: (spent_s - before.own_s.get(name, 0.0)) / seconds for name, spent_s in after.own_s.items()}
    machine = (after.machine_s - before.machine_s) / seconds
    return {**used, OTHER_WORK: max(0.0, machine - sum(used.values()))}


def descendants(pid: int) -> list[int]:
    """Return all descendants of a process; those that end meanwhile are left out."""
    found: list[int] = []
    try:
        for task in (PROC / str(pid) / "task").iterdir():
            for child in (task / "children").read_text(encoding="ascii").split():
                found += [int(child), *descendants(int(child))]
    except OSError:
        return found
    return found


def cpu_s_of(pid: int) -> float:
    """Return user and system time of one process; 0 if it has ended."""
    try:
        stat = (PROC / str(pid) / "stat").read_text(encoding="ascii")
    except OSError:
        return 0.0
    # The name in brackets may contain spaces: count from behind it. 14 and 15 are user and system time.
    fields = stat.rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / TICKS_PER_S


def _browser_part(pid: int) -> str | None:
    try:
        command = (PROC / str(pid) / "cmdline").read_text(encoding="utf-8", errors="replace")
    except OSError:
        return None
    if "chrom" not in command.partition("--")[0]:
        return None
    kind = PROCESS_KIND.search(command)
    return BROWSER_PARTS.get(kind[1] if kind else "", OTHER_BROWSER_PART)


def _machine_s() -> float:
    fields = (PROC / "stat").read_text(encoding="ascii").splitlines()[0].split()[1:]
    user, nice, system, _idle, _wait, irq, soft_irq, steal = map(int, fields[:8])
    return (user + nice + system + irq + soft_irq + steal) / TICKS_PER_S
