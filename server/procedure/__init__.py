"""The steps before the theatre, each with its gate: camera, tool, plan."""
