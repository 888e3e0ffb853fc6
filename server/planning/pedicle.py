"""A pedicle measured from a click, in a process of its own: it takes seconds of a core."""

from server.jobs import Report
from server.planning.volume import volume_of
from tracker.plan import measure_pedicle
from tracker.plan.document import plain


def measure_in_ct(
    report: Report, *, path: str, lps_from_ijk: list[list[float]], seed_lps_mm: list[float], side: str
) -> object:
    """The pedicle's numbers, as `plain` says them."""
    report(0.1, "looking for the pedicle")
    return plain(measure_pedicle(volume_of(path, lps_from_ijk), seed_lps_mm, side))
