"""Figures on the structure of the code, printed by `make house`."""
