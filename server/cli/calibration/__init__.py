"""`coaxial calibrate` and `coaxial calibrate-rig`: from images of a board to a camera file."""
