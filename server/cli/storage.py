"""Case store and background jobs of a running server."""

from contextlib import ExitStack
from dataclasses import dataclass

import structlog

from server.home_folder import home_folder
from server.jobs import Jobs
from server.logs import LogSettings
from server.store import CaseStore, Home

log = structlog.get_logger(__name__)


@dataclass(frozen=True, slots=True, kw_only=True)
class Storage:
    """Case store and background jobs of a running server.

    Attributes:
        store: Stores the cases.
        jobs: Runs background jobs.
    """

    store: CaseStore
    jobs: Jobs

    @classmethod
    def opened(cls, ending: ExitStack, settings: LogSettings) -> "Storage":
        """Lock the home folder for this server until `ending` closes. Call it from the main thread.

        Raises:
            StoreError: another server uses the folder, or it is not accessible.
        """
        home = ending.enter_context(Home(home_folder()))
        store = ending.enter_context(CaseStore(home))
        jobs = Jobs(log=settings)
        # Closed first, because jobs that finish write their results into the store.
        ending.callback(jobs.close)
        log.info("case store opened", folder=str(home.folder))
        return cls(store=store, jobs=jobs)
