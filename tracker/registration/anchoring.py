"""A registration that was made in the camera's image, fixed to the marker on the patient."""

import numpy as np

from tracker.geometry import Anchor, Reference, Rigid, Vertebra, chained_covariance, inverse_covariance
from tracker.pose import Seen
from tracker.registration.record import AnchoredTo, Registration


def fixed_to_reference(registration: Registration, reference: Seen) -> Registration:
    """The same registration as seen from the reference, which was seen in the same image.

    From then on patient and camera may move together or alone; the reference's own uncertainty is in it.
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
        tip_slope=np.vstack(
            [back.rotation @ registration.tip_slope[:3], back.rotation @ registration.tip_slope[3:]]
        ),
        tool=registration.tool,
    )
