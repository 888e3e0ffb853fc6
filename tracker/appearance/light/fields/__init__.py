"""Light over the marker: even, or a field of it that a shadow dims, that glare adds to, or that does both.

A shadow takes the same share of what dark and bright send back; a highlight adds the same to both. Told
apart, each is one field in place of two, and leaves twice as much of the pixels for the pose.
"""
