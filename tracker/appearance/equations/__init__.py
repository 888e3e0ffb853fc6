"""What pixels and what is known beforehand say of pose, blur, response and light: the normal equations.

Only compiled loops: which pixels to `trust`, the `equations`, and the typical size of what is left.
"""
