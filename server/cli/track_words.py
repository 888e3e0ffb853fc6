"""What `coaxial track --help` says: above all what stands in its lines."""

TRACK_HELP = """\
Track every image of a video, as fast as possible and none skipped.

The JSON file gets its name when all images that can be read are in it.
Where some cannot, they are told, with exit status 2.
Until then, or if the run is stopped or refused, it is FILE.part.

In a line of JSON, null where it cannot be told:

time_s: the video's own time; the images of a folder come at
camera.rate_hz of the settings, at 30 Hz if that is left out.

camera_from_marker: rotation (3x3) and translation_mm, with --camera.

pose_covariance: 6x6 in mm and rad, translation first, then rotation
as a small left-multiplied rotation vector in the camera's frame.

reason: why the marker is not seen.
NO_CANDIDATE: nothing in the image has the outline of the marker.
SCORE_TOO_LOW: something has, but too few of the marker's edges are there.
TARGET_SCORE_TOO_LOW: too many edges are there that the marker has not.
SHAPE_DIFFERS: its edges fit, but a part inside is dark for bright.
"""
