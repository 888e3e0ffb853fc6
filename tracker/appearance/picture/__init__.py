"""What each pixel of an image sees of a marker's plane, blurred as the camera blurs it.

Only compiled loops: `predict` what pixels see, and how far of it is on the paper.
"""
