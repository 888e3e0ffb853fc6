"""All screenshots on one page, with the faults of each."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from html import escape

HEAD = """<!doctype html><meta charset="utf-8"><title>Screenshots</title><style>
body { background: #444; color: #eee; font: 14px sans-serif; }
section { display: flex; flex-wrap: wrap; gap: 8px; align-items: flex-start; }
figure { margin: 0; } figcaption { max-width: 420px; } img { max-width: 420px; max-height: 420px; }
li { color: #fb8; }
</style>
"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Picture:
    """One screenshot.

    Attributes:
        file: Name of its file.
        variant: Size, theme and language.
        faults: What was found in the page.
    """

    file: str
    variant: str
    faults: Sequence[str]


def contact_sheet(pictures: Mapping[str, Sequence[Picture]]) -> str:
    """HTML page with the pictures of each state, by the state's name."""
    sections = [
        f"<h2>{escape(name)}</h2><section>{''.join(map(_figure, shown))}</section>"
        for name, shown in pictures.items()
    ]
    return HEAD + "".join(sections)


def _figure(picture: Picture) -> str:
    file = escape(picture.file)
    faults = "".join(f"<li>{escape(one)}</li>" for one in picture.faults)
    return (
        f'<figure><a href="{file}"><img loading=lazy src="{file}"></a>'
        f"<figcaption>{escape(picture.variant)}<ul>{faults}</ul></figcaption></figure>"
    )
