"""Two sides of one conversation: when one ends, the other has to."""

import asyncio
from collections.abc import Coroutine


async def until_one_ends(*sides: Coroutine[None, None, None]) -> None:
    """Run all sides until the first one ends, end the others, and raise what the first one raised."""
    tasks = [asyncio.create_task(side) for side in sides]
    try:
        done, _ = await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
    finally:
        for task in tasks:
            task.cancel()
        # Not gather: cancelled itself, it forgets by whom, and the server above takes that for a failure.
        await asyncio.wait(tasks)
        for task in tasks:
            if not task.cancelled():
                task.exception()
    for task in tasks:
        if task in done:
            task.result()
