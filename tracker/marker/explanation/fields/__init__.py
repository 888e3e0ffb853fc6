"""A square and its paper on a grid of fields, and the model as it is blurred there. Only compiled loops.

Which part of a blur is motion is measured in image pixels. On a marker tilted by 60 degrees the lens's blur
is twice as long in one direction; in marker coordinates that would pass for motion, and true markers would
correlate at 0.93 instead of 0.98.
"""
