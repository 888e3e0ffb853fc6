"""Several cameras that stand still to each other: where each is, and how sure that is."""

from tracker.camera.rig.calibrate import RigCamera, RigReport, ShotReport, calibrate_rig

__all__ = ["RigCamera", "RigReport", "ShotReport", "calibrate_rig"]
