"""Migrations of the database to the current schema: one file in `versions` per change."""
