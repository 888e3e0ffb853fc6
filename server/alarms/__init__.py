"""Alarms: what they look at, what is kept of them, and how they sound."""
