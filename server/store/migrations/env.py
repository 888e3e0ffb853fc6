"""Run by Alembic: applies all migrations atomically, in the transaction started by the store."""

from alembic import context

context.configure(connection=context.config.attributes["connection"], transactional_ddl=True)
with context.begin_transaction():
    context.run_migrations()
