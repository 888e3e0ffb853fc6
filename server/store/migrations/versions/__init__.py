"""Migrations of the database, in the order of their `down_revision`; none is edited after a release."""
