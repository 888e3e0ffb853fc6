"""Re-anchor a registration from the camera to the patient's reference marker."""

import numpy as np
import numpy.typing as npt

from tracker.geometry import Anchor, Reference, Rigid, Vertebra, chained_covariance, inverse_covariance
from tracker.pose import Seen, covariance_at_lever
from tracker.registration.record import AnchoredTo, Registration


def anchor_to_reference(
    registration: Registration, reference: Seen, *, at_in_vertebra_mm: npt.ArrayLike
) -> Registration:
    """Return the registration relative to the reference, seen in the same image.

    Patient and camera may then move independently; the covariance of the reference's pose is included, with
    the lever to a point (3,) of the vertebra near the planned screw.
    """
    if registration.anchored_to is AnchoredTo.REFERENCE:
        return registration
    marker = reference.camera_from_marker
    back: Rigid[Reference, Anchor] = Rigid(
        rotation=marker.rotation, translation_mm=marker.translation_mm
    ).inverse
    fixed: Rigid[Reference, Vertebra] = back @ registration.anchor_from_vertebra
    lever_mm = float(np.linalg.norm(fixed.move_points(at_in_vertebra_mm)))
    return Registration(
        method=registration.method,
        anchored_to=AnchoredTo.REFERENCE,
        anchor_from_vertebra=Rigid(rotation=fixed.rotation, translation_mm=fixed.translation_mm),
        covariance=chained_covariance(
            back,
            inverse_covariance(marker, covariance_at_lever(reference.pose_covariance, lever_mm)),
            registration.anchor_from_vertebra,
            registration.covariance,
        ),
        tip_jacobian=np.vstack(
            [back.rotation @ registration.tip_jacobian[:3], back.rotation @ registration.tip_jacobian[3:]]
        ),
        tool=registration.tool,
    )
