"""Tables of detection rates and pose errors."""

from collections.abc import Callable, Sequence

from tests.benchmarks.claims import ELLIPSOID_95, CorrectClaim, Error, FalseClaim, Judgement, NoClaim
from tests.benchmarks.tables import Table, median, number, pair, share
from tracker.navigation import AbsentReason
from tracker.rehearsal import Phase

# Found on the marker, but tilted the wrong way: the pose is useless.
FAR_TIP_MM = 2.0
# Median of chi-square with three degrees of freedom.
ELLIPSOID_50 = 2.366

Group = tuple[str, Sequence[Judgement]]


def groups_by_phase(judgements: Sequence[Judgement]) -> list[Group]:
    """Return the images of each phase, and all of them."""
    phases = [(phase.value, [one for one in judgements if one.phase is phase]) for phase in Phase]
    return [*((name, some) for name, some in phases if some), ("**all**", judgements)]


def errors_of(judgements: Sequence[Judgement]) -> list[Error]:
    """Return the errors of the correct claims."""
    return [one.outcome.error for one in judgements if isinstance(one.outcome, CorrectClaim)]


def false_claims(judgements: Sequence[Judgement]) -> list[Judgement]:
    """Return the images in which something else was taken for the marker."""
    return [one for one in judgements if isinstance(one.outcome, FalseClaim)]


def missed(judgements: Sequence[Judgement]) -> list[Judgement]:
    """Return the images with the marker in view and no claim."""
    return [one for one in judgements if one.in_view and isinstance(one.outcome, NoClaim)]


def withheld(judgements: Sequence[Judgement]) -> list[Judgement]:
    """Return the images whose pose was too uncertain to place the tip."""
    return [
        one
        for one in judgements
        if isinstance(one.outcome, NoClaim) and one.outcome.reason == AbsentReason.POSE_UNCERTAIN.value
    ]


def found_table(title: str, groups: Sequence[Group]) -> Table:
    """Table of correct and false detections."""
    rows = []
    for name, some in groups:
        right = [one for one in some if isinstance(one.outcome, CorrectClaim)]
        in_view = sum(one.in_view for one in some)
        by = [one.outcome.found_by for one in right if isinstance(one.outcome, CorrectClaim)]
        rows.append(
            [
                name,
                str(len(some)),
                str(in_view),
                share(sum(one.in_view for one in right), in_view, 2),
                str(sum(not one.in_view for one in right)),
                str(len(withheld(some))),
                str(len(false_claims(some))),
                str(sum(error.tip_mm > FAR_TIP_MM for error in errors_of(some))),
                number(max((error.tip_mm for error in errors_of(some)), default=float("nan"))),
                str(by.count("track")),
                str(by.count("search")),
            ]
        )
    return Table(
        title=title,
        columns=[
            "",
            "images",
            "marker in view",
            "found of these",
            "found, partly in view",
            "withheld as uncertain",
            "false claims",
            f"tip off by over {FAR_TIP_MM:g} mm",
            "largest tip error mm",
            "by track",
            "by search",
        ],
        rows=rows,
    )


def pose_table(title: str, groups: Sequence[Group], *, note: str = "") -> Table:
    """Table of pose errors: median / 95th percentile."""
    columns: list[tuple[str, Callable[[Error], float]]] = [
        ("corners px", lambda error: error.corner_px),
        ("marker across mm", lambda error: error.across_mm),
        ("marker along mm", lambda error: abs(error.along_mm)),
        ("rotation °", lambda error: error.rotation_deg),
        ("**tip mm**", lambda error: error.tip_mm),
        ("entry offset mm", lambda error: error.entry_offset_mm),
        ("angle °", lambda error: error.angle_deg),
        ("depth mm", lambda error: error.depth_mm),
    ]
    with_errors = [(name, errors_of(some)) for name, some in groups]
    return Table(
        title=title,
        columns=["", *(title for title, _ in columns)],
        rows=[
            [name, *(pair(map(value, errors), 95.0, 3) for _, value in columns)]
            for name, errors in with_errors
        ],
        note=note,
    )


def calibration_table(title: str, groups: Sequence[Group], *, note: str = "") -> Table:
    """Table of the coverage of the stated tip covariance, and of the bias along the line of sight."""
    rows = []
    for name, some in groups:
        errors = errors_of(some)
        inside = sum(error.tip_mahalanobis_squared <= ELLIPSOID_95 for error in errors)
        typical = median(error.tip_mahalanobis_squared for error in errors) / ELLIPSOID_50
        rows.append(
            [
                name,
                share(inside, len(errors)),
                number(typical**0.5),
                number(median(error.along_mm for error in errors), 3),
            ]
        )
    return Table(
        title=title,
        columns=[
            "",
            "tips within the stated 95 % ellipsoid",
            "typical error / stated (1 is consistent)",
            "signed median along the sight mm",
        ],
        rows=rows,
        note=note,
    )
