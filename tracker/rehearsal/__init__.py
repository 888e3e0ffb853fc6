"""A theatre that exists only in software, with known truth."""
