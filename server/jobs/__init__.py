"""Background jobs in separate processes, so that they delay neither tracking nor video.

jobs = Jobs(log=settings)                      # in the main thread
job = jobs.start("reading the CT", read_ct, {"folder": str(folder)}, conclude=keep)
jobs.get(job.id).progress_ratio

def read_ct(report: Report, *, folder: str) -> dict[str, object]:      # at the top of a module
report(0.1, "sorting slices")
...
"""

from server.jobs.jobs import Jobs, JobUnknown
from server.jobs.records import Job, JobQueue, JobState
from server.jobs.worker import Report, Work

__all__ = ["Job", "JobQueue", "JobState", "JobUnknown", "Jobs", "Report", "Work"]
