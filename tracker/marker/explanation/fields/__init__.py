"""A square and its paper on a grid of fields, and the model as it is blurred there. Only compiled loops."""
