"""A registration that was made before the camera, fixed to the marker on the patient instead."""

from tracker.geometry import Anchor, Camera, Marker, Rigid, Vertebra, chained_covariance, inverse_covariance
from tracker.pose import Seen
from tracker.registration.record import AnchoredTo, Registration


def fixed_to_reference(registration: Registration, reference: Seen) -> Registration:
    """The same registration beside the marker on the patient, which is seen in the same image."""
    pose: Rigid[Camera, Marker] = reference.camera_from_marker
    of_back = inverse_covariance(pose, reference.pose_covariance)
    before = registration.anchor_from_vertebra
    camera_from_vertebra: Rigid[Camera, Vertebra] = Rigid(
        rotation=before.rotation, translation_mm=before.translation_mm
    )
    beside = pose.inverse @ camera_from_vertebra
    fixed: Rigid[Anchor, Vertebra] = Rigid(rotation=beside.rotation, translation_mm=beside.translation_mm)
    return Registration(
        method=registration.method,
        anchored_to=AnchoredTo.REFERENCE,
        anchor_from_vertebra=fixed,
        covariance=chained_covariance(pose.inverse, of_back, camera_from_vertebra, registration.covariance),
    )
