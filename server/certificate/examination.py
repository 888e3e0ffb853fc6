"""Examination of a system: assessment of the captures of an accuracy test, and its certificate."""

from collections.abc import Sequence
from dataclasses import dataclass

from server.certificate.content import Certificate, ExaminedSystem, Issue, certificate_of
from tracker.accuracy import AccuracyAssessment, AccuracyLimits, DivotCapture, assess_accuracy


@dataclass(frozen=True, slots=True, kw_only=True)
class Examination:
    """Result of an accuracy test.

    Attributes:
        assessment: figures, faults, and the problems that prevent a certificate.
        certificate: not signed yet; None with problems.
    """

    assessment: AccuracyAssessment
    certificate: Certificate | None


def assess(
    captures: Sequence[DivotCapture], system: ExaminedSystem, *, limits: AccuracyLimits | None = None
) -> AccuracyAssessment:
    """Return the assessment of the captures of a system.

    Raises:
        InvalidInput: as `assess_accuracy`.
    """
    plate = system.plate.plate()
    return assess_accuracy(captures, plate, system.tool, plate_scale=system.scale, limits=limits)


def examine(
    captures: Sequence[DivotCapture],
    system: ExaminedSystem,
    issue: Issue,
    *,
    limits: AccuracyLimits | None = None,
) -> Examination:
    """Return the assessment, and the certificate of a test without problems.

    Raises:
        InvalidInput: as `assess_accuracy`, or CERTIFICATE_PERIOD_INVALID.
    """
    found = assess(captures, system, limits=limits)
    certificate = None if found.problems else certificate_of(found, captures, system, issue)
    return Examination(assessment=found, certificate=certificate)
