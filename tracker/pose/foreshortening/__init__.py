"""The tilt of a square by how its middle is foreshortened; only a compiled function."""
