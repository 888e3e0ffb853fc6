"""Messages of the check of a planned screw before navigation."""

from server.procedure.registration.points import LANDMARK_SD_MM
from server.procedure.setup_check import Basis, Remedy, RemedyKind, SetupCheck
from server.stream.message import Message
from tracker.navigation import RegistrationCheck
from tracker.plan.pedicle import Side
from tracker.registration import Method


class ChannelErrorMessage(Message):
    """Error on a channel and tolerance of the screw, rounded as in navigation."""

    entry_95_mm: float
    """95 % radius of the drill's axis at the entry, rounded up."""
    isthmus_95_mm: float
    """The same at the isthmus."""
    error_95_mm: float
    """The larger of both."""
    tolerance_mm: float
    """Distance from the screw on its planned axis to the nearest wall, rounded down."""
    suffices: bool
    """The error is within the tolerance."""


class RemedyMessage(Message):
    """A measure that reduces the error or increases the tolerance."""

    kind: RemedyKind
    expected: ChannelErrorMessage | None
    """Error with this remedy alone; null if it cannot be predicted."""
    landmarks: int | None
    """Number of landmarks; null for other remedies."""
    diameter_mm: float | None
    """Diameter of the screw; null for other remedies."""


class SetupCheckMessage(Message):
    """Whether the planned screw of the active channel can be navigated, and measures that would help."""

    basis: Basis
    """registration, or landmarks as planned if there is no registration yet."""
    method: Method | None
    """Method of the registration; null without one."""
    vertebra: str
    side: Side
    diameter_mm: float
    """Diameter of the planned screw."""
    tool: str | None
    """The tool with the smallest error; null if no tool is included."""
    landmark_sd_mm: float | None
    """Assumed error of a touched landmark, 1 SD per axis; null with a registration, which has its own."""
    found: ChannelErrorMessage
    """Smallest possible error of an image with the drill on the channel."""
    remedies: list[RemedyMessage]
    """Empty if the error is within the tolerance."""


def setup_check_message(check: SetupCheck) -> SetupCheckMessage:
    """Return the message of a check."""
    return SetupCheckMessage(
        basis=check.basis,
        method=check.method,
        vertebra=check.vertebra,
        side=check.side,
        diameter_mm=check.diameter_mm,
        tool=check.tool or None,
        landmark_sd_mm=LANDMARK_SD_MM if check.basis is Basis.LANDMARKS else None,
        found=_channel_error(check.check),
        remedies=[_remedy(one) for one in check.remedies],
    )


def _remedy(remedy: Remedy) -> RemedyMessage:
    return RemedyMessage(
        kind=remedy.kind,
        expected=None if remedy.check is None else _channel_error(remedy.check),
        landmarks=remedy.landmarks,
        diameter_mm=remedy.diameter_mm,
    )


def _channel_error(check: RegistrationCheck) -> ChannelErrorMessage:
    return ChannelErrorMessage.model_validate(check, from_attributes=True)
