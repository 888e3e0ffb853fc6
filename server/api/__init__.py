"""REST: what can be asked, and the one shape in which it is refused."""
