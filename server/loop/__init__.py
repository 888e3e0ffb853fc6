"""The tracking process: tracks the newest image, supervised by the server and restarted when it dies."""
