"""Concurrent tasks of one connection: when one ends, the others are cancelled."""

import asyncio
from collections.abc import Coroutine


async def run_until_first_ends(*sides: Coroutine[None, None, None]) -> None:
    """Run all coroutines until the first one ends, cancel the others, and raise what the first one raised."""
    tasks = [asyncio.create_task(side) for side in sides]
    try:
        done, _ = await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
    finally:
        for task in tasks:
            task.cancel()
        # Not gather: it loses the origin of its own cancellation, which the server would report as a failure.
        await asyncio.wait(tasks)
        for task in tasks:
            if not task.cancelled():
                task.exception()
    for task in tasks:
        if task in done:
            task.result()
