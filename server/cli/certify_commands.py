"""The commands `coaxial certify plate`, `issue`, `check`, `signer` and `rehearse`."""

from pathlib import Path
from typing import Annotated

import typer

from server.cli.board_commands import Paper
from server.cli.tool_commands import LengthUnit

certify_app = typer.Typer(
    help="Measure the accuracy of camera and tool on a plate with divots, and issue a signed certificate.",
    no_args_is_help=True,
    context_settings={"help_option_names": ["-h", "--help"]},
)
JsonOption = Annotated[bool, typer.Option("--json", help="Write the result as JSON.", show_default=False)]
RulersOption = Annotated[
    str | None,
    typer.Option(
        "--rulers-mm",
        help="Measured lengths of the printed rulers, across and down the page.",
        metavar="X,Y",
        show_default=False,
    ),
]
RulerSdOption = Annotated[
    float,
    typer.Option(
        "--ruler-sd-mm",
        help="Standard deviation of these lengths: 0.1 with calipers, 0.2 with a steel ruler.",
        min=0.001,
        max=5.0,
        metavar="MM",
    ),
]


@certify_app.command()
def plate(
    output: Annotated[
        Path,
        typer.Option(
            "--output",
            "-o",
            help="Page to write; .pdf or .svg. The plate file is FILE with .yaml.",
            metavar="FILE",
        ),
    ],
    size: Annotated[str, typer.Option(help="Columns x rows of divots.", metavar="CxR")] = "3x3",
    pitch_mm: Annotated[
        float, typer.Option("--pitch-mm", help="Distance between neighbouring divots.", metavar="MM")
    ] = 60.0,
    name: Annotated[str, typer.Option(help="Name of the plate.", metavar="NAME")] = "A4-3x3",
    sd_mm: Annotated[
        float,
        typer.Option(
            "--sd-mm",
            help="Standard deviation of a tip held on a cross, along each axis: 0.2 on paper by eye.",
            min=0.01,
            max=2.0,
            metavar="MM",
        ),
    ] = 0.2,
    paper: Annotated[Paper, typer.Option(help="Paper size.")] = Paper.A4,
) -> None:
    """Make a plate to print at true size, and its plate file.

    For a machined plate, write a plate file by hand, without rulers_mm.
    """
    from server.cli.certify import PlateOptions, write_plate  # noqa: PLC0415  loaded when needed

    write_plate(
        PlateOptions(output=output, size=size, pitch_mm=pitch_mm, name=name, sd_mm=sd_mm, paper=paper.value)
    )


@certify_app.command()
def issue(
    captures: Annotated[
        Path,
        typer.Argument(
            help="Captures file: divot, placement, posture and poses of each.", metavar="CAPTURES"
        ),
    ],
    plate_file: Annotated[Path, typer.Option("--plate", help="Plate file.", metavar="FILE")],
    camera: Annotated[Path, typer.Option("--camera", help="Camera file.", metavar="FILE")],
    tool: Annotated[
        Path, typer.Option("--tool", help="Tool file written by 'coaxial pivot'.", metavar="FILE")
    ],
    rulers_mm: RulersOption = None,
    ruler_sd_mm: RulerSdOption = 0.2,
    output: Annotated[
        Path | None,
        typer.Option(
            "--output",
            "-o",
            help="Write the certificate as FILE.json and FILE.pdf if it passes.",
            metavar="FILE",
        ),
    ] = None,
    valid_days: Annotated[
        int, typer.Option("--valid-days", help="Days until it expires.", min=1, max=366)
    ] = 90,
    max_error_mm: Annotated[
        float,
        typer.Option(
            "--max-error-mm", help="Largest error that is certified.", min=0.01, max=20.0, metavar="MM"
        ),
    ] = 2.0,
    by: Annotated[str, typer.Option("--by", help="Person who did the test.", metavar="NAME")] = "",
    unit: Annotated[LengthUnit, typer.Option(help="Unit of the translations.")] = LengthUnit.MM,
    json: JsonOption = False,
) -> None:
    """Assess recorded captures, and issue a certificate where nothing speaks against it.

    Hold the tip in each divot upright, tilted and turned, with the plate tilted to the camera at two
    distances. Figures follow ASTM F2554. Exit status 1 if the accuracy is refused, with all reasons.
    """
    from server.cli.certify import IssueOptions, issue_certificate  # noqa: PLC0415  loaded when needed
    from server.installation import product_version  # noqa: PLC0415

    options = IssueOptions(
        captures=captures,
        plate=plate_file,
        camera=camera,
        tool=tool,
        rulers_mm=rulers_mm,
        ruler_sd_mm=ruler_sd_mm,
        output=output,
        valid_days=valid_days,
        max_error_mm=max_error_mm,
        by=by,
        unit=unit.value,
        version=product_version(),
    )
    raise typer.Exit(issue_certificate(options, as_json=json))


@certify_app.command()
def check(
    file: Annotated[Path, typer.Argument(help="Certificate, JSON or PDF.", metavar="FILE")],
    signer: Annotated[
        str | None,
        typer.Option(
            "--signer",
            help="Public key of who must have signed it; default: the key of this installation.",
            metavar="KEY",
        ),
    ] = None,
    camera: Annotated[
        Path | None, typer.Option("--camera", help="Camera file that it must be valid for.", metavar="FILE")
    ] = None,
    tool: Annotated[
        Path | None, typer.Option("--tool", help="Tool file that it must be valid for.", metavar="FILE")
    ] = None,
    json: JsonOption = False,
) -> None:
    """Verify signature, signer and expiry of a certificate.

    With --camera or --tool also that these files and this version of Coaxial are those of its test. Exit
    status 1 if it is not valid, 2 if it is no certificate or was altered. Anyone can sign a certificate with
    a key of their own: get the key of --signer from the issuer in another way.
    """
    from server.cli.certify_check import CheckOptions, check_certificate  # noqa: PLC0415  loaded when needed
    from server.installation import product_version  # noqa: PLC0415

    options = CheckOptions(file=file, signer=signer, camera=camera, tool=tool, version=product_version())
    raise typer.Exit(check_certificate(options, as_json=json))


@certify_app.command()
def signer() -> None:
    """Print the public key of this installation, by which others check its certificates."""
    from server.certificate import SigningKey  # noqa: PLC0415  loaded when needed
    from server.home_folder import home_folder  # noqa: PLC0415

    typer.echo(SigningKey(home_folder()).signer)


@certify_app.command()
def rehearse(
    output: Annotated[
        Path,
        typer.Option("--output", "-o", help="Folder to write; must be empty or missing.", metavar="FOLDER"),
    ],
    print_scale_percent: Annotated[
        float,
        typer.Option(
            "--print-scale",
            help="Error of the printed size; -1 is too small.",
            min=-10,
            max=10,
            metavar="PERCENT",
        ),
    ] = 0.0,
    tip_offset_mm: Annotated[
        float, typer.Option("--tip-offset", help="Error of the tip.", min=0, max=10, metavar="MM")
    ] = 0.0,
    focal_percent: Annotated[
        float, typer.Option("--focal", help="Error of the focal length.", min=-10, max=10, metavar="PERCENT")
    ] = 0.0,
    seed: Annotated[int, typer.Option(help="Seed of all random numbers.", min=0)] = 1,
) -> None:
    """Write the files of a simulated accuracy test, whose truth is known, with faults if wanted.

    'coaxial certify issue' reads them like those of a real test.
    """
    from server.cli.certify_rehearsal import write_rehearsal  # noqa: PLC0415  loaded when needed
    from tracker.accuracy.rehearsed import RehearsedFaults  # noqa: PLC0415

    faults = RehearsedFaults(
        print_scale_ratio=print_scale_percent / 100.0,
        tip_offset_mm=tip_offset_mm,
        focal_error_ratio=focal_percent / 100.0,
    )
    write_rehearsal(output, faults, seed=seed)
