"""`coaxial theatres`: the theatres that publish to the hub, with the age of what each stated last."""

import asyncio
import json
import sys
from dataclasses import asdict
from pathlib import Path

from rich.console import Console
from rich.live import Live
from rich.table import Table

from server.cli.options import SettingOptions, config_from_options
from server.clock import elapsed_s
from server.hub.connection import HubAddress
from server.hub.subjects import Leaf
from server.hub.theatres import TheatrePresence, TheatreRow, theatre_rows
from server.hub.watcher import Watcher
from server.security.tls import reject_unsafe

# A theatre states itself twice a second; its delay is known after a beat. Longer than an attempt to connect.
LISTEN_S = 4.0
REFRESH_S = 0.25
NONE_HEARD = 1
COLOURS = {
    TheatrePresence.LIVE: "",
    TheatrePresence.UNMEASURED: "dim",
    TheatrePresence.UNREADABLE: "yellow",
    TheatrePresence.STALE: "yellow",
    TheatrePresence.GONE: "dim",
}


def list_theatres(config: Path | None, *, once: bool, as_json: bool) -> int:
    """Print the theatres once, or continuously until Ctrl+C; return the exit status.

    Raises:
        NavigationError: a setting cannot be used, or the NATS server does not answer.
    """
    settings = config_from_options(SettingOptions(config=config))
    reject_unsafe(settings)
    watcher = Watcher(HubAddress.of(settings.hub), (Leaf.STATE,))
    is_once = once or as_json or not sys.stdout.isatty()
    try:
        rows = asyncio.run(_heard(watcher) if is_once else _shown(watcher))
    except KeyboardInterrupt:
        return 0
    if as_json:
        sys.stdout.write(json.dumps([asdict(row) for row in rows], indent=2, ensure_ascii=False) + "\n")
    else:
        Console().print(theatre_table(rows))
    return 0 if rows else NONE_HEARD


async def _heard(watcher: Watcher) -> list[TheatreRow]:
    running = asyncio.create_task(watcher.run())
    await asyncio.sleep(LISTEN_S)
    rows = theatre_rows(watcher.newest, now_s=elapsed_s())
    running.cancel()
    await asyncio.wait([running])
    if watcher.problem is not None:
        raise watcher.problem
    return rows


async def _shown(watcher: Watcher) -> list[TheatreRow]:
    running = asyncio.create_task(watcher.run())
    with Live(auto_refresh=False) as live:
        while not running.done():
            rows = theatre_rows(watcher.newest, now_s=elapsed_s())
            table = theatre_table(rows)
            table.caption = None if watcher.problem is None else watcher.problem.message
            live.update(table, refresh=True)
            await asyncio.sleep(REFRESH_S)
    return rows


def theatre_table(rows: list[TheatreRow]) -> Table:
    """Return the table of the theatres; what is not live has its age and nothing else."""
    table = Table("theatre", "state", "image", "headline", "alarms")
    for row in rows:
        state = row.presence.value
        if row.presence in {TheatrePresence.STALE, TheatrePresence.GONE}:
            state += "" if row.age_ms is None else f", {row.age_ms / 1000.0:.1f} s old"
        is_live = row.presence is TheatrePresence.LIVE
        image = f"<= {row.image_age_ms:.0f} ms old" if is_live and row.image_age_ms is not None else "-"
        alarms = ", ".join(one.title for one in row.alarms)
        cells = (row.name, state, image, row.headline or "-", alarms or "-")
        table.add_row(*cells, style=COLOURS[row.presence])
    return table
