"""Job function that measures a pedicle from a seed point."""

from server.jobs import Report
from server.planning.volume import load_volume
from tracker.plan import measure_pedicle
from tracker.plan.document import plain


def measure_in_ct(
    report: Report, *, path: str, lps_from_ijk: list[list[float]], seed_lps_mm: list[float], side: str
) -> object:
    """Return the measured pedicle as JSON-serialisable values."""
    report(0.1, "measuring the pedicle")
    return plain(measure_pedicle(load_volume(path, lps_from_ijk), seed_lps_mm, side))
