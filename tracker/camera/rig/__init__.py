"""Extrinsic calibration of several fixed cameras, with uncertainty."""

from tracker.camera.rig.calibrate import RigCamera, RigReport, ShotReport, calibrate_rig

__all__ = ["RigCamera", "RigReport", "ShotReport", "calibrate_rig"]
