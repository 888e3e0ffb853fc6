"""`coaxial marker`: design a marker for a background, or check an existing one."""

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

from server.cli.background import BackgroundImages, background_from
from server.cli.marker_report import Report, closest_picture, print_report, report_json
from server.cli.output import reject_unwritable, write_atomically
from server.cli.progress import Steps, shown_steps
from server.marker_file import load_marker_image
from server.printing import marker_sheet, pdf_from_sheet, svg_from_sheet
from tracker.design import MAX_SEARCHED, Design, Shape, assess_marker, best_design, proposed_shapes
from tracker.errors import InvalidInput
from tracker.marker import MarkerModel, ScoreSettings

FAILED = 1
NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9_-]{0,39}")


@dataclass(frozen=True, slots=True, kw_only=True)
class DesignOptions:
    """Options of `coaxial marker design`.

    Attributes:
        seed: None derives it from the name.
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
    def shape_seed(self) -> int:
        """Return the seed; by default a hash of the name, so that markers of different names differ."""
        return zlib.crc32(self.name.encode()) if self.seed is None else self.seed


def design_marker(options: DesignOptions, *, as_json: bool) -> int:
    """Write the best of many shapes and print its figures. Return the exit status: 0, or 1 if not unique.

    Raises:
        NavigationError: an option or the background cannot be used, or a file cannot be written.
    """
    if not NAME.fullmatch(options.name):
        raise InvalidInput(
            "MARKER_NAME_INVALID",
            f"'{options.name}' is not a valid marker name",
            "Use 1 to 40 letters, digits, - and _ for --name, starting with a letter or digit.",
            {"name": options.name},
        )
    _reject_output(options)
    settings = ScoreSettings()
    with shown_steps() as steps:
        film = (
            None
            if options.background is None
            else background_from(options.background, images=options.images, steps=steps)
        )
        design = _designed(options, film, settings, steps)
    _write(design, options)
    report = Report(
        name=options.name,
        side_mm=options.side_mm,
        assessment=design.assessment,
        settings=settings,
        film=film,
        files=tuple(map(str, options.files)),
        made={"seed": options.shape_seed, "proposals": options.proposals},
    )
    if as_json:
        typer.echo(report_json(report))
    else:
        print_report(report)
        typer.echo(
            f"Wrote {', '.join(report.files)}.\n"
            "Print the PDF at 100 %, measure its rulers and the square, and track it with\n"
            f"  --marker {report.files[2]} --side-mm {options.side_mm:g}   (or the measured side)"
        )
        if not design.assessment.unique:
            typer.echo("A false detection remains possible. Try more --proposals or another --seed.")
    return 0 if design.assessment.unique else FAILED


def check_marker(
    image: Path, *, background: str | None, side_mm: float, output: Path, images: int, as_json: bool
) -> int:
    """Print the figures of a marker. Return the exit status: 0, or 1 if a false detection is possible.

    Raises:
        NavigationError: the picture or the background cannot be used, or a file cannot be written.
    """
    settings = ScoreSettings()
    model = MarkerModel.from_image(load_marker_image(image), side_mm=side_mm, name=image.stem)
    with shown_steps() as steps:
        film = None if background is None else background_from(background, images=images, steps=steps)
        assessment = assess_marker(
            model,
            None if film is None else film.background,
            settings,
            advance=lambda: steps.advance("searching images", None if film is None else len(film.numbers)),
        )
    files: tuple[str, ...] = ()
    picture = None if film is None else closest_picture(model, assessment, film)
    if picture is not None:
        file = output / f"{image.stem}-closest.png"
        write_atomically(file, _png(picture))
        files = (str(file),)
    report = Report(
        name=image.stem,
        side_mm=side_mm,
        assessment=assessment,
        settings=settings,
        film=film,
        files=files,
        made={},
    )
    if as_json:
        typer.echo(report_json(report))
    else:
        print_report(report)
        if files:
            typer.echo(f"Wrote {files[0]}: the most similar place, its rectified image, and the marker.")
    return 0 if assessment.unique else FAILED


def _reject_output(options: DesignOptions) -> None:
    """Check the output files before the computation; an existing marker may already be printed."""
    existing = [str(file) for file in options.files if file.exists()]
    if existing and not options.replace:
        raise InvalidInput(
            "MARKER_FILES_EXIST",
            f"the marker '{options.name}' exists already: {', '.join(existing)}",
            "Give another --name or --output, or --replace if no print of this marker is in use.",
            {"files": existing},
        )
    for file in options.files:
        reject_unwritable(file)


def _designed(
    options: DesignOptions, film: BackgroundImages | None, settings: ScoreSettings, steps: Steps
) -> Design:
    # Checks the printed size first, because the search takes a minute.
    first = next(proposed_shapes(options.shape_seed))
    marker_sheet(first, side_mm=options.side_mm, name=options.name)
    searches = 0 if film is None else MAX_SEARCHED * len(film.numbers)
    return best_design(
        list(_proposed(options, steps)),
        None if film is None else film.background,
        settings,
        side_mm=options.side_mm,
        name=options.name,
        advance=lambda: steps.advance("searching images", searches),
    )


def _proposed(options: DesignOptions, steps: Steps) -> Iterator[Shape]:
    for shape in itertools.islice(proposed_shapes(options.shape_seed), options.proposals):
        steps.advance("proposing shapes", options.proposals)
        yield shape


def _write(design: Design, options: DesignOptions) -> None:
    sheet = marker_sheet(design.shape, side_mm=options.side_mm, name=options.name)
    svg, pdf, png = options.files
    write_atomically(svg, svg_from_sheet(sheet).encode())
    write_atomically(pdf, pdf_from_sheet(sheet))
    write_atomically(png, _png(design.model.image))


def _png(image: npt.NDArray[np.uint8]) -> bytes:
    _, encoded = cv2.imencode(".png", image)
    return encoded.tobytes()
