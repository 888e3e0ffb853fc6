"""Job function that simulates the CT of the rehearsal's vertebra around its pedicles."""

from server.jobs import Report
from tracker.plan import Volume
from tracker.plan.crop import cropped_around


def scan_rehearsal(report: Report) -> Volume:
    """Return the part around both pedicles of the CT that `GET /api/rehearsal/ct` returns."""
    # Imported here, because only this job needs the simulation.
    from tracker.rehearsal.anatomy import pedicle_channels  # noqa: PLC0415
    from tracker.rehearsal.ct import rehearsal_ct  # noqa: PLC0415

    report(0.1, "simulating the scan")
    ends = [
        point
        for channel in pedicle_channels()
        for point in (channel.entry_in_vertebra_mm, channel.target_in_vertebra_mm)
    ]
    return cropped_around(rehearsal_ct(), ends)
