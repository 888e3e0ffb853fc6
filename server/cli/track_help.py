"""Help text of `coaxial track` with the fields of its output."""

TRACK_HELP = """\
Track every image of a video as fast as possible, without skipping any.

The output is written to FILE.part and renamed to FILE when it is complete.
Images that cannot be read are reported, with exit status 2.
An interrupted run leaves FILE.part.

Fields of a JSON line (null if unknown):

time_s: time stamp of the video. For a folder, images are spaced
by camera.rate_hz of the settings (default 30 Hz).

camera_from_marker: rotation (3x3) and translation_mm, with --camera.

calibration_sha256: of the camera model that the pose was computed with.

pose_covariance: 6x6 in mm and rad, translation first, then rotation
as a small left-multiplied rotation vector in the camera's frame.
For a point at a lever L in mm, R being the rotation part, add
(L/2)^2 (trace(R)^2 + 2 trace(R R)) to its variance along each axis.

reason: why the marker was not detected.
NO_CANDIDATE: no quadrilateral in the image matches the marker.
SCORE_TOO_LOW: too few edges of the marker were found.
TARGET_SCORE_TOO_LOW: too many edges that the marker does not have.
SHAPE_DIFFERS: the edges fit, but an inner region has the wrong polarity.
NOT_REPORTED: an external tracker has no pose of it; not in a video.
MARKER_TWICE: a second print of the marker is in view.
"""
