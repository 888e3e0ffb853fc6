"""Frame rate and latency of the theatre page in a browser without a graphics card."""
