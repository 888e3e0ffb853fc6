"""What each pixel of an image sees of a marker's plane, blurred as the camera blurs it.

Only compiled loops: `collect` the pixels, keep the telling ones (`thinned`), `predict` what they see.
"""
