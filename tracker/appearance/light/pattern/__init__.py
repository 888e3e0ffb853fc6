"""Whether what even light leaves unexplained looks like light: smooth over the marker, on dark or bright."""
