"""Progress bars for the steps of a command, on standard error if it is a terminal."""

import contextlib
from collections.abc import Callable, Iterator

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TaskID, TextColumn, TimeRemainingColumn


class Steps:
    """Progress bars by step name; without a terminal nothing is shown."""

    def __init__(self, progress: Progress | None) -> None:
        self._progress = progress
        self._tasks: dict[str, TaskID] = {}

    def advance(self, step: str, total: int | None) -> None:
        """Advance this step by one; `total` is its expected length, None if unknown."""
        if self._progress is None:
            return
        if step not in self._tasks:
            self._tasks[step] = self._progress.add_task(step, total=total)
        self._progress.advance(self._tasks[step])


@contextlib.contextmanager
def shown_steps() -> Iterator[Steps]:
    """Show progress bars while the block runs and remove them at its end."""
    console = Console(stderr=True)
    if not console.is_terminal:
        yield Steps(None)
        return
    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn())
    with Progress(*columns, console=console, transient=True) as progress:
        yield Steps(progress)


@contextlib.contextmanager
def shown_ratio(step: str) -> Iterator[Callable[[float], None]]:
    """Show one progress bar while the block runs; yield a function that sets the completed share, 0 to 1."""
    console = Console(stderr=True)
    if not console.is_terminal:
        yield lambda _: None
        return
    columns = (TextColumn("{task.description}"), BarColumn(), TimeRemainingColumn())
    with Progress(*columns, console=console, transient=True) as progress:
        task = progress.add_task(step, total=1.0)
        yield lambda ratio: progress.update(task, completed=ratio)
