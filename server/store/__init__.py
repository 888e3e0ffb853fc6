"""What is kept: cases and all that set-up made for them. What was acknowledged is on disk."""
