"""Which pixels of an image tell of a marker at about a pose.

Only compiled loops: `collect` takes them.
"""
