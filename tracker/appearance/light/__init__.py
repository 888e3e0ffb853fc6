"""How bright dark and bright are over the marker: even light, a plane, or uneven light, a net of nodes.

Only compiled loops. A shadow's edge and glare are uneven; to let light vary everywhere costs exactness, so
that even light is tried first.
"""
