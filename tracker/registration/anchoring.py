"""Re-anchor a registration from the camera to the patient's reference marker."""

import numpy as np

from tracker.geometry import Anchor, Reference, Rigid, Vertebra, chained_covariance, inverse_covariance
from tracker.pose import Seen
from tracker.registration.record import AnchoredTo, Registration


def anchor_to_reference(registration: Registration, reference: Seen) -> Registration:
    """Return the registration relative to the reference, seen in the same image.

    Patient and camera may then move independently; the covariance of the reference's pose is included.
    """
    if registration.anchored_to is AnchoredTo.REFERENCE:
        return registration
    marker = reference.camera_from_marker
    back: Rigid[Reference, Anchor] = Rigid(
        rotation=marker.rotation, translation_mm=marker.translation_mm
    ).inverse
    fixed: Rigid[Reference, Vertebra] = back @ registration.anchor_from_vertebra
    return Registration(
        method=registration.method,
        anchored_to=AnchoredTo.REFERENCE,
        anchor_from_vertebra=Rigid(rotation=fixed.rotation, translation_mm=fixed.translation_mm),
        covariance=chained_covariance(
            back,
            inverse_covariance(marker, reference.pose_covariance),
            registration.anchor_from_vertebra,
            registration.covariance,
        ),
        tip_jacobian=np.vstack(
            [back.rotation @ registration.tip_jacobian[:3], back.rotation @ registration.tip_jacobian[3:]]
        ),
        tool=registration.tool,
    )
