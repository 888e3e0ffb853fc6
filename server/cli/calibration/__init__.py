"""`coaxial calibrate` and `coaxial calibrate-rig`: calibrate cameras from images of a board."""
