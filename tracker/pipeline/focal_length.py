"""Error of the camera's stated focal length, from markers in different views.

A single view may be misled by a bent print or a wrong distortion coefficient, whose effect differs from view
to view: its estimates scatter by more than their standard deviations. The error is therefore stated from
many views, with a standard deviation that is increased by their scatter.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from tracker.camera import CameraModel
from tracker.geometry import Camera, Marker, Rigid
from tracker.marker import MarkerModel
from tracker.photometric import FocalLengthError, focal_length_error
from tracker.pose import DECIDED_COST, ImageContext, Seen, side_px_of

# A view is new if the marker is rotated or displaced by this much from all others.
NEW_VIEW_DEG, NEW_VIEW_SIDES = 8.0, 1.0
# A view is measured again after this time, because somebody may have turned the lens meanwhile.
REPEATED_AFTER_S = 60.0
# One fit costs some milliseconds: fewer at a time than would delay the images.
MIN_INTERVAL_S = 0.1
MIN_VIEWS, MAX_VIEWS = 12, 64
# Frontal views say nothing. The best ones are limited by print and lens, not by noise.
MAX_SD, MIN_SD = 0.2, 0.003


@dataclass(frozen=True, slots=True)
class View:
    """A measured view of a marker.

    Attributes:
        name: of the marker.
        camera_from_marker: its pose.
        measured_at_s: capture time of the image.
        error: of the focal length by this image.
    """

    name: str
    camera_from_marker: Rigid[Camera, Marker]
    measured_at_s: float
    error: FocalLengthError


class FocalLengthMonitor:
    """Measures the focal length in new views of the markers. Mutable.

    Attributes:
        camera: the camera model.
        models: the markers by name.
        views: the newest ones, at most `MAX_VIEWS`.
    """

    def __init__(self, camera: CameraModel, models: Mapping[str, MarkerModel]) -> None:
        self.camera, self.models = camera, models
        self.views: list[View] = []
        self._measured_at_s = -np.inf

    @property
    def error(self) -> FocalLengthError | None:
        """Return the error by all views; None from fewer than `MIN_VIEWS`."""
        if len(self.views) < MIN_VIEWS:
            return None
        ratios = np.array([one.error.ratio for one in self.views])
        weights = np.array([max(one.error.sd, MIN_SD) for one in self.views]) ** -2.0
        mean = float(np.average(ratios, weights=weights))
        # The Birge ratio: scatter of the views by what their standard deviations say.
        scatter = float((weights * (ratios - mean) ** 2).sum()) / (len(ratios) - 1)
        return FocalLengthError(ratio=mean, sd=float(np.sqrt(max(scatter, 1.0) / weights.sum())))

    def adopt(self, other: "FocalLengthMonitor") -> None:
        """Take over the views of a monitor of the same camera, of the markers that both have."""
        if np.array_equal(self.camera.lens, other.camera.lens):
            self.views = [one for one in other.views if self._has(other.models[one.name])]

    def take(self, pixels: ImageContext, sightings: Mapping[str, Seen], at_s: float) -> None:
        """Measure the first of these markers that is in a new view, if its pose is unambiguous."""
        if at_s - self._measured_at_s < MIN_INTERVAL_S:
            return
        for name, seen in sightings.items():
            if seen.delta_chi2 < DECIDED_COST:
                continue
            near = self._near(name, seen.camera_from_marker)
            if any(at_s - one.measured_at_s < REPEATED_AFTER_S for one in near):
                continue
            self._measured_at_s = at_s
            error = self.measure(pixels, self.models[name], seen)
            if error is not None and error.sd <= MAX_SD:
                self.views = [one for one in self.views if not any(one is old for old in near)]
                self.views.append(View(name, seen.camera_from_marker, at_s, error))
                del self.views[:-MAX_VIEWS]
            return

    def measure(self, pixels: ImageContext, model: MarkerModel, seen: Seen) -> FocalLengthError | None:
        """Return the error of the focal length by one view; None where the marker is not clean."""
        return focal_length_error(
            pixels.image,
            self.camera.lens,
            pixels.textures[model.name],
            seen.camera_from_marker,
            side_mm=model.side_mm,
            side_px=side_px_of(seen.corners_px),
        )

    def _has(self, model: MarkerModel) -> bool:
        own = self.models.get(model.name)
        return own is not None and own.side_mm == model.side_mm and np.array_equal(own.square, model.square)

    def _near(self, name: str, here: Rigid[Camera, Marker]) -> list[View]:
        """Return the views of this marker that are not different from a pose; called for each image."""
        own = [one for one in self.views if one.name == name]
        if not own:
            return []
        offsets_mm = np.array([one.camera_from_marker.translation_mm for one in own]) - here.translation_mm
        rotations = np.array([one.camera_from_marker.rotation for one in own])
        is_near = np.linalg.norm(offsets_mm, axis=1) < NEW_VIEW_SIDES * self.models[name].side_mm
        # The trace of a rotation is 1 + 2 cos of its angle.
        is_near &= np.einsum("kij,ij->k", rotations, here.rotation) > 1.0 + 2.0 * np.cos(
            np.radians(NEW_VIEW_DEG)
        )
        return [one for one, near in zip(own, is_near, strict=True) if near]
