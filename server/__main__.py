"""`python -m server` is `coaxial`."""

from server.cli import main

__all__ = ["main"]

if __name__ == "__main__":
    main()
