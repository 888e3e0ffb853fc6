"""Poses of a marker from files: folders of matrices, text, CSV, NumPy, JSON, and `coaxial track`."""

from server.pose_file.read import PoseFiles, read_poses
from server.pose_file.record import PoseRecord
from server.pose_file.unit import Unit

__all__ = ["PoseFiles", "PoseRecord", "Unit", "read_poses"]
