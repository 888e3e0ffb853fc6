"""What each pixel of an image sees of a marker's plane, blurred as the camera blurs it.

Only compiled loops: `collect` the telling pixels, `predict` what they see, and how far of it is on the paper.
"""
