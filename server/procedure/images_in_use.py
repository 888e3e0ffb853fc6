"""Rejection of steps that need images of a camera while an external tracker measures."""

from server.errors import SetupOrderError
from server.live import LiveHub


def reject_without_images(hub: LiveHub) -> None:
    """Raise if the newest poses come from an external tracker, which has no images.

    Raises:
        SetupOrderError: NO_CAMERA_IN_USE.
    """
    newest = hub.newest
    snapshot = None if newest is None else newest.snapshot
    if snapshot is not None and not snapshot.setup.has_images:
        raise no_camera_in_use()


def no_camera_in_use() -> SetupOrderError:
    """Return the error of a step that needs images."""
    return SetupOrderError(
        "NO_CAMERA_IN_USE",
        "this step needs images of a camera, but the poses come from an external tracker",
        "Use a step without images, or start with a camera as the source.",
    )
