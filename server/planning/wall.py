"""The distances to the bone around one channel, in a process of its own: worth seconds of work, once."""

from pathlib import Path

from server.imaging.meshes import mesh_from_bytes
from server.jobs import Report
from tracker.navigation.clearance import ChosenWall, choose_wall
from tracker.plan import Channel, PedicleMeasure
from tracker.plan.mesh.intake import Space


def wall_of(
    report: Report, *, path: str, channel: Channel, measure: PedicleMeasure | None, radius_mm: float
) -> ChosenWall:
    """The work itself: the surface as a case stores it (mm, LPS), and what a drill meets in it."""
    report(0.1, "measuring the distances to the bone")
    found = mesh_from_bytes(Path(path).read_bytes(), file_format="ply", unit="mm", space=Space.LPS)
    return choose_wall(channel, found.surface, measure, radius_mm=radius_mm)
