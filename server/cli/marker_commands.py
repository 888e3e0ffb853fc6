"""What can be typed after `coaxial marker`: design a marker, or check one."""

from pathlib import Path
from typing import Annotated

import typer

marker_app = typer.Typer(
    help="Design a marker that nothing in a background imitates, or check one.",
    no_args_is_help=True,
    context_settings={"help_option_names": ["-h", "--help"]},
)

BackgroundOption = Annotated[
    str | None,
    typer.Option(
        help="What the marker must not be mistaken in: a video, a folder of images, or 'rehearsal'.",
        metavar="VIDEO",
    ),
]
SideOption = Annotated[float, typer.Option("--side-mm", help="Side of the black square in mm.", metavar="MM")]
OutputOption = Annotated[Path, typer.Option(help="Folder that files are written into.", metavar="FOLDER")]
ImagesOption = Annotated[
    int, typer.Option(help="Images of the background that are looked at, evenly spread over it.", min=1)
]
JsonOption = Annotated[bool, typer.Option("--json", help="Write the figures as JSON.", show_default=False)]


@marker_app.command()
def design(
    background: BackgroundOption = None,
    side_mm: SideOption = 25.0,
    output: OutputOption = Path(),
    name: Annotated[str, typer.Option(help="Name of the marker, and of its files.")] = "marker",
    seed: Annotated[
        int | None,
        typer.Option(
            help="Another seed proposes other shapes; it comes from the name if left out, so that "
            "another name has another shape.",
            min=0,
        ),
    ] = None,
    proposals: Annotated[int, typer.Option(help="Shapes that are compared.", min=4, max=20_000)] = 300,
    images: ImagesOption = 120,
    replace: Annotated[
        bool, typer.Option("--replace", help="Write over a marker of the same name.", show_default=False)
    ] = False,
    json: JsonOption = False,
) -> None:
    """Propose a square marker, and write it as SVG and PDF at true size and as the picture that is tracked.

    Without a background it is only compared with itself, turned and mirrored.
    Exit status 1 if something still comes too close; the files are written all the same.
    """
    from server.cli.marker import DesignOrder, design_marker  # noqa: PLC0415  loaded when needed

    order = DesignOrder(
        background=background,
        side_mm=side_mm,
        output=output,
        name=name,
        seed=seed,
        proposals=proposals,
        images=images,
        replace=replace,
    )
    raise typer.Exit(design_marker(order, as_json=json))


@marker_app.command()
def check(
    image: Annotated[
        Path, typer.Argument(help="Picture of the marker, filled edge to edge by its black square.")
    ],
    background: BackgroundOption = None,
    side_mm: SideOption = 25.0,
    output: OutputOption = Path(),
    images: ImagesOption = 120,
    json: JsonOption = False,
) -> None:
    """Measure an existing marker the same way, and write a picture of where the background comes closest.

    Without a background it is only compared with itself, turned and mirrored.
    Exit status 1 if something comes too close.
    """
    from server.cli.marker import check_marker  # noqa: PLC0415  loaded when needed

    status = check_marker(
        image, background=background, side_mm=side_mm, output=output, images=images, as_json=json
    )
    raise typer.Exit(status)
