"""What the server keeps while it runs: cases in their folder, and long work."""

from contextlib import ExitStack
from dataclasses import dataclass

import structlog

from server.jobs import Jobs
from server.logs import LogSettings
from server.store import CaseStore, Home, home_folder

log = structlog.get_logger(__name__)


@dataclass(frozen=True, slots=True, kw_only=True)
class Kept:
    """The store and the jobs of a running server.

    Attributes:
        store: where cases are kept.
        jobs: where long work is done.
    """

    store: CaseStore
    jobs: Jobs

    @classmethod
    def opened(cls, ending: ExitStack, settings: LogSettings) -> "Kept":
        """Take the folder for this server until `ending` ends; call it from the main thread.

        Raises:
            StoreError: another server has the folder, or it cannot be used.
        """
        home = ending.enter_context(Home(home_folder()))
        store = ending.enter_context(CaseStore(home))
        jobs = Jobs(log=settings)
        # First of all at the end: what it still concludes goes into the store.
        ending.callback(jobs.close)
        log.info("cases are kept in a folder", folder=str(home.folder))
        return cls(store=store, jobs=jobs)
