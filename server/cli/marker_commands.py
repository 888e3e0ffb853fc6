"""The commands `coaxial marker design` and `coaxial marker check`."""

from pathlib import Path
from typing import Annotated

import typer

marker_app = typer.Typer(
    help="Design a marker that cannot be confused with a given background, or check an existing one.",
    no_args_is_help=True,
    context_settings={"help_option_names": ["-h", "--help"]},
)

BackgroundOption = Annotated[
    str | None,
    typer.Option(
        help="Scene without the marker: a video, a folder of images, or 'rehearsal'.",
        metavar="VIDEO",
    ),
]
SideOption = Annotated[float, typer.Option("--side-mm", help="Side of the black square in mm.", metavar="MM")]
OutputOption = Annotated[Path, typer.Option(help="Output folder.", metavar="FOLDER")]
ImagesOption = Annotated[
    int, typer.Option(help="Number of background images to search, evenly spaced.", min=1)
]
JsonOption = Annotated[bool, typer.Option("--json", help="Write the figures as JSON.", show_default=False)]


@marker_app.command()
def design(
    background: BackgroundOption = None,
    side_mm: SideOption = 25.0,
    output: OutputOption = Path(),
    name: Annotated[str, typer.Option(help="Name of the marker and of its files.")] = "marker",
    seed: Annotated[
        int | None,
        typer.Option(
            help="Seed of the random shapes; default: derived from the name, so that markers of different "
            "names differ.",
            min=0,
        ),
    ] = None,
    proposals: Annotated[int, typer.Option(help="Number of candidate shapes.", min=4, max=20_000)] = 300,
    images: ImagesOption = 120,
    replace: Annotated[
        bool, typer.Option("--replace", help="Overwrite a marker of the same name.", show_default=False)
    ] = False,
    json: JsonOption = False,
) -> None:
    """Design a square marker; write it as SVG and PDF at true size, and as the PNG that the tracker reads.

    Without a background the marker is only compared with its own rotations and mirror image.
    Exit status 1 if a false detection remains possible; the files are written anyway.
    """
    from server.cli.marker import DesignOptions, design_marker  # noqa: PLC0415  loaded when needed

    options = DesignOptions(
        background=background,
        side_mm=side_mm,
        output=output,
        name=name,
        seed=seed,
        proposals=proposals,
        images=images,
        replace=replace,
    )
    raise typer.Exit(design_marker(options, as_json=json))


@marker_app.command()
def check(
    image: Annotated[
        Path, typer.Argument(help="Image of the marker whose black square fills it edge to edge.")
    ],
    background: BackgroundOption = None,
    side_mm: SideOption = 25.0,
    output: OutputOption = Path(),
    images: ImagesOption = 120,
    json: JsonOption = False,
) -> None:
    """Check an existing marker, and write an image of the most similar place in the background.

    Without a background the marker is only compared with its own rotations and mirror image.
    Exit status 1 if a false detection is possible.
    """
    from server.cli.marker import check_marker  # noqa: PLC0415  loaded when needed

    status = check_marker(
        image, background=background, side_mm=side_mm, output=output, images=images, as_json=json
    )
    raise typer.Exit(status)
