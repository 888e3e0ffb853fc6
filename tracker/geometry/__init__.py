"""Coordinate frames, rigid transforms, angles, and covariance propagation."""

from tracker.geometry.cylinder import cylinder_ring_mm, cylinder_silhouette_mm
from tracker.geometry.frames import Anchor, Camera, Marker, Pattern, Reference, Tool, Vertebra
from tracker.geometry.rigid import (
    Rigid,
    chained_covariance,
    inverse_covariance,
    inverse_jacobian,
    point_covariance_mm2,
    product_jacobians,
)
from tracker.geometry.rotations import (
    Array,
    angle_between_deg,
    nearest_rotation,
    rotation_between,
    rotation_from_half_axes,
    rotation_from_vector,
    skew,
    vector_from_rotation,
)

__all__ = [
    "Anchor",
    "Array",
    "Camera",
    "Marker",
    "Pattern",
    "Reference",
    "Rigid",
    "Tool",
    "Vertebra",
    "angle_between_deg",
    "chained_covariance",
    "cylinder_ring_mm",
    "cylinder_silhouette_mm",
    "inverse_covariance",
    "inverse_jacobian",
    "nearest_rotation",
    "point_covariance_mm2",
    "product_jacobians",
    "rotation_between",
    "rotation_from_half_axes",
    "rotation_from_vector",
    "skew",
    "vector_from_rotation",
]
