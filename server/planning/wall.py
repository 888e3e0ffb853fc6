"""Job function that measures the distances to the bone around one channel."""

from pathlib import Path

from server.imaging.meshes import mesh_from_bytes
from server.jobs import Report
from tracker.navigation.clearance import WallSelection, select_wall
from tracker.plan import Channel, PedicleMeasure
from tracker.plan.mesh.intake import Space


def measure_wall(
    report: Report, *, path: str, channel: Channel, measure: PedicleMeasure | None, radius_mm: float
) -> WallSelection:
    """Choose the wall around a channel from a stored bone surface (PLY, mm, LPS)."""
    report(0.1, "measuring the distances to the bone")
    found = mesh_from_bytes(Path(path).read_bytes(), file_format="ply", unit="mm", space=Space.LPS)
    return select_wall(channel, found.surface, measure, radius_mm=radius_mm)
