"""The tracking process: tracks the newest image, is watched, and is started again when it dies."""
