"""Replaces the measured tables between their marks in the README."""

from pathlib import Path

README = Path(__file__).with_name("README.md")


def with_section(text: str, name: str, content: str) -> str:
    """Return the text with this content between `<!-- name -->` and `<!-- end of name -->`.

    Raises:
        ValueError: the text has no such marks.
    """
    start, end = f"<!-- {name} -->", f"<!-- end of {name} -->"
    before, opened, rest = text.partition(start)
    _, closed, after = rest.partition(end)
    if not opened or not closed:
        raise ValueError(f"the README has no section between {start} and {end}")
    return f"{before}{start}\n\n{content.strip()}\n\n{end}{after}"


def write_section(name: str, content: str) -> None:
    """Write this content into its section of the README."""
    README.write_text(with_section(README.read_text(encoding="utf-8"), name, content), encoding="utf-8")
