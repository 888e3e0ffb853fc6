"""How a camera blurs what it sees, the lens and motion together: variances along u, along v, and between.

Only compiled loops: the `axes_of` a blur, a blur kept within bounds or `mapped` onto a plane, what of it is a
smear, the taps of a bell, which of some pictures is next to it.
"""
