"""Reading of marker poses from files: folders of matrices, text, CSV, NumPy, JSON, `coaxial track`."""

from server.pose_file.reader import PoseFiles, read_poses
from server.pose_file.record import PoseRecord
from server.pose_file.unit import Unit

__all__ = ["PoseFiles", "PoseRecord", "Unit", "read_poses"]
