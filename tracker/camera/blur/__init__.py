"""How a camera blurs what it sees, the lens and motion together: variances along u, along v, and between.

Only compiled loops: the `axes_of` a blur, a blur kept within bounds, which of some pictures is next to it.
"""
