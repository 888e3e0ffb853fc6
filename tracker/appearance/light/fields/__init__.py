"""Light over the marker: even, or a field of it that a shadow dims, that glare adds to, or that does both.

A shadow takes the same share of what dark and bright send back; a highlight adds the same to both. Told
apart, each is one field in place of two, and leaves twice as much of the pixels for the pose.

A field bends little, or much at an edge (Cauchy prior), not a little everywhere. It is fitted wherever the
residuals of even light look like light, however small they are: under the edge of a shadow tips are off by
2.9 times the Cramer-Rao bound without it and by 1.7 times with it (shadow0.5, camera A). Of two poses with
equal residuals the one in more unusual light costs more. Where all fits ended at one planar solution the
other one is fitted in that light too, since both may have slipped before light was known, to tips 20 mm off
with 1 mm stated.
"""
