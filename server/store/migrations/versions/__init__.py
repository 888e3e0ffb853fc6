"""Migrations in the order of `down_revision`; an existing migration is never edited."""
