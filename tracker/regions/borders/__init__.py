"""The borders of dark regions, walked between the pixels. Only compiled loops: `trace_borders`."""
