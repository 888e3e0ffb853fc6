"""`coaxial marker`: a marker designed for a background, or an existing one checked against it."""

import itertools
import re
import zlib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
import numpy.typing as npt
import typer

from server.cli.background import Film, film_of
from server.cli.marker_report import Report, closest_picture, json_of, told
from server.cli.output import reject_unwritable, write_whole
from server.cli.progress import Steps, shown_steps
from server.marker_file import load_marker_image
from server.printing import marker_sheet, pdf_from_sheet, svg_from_sheet
from tracker.design import SEARCHED, Design, Shape, best_design, judgement_of, proposed_shapes
from tracker.errors import InvalidInput
from tracker.marker import MarkerModel, ScoreSettings

FAILED = 1
NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9_-]{0,39}")


@dataclass(frozen=True, slots=True, kw_only=True)
class DesignOrder:
    """What was asked for; see the options of `coaxial marker design`.

    Attributes:
        seed: None for the one of the name.
    """

    background: str | None
    side_mm: float
    output: Path
    name: str
    seed: int | None
    proposals: int
    images: int
    replace: bool

    @property
    def files(self) -> tuple[Path, Path, Path]:
        """SVG, PDF and model image."""
        svg, pdf, png = (self.output / f"{self.name}.{kind}" for kind in ("svg", "pdf", "png"))
        return svg, pdf, png

    @property
    def drawn_from(self) -> int:
        """The seed; where none was typed that of the name, because two markers of one shape are mistaken."""
        return zlib.crc32(self.name.encode()) if self.seed is None else self.seed


def design_marker(order: DesignOrder, *, as_json: bool) -> int:
    """Write the best of many proposals, tell its figures, and give the exit status: 0, or 1 if not unique.

    Raises:
        NavigationError: an option or the background cannot be used, or a file cannot be written.
    """
    if not NAME.fullmatch(order.name):
        raise InvalidInput(
            "MARKER_NAME_INVALID",
            f"'{order.name}' is no name for a marker",
            "Use letters, digits, - and _ with --name, at most 40, a letter or digit first.",
            {"name": order.name},
        )
    _reject_output(order)
    settings = ScoreSettings()
    with shown_steps() as steps:
        film = (
            None if order.background is None else film_of(order.background, images=order.images, steps=steps)
        )
        design = _designed(order, film, settings, steps)
    _write(design, order)
    report = Report(
        name=order.name,
        side_mm=order.side_mm,
        judgement=design.judgement,
        settings=settings,
        film=film,
        files=tuple(map(str, order.files)),
        made={"seed": order.drawn_from, "proposals": order.proposals},
    )
    if as_json:
        typer.echo(json_of(report))
    else:
        told(report)
        typer.echo(
            f"Wrote {', '.join(report.files)}.\n"
            "Print the PDF at 100 %, measure its rulers and the square, and track it with\n"
            f"  --marker {report.files[2]} --side-mm {order.side_mm:g}   (or the side that you measured)"
        )
        if not design.judgement.unique:
            typer.echo("Try more --proposals or another --seed: something still comes too close.")
    return 0 if design.judgement.unique else FAILED


def check_marker(
    image: Path, *, background: str | None, side_mm: float, output: Path, images: int, as_json: bool
) -> int:
    """Tell the figures of a marker, and give the exit status: 0, or 1 if something comes too close.

    Raises:
        NavigationError: the picture or the background cannot be used, or a file cannot be written.
    """
    settings = ScoreSettings()
    model = MarkerModel.from_image(load_marker_image(image), side_mm=side_mm, name=image.stem)
    with shown_steps() as steps:
        film = None if background is None else film_of(background, images=images, steps=steps)
        judgement = judgement_of(
            model,
            None if film is None else film.background,
            settings,
            advance=lambda: steps.advance("searching images", None if film is None else len(film.numbers)),
        )
    files: tuple[str, ...] = ()
    picture = None if film is None else closest_picture(model, judgement, film)
    if picture is not None:
        file = output / f"{image.stem}-closest.png"
        write_whole(file, _png(picture))
        files = (str(file),)
    report = Report(
        name=image.stem,
        side_mm=side_mm,
        judgement=judgement,
        settings=settings,
        film=film,
        files=files,
        made={},
    )
    if as_json:
        typer.echo(json_of(report))
    else:
        told(report)
        if files:
            typer.echo(f"Wrote {files[0]}: the closest place, its inside, and the marker.")
    return 0 if judgement.unique else FAILED


def _reject_output(order: DesignOrder) -> None:
    """Before the work: a printed marker must stay the one that is tracked, and files need a place."""
    there = [str(file) for file in order.files if file.exists()]
    if there and not order.replace:
        raise InvalidInput(
            "MARKER_FILES_EXIST",
            f"there is a marker '{order.name}' already: {', '.join(there)}",
            "Give another --name or --output, or --replace if no print of it is used.",
            {"files": there},
        )
    for file in order.files:
        reject_unwritable(file)


def _designed(order: DesignOrder, film: Film | None, settings: ScoreSettings, steps: Steps) -> Design:
    # First the page: a side that cannot be printed must not cost a minute.
    first = next(proposed_shapes(order.drawn_from))
    marker_sheet(first, side_mm=order.side_mm, name=order.name)
    searches = 0 if film is None else SEARCHED * len(film.numbers)
    return best_design(
        list(_proposed(order, steps)),
        None if film is None else film.background,
        settings,
        side_mm=order.side_mm,
        name=order.name,
        advance=lambda: steps.advance("searching images", searches),
    )


def _proposed(order: DesignOrder, steps: Steps) -> Iterator[Shape]:
    for shape in itertools.islice(proposed_shapes(order.drawn_from), order.proposals):
        steps.advance("proposing shapes", order.proposals)
        yield shape


def _write(design: Design, order: DesignOrder) -> None:
    sheet = marker_sheet(design.shape, side_mm=order.side_mm, name=order.name)
    svg, pdf, png = order.files
    write_whole(svg, svg_from_sheet(sheet).encode())
    write_whole(pdf, pdf_from_sheet(sheet))
    write_whole(png, _png(design.model.image))


def _png(image: npt.NDArray[np.uint8]) -> bytes:
    _, encoded = cv2.imencode(".png", image)
    return encoded.tobytes()
