"""The commands `coaxial plan measure`, `labels`, `markups`, `dicom`, `send` and `series`."""

from pathlib import Path
from typing import Annotated

import typer

plan_app = typer.Typer(
    help="List series of a CT, measure pedicles, check labels, write a plan for 3D Slicer or as DICOM.",
    no_args_is_help=True,
    context_settings={"help_option_names": ["-h", "--help"]},
)

CtArgument = Annotated[
    Path, typer.Argument(help="Folder or zip of DICOM slices, or a NIfTI file.", metavar="CT")
]
PlanFileArgument = Annotated[Path, typer.Argument(help="A plan exported from the page.", metavar="PLAN.JSON")]
SlicesArgument = Annotated[Path, typer.Argument(help="Folder or zip of the CT's DICOM slices.", metavar="CT")]
LabelsOption = Annotated[
    Path | None, typer.Option(help="Labels of vertebrae, as for 'coaxial plan labels'.", metavar="LABELS")
]
NamesOption = Annotated[
    str, typer.Option(help="Levels of labels that the file does not name.", metavar="29:L3,28:L4")
]
SurfaceOption = Annotated[
    list[str] | None,
    typer.Option(
        help="Bone surface (STL, OBJ, PLY) of a vertebra, in LPS mm; repeatable.", metavar="L3=BONE.STL"
    ),
]
SeriesOption = Annotated[
    str | None,
    typer.Option(help="Series to read if CT contains several; see 'coaxial plan series'.", metavar="ID"),
]
ConfigOption = Annotated[
    Path | None, typer.Option(help="Settings file; default: ./config.yaml if it exists.", metavar="FILE")
]


@plan_app.callback()
def plan() -> None:
    """List series of a CT, measure pedicles, check labels, write a plan for 3D Slicer or as DICOM."""


@plan_app.command()
def measure(
    ct: CtArgument,
    side: Annotated[str, typer.Option(help="The patient's side: left or right.", metavar="SIDE")],
    seed_lps_mm: Annotated[
        str,
        typer.Option(
            help="A point inside the pedicle, x,y,z in mm (LPS: x to the left, y posterior, z superior).",
            metavar="X,Y,Z",
        ),
    ],
    series: SeriesOption = None,
    config: ConfigOption = None,
    markups: Annotated[
        Path | None,
        typer.Option(
            help="Also write channel and screw as lines for 3D Slicer (.mrk.json).", metavar="MRK.JSON"
        ),
    ] = None,
    json: Annotated[
        bool, typer.Option("--json", help="Write the figures as JSON.", show_default=False)
    ] = False,
) -> None:
    """Measure a pedicle from one point inside it: width, height, angles, length, and the screw that fits.

    Angles are relative to the patient axes, looking anteriorly: transverse_deg in the axial plane, positive
    towards medial; sagittal_deg in the sagittal plane, positive towards cranial.
    """
    from server.cli.plan import MeasureOptions, measure_in_file  # noqa: PLC0415  loaded when needed

    options = MeasureOptions(
        ct=ct, side=side, seed_lps_mm=seed_lps_mm, series=series, config=config, markups=markups
    )
    measure_in_file(options, as_json=json)


@plan_app.command()
def labels(
    ct: CtArgument,
    segmentation: Annotated[
        Path,
        typer.Argument(
            help="NIfTI with all labels, DICOM SEG, or a folder or zip of vertebrae_L3.nii.gz and so on.",
            metavar="LABELS",
        ),
    ],
    names: Annotated[
        str,
        typer.Option(
            help="Levels of labels that the file does not name; default: numbers of TotalSegmentator v2.",
            metavar="29:L3,28:L4",
        ),
    ] = "",
    series: SeriesOption = None,
    output: Annotated[
        Path | None,
        typer.Option(help="Also write the labels in the voxels of the CT.", metavar="LABELS.NII.GZ"),
    ] = None,
    json: Annotated[
        bool, typer.Option("--json", help="Write the figures as JSON.", show_default=False)
    ] = False,
) -> None:
    """Check a segmentation of the vertebrae against its CT: levels, volumes, and whether it lies on bone."""
    from server.cli.plan_labels import LabelOptions, check_labels  # noqa: PLC0415  loaded when needed

    options = LabelOptions(ct=ct, segmentation=segmentation, names=names, series=series, output=output)
    check_labels(options, as_json=json)


@plan_app.command()
def markups(
    plan: PlanFileArgument,
    output: Annotated[
        Path, typer.Option(help="File for 3D Slicer, ending in .mrk.json.", metavar="MRK.JSON")
    ],
) -> None:
    """Write landmarks, channels and screws of a plan for 3D Slicer, in the coordinates of its CT (LPS)."""
    from server.cli.plan_markups import write_plan_markups  # noqa: PLC0415  loaded when needed

    write_plan_markups(plan, output)


@plan_app.command()
def dicom(
    plan: PlanFileArgument,
    ct: SlicesArgument,
    output: Annotated[Path, typer.Option(help="Folder for the DICOM files.", metavar="FOLDER")],
    labels: LabelsOption = None,
    names: NamesOption = "",
    surface: SurfaceOption = None,
    series: SeriesOption = None,
) -> None:
    """Write a plan as DICOM objects of the CT's study: labels (SEG), models (STL) and measurements (SR).

    They contain the patient's name and ID of the CT, because an archive files them with it.
    """
    from server.cli.plan_dicom import DicomOptions, write_plan_dicom  # noqa: PLC0415  loaded when needed

    write_plan_dicom(
        DicomOptions(
            plan=plan,
            ct=ct,
            output=output,
            labels=labels,
            names=names,
            surfaces=tuple(surface or ()),
            series=series,
        )
    )


@plan_app.command()
def send(
    plan: PlanFileArgument,
    ct: SlicesArgument,
    labels: LabelsOption = None,
    names: NamesOption = "",
    surface: SurfaceOption = None,
    series: SeriesOption = None,
    config: ConfigOption = None,
) -> None:
    """Send the DICOM objects of a plan to the archive of the settings (dicom.archive), in the CT's study."""
    from server.cli.plan_dicom import DicomOptions, send_plan_dicom  # noqa: PLC0415  loaded when needed

    options = DicomOptions(
        plan=plan, ct=ct, labels=labels, names=names, surfaces=tuple(surface or ()), series=series
    )
    send_plan_dicom(options, config)


@plan_app.command()
def series(
    ct: CtArgument,
    json: Annotated[
        bool, typer.Option("--json", help="Write the series as JSON.", show_default=False)
    ] = False,
) -> None:
    """List the series of a CT: ID (for --series), number of slices, size and spacing."""
    from server.cli.plan_series import print_series  # noqa: PLC0415  loaded when needed

    print_series(ct, as_json=json)
