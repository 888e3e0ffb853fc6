"""Messages of the check of a planned screw before navigation."""

from server.procedure.setup_check import Basis, Remedy, RemedyKind, SetupCheck
from server.stream.message import Message
from tracker.navigation import RegistrationCheck
from tracker.plan.pedicle import Side
from tracker.registration import Method


class ChannelErrorMessage(Message):
    """The error on a channel and what the screw leaves, rounded as navigation rounds them."""

    entry_95_mm: float
    """95 % radius of the drill's axis at the entry, rounded up."""
    isthmus_95_mm: float
    """The same at the isthmus."""
    error_95_mm: float
    """The larger of both."""
    tolerance_mm: float
    """From the screw on its planned axis to the nearest wall, rounded down."""
    suffices: bool
    """The error is within the tolerance."""


class RemedyMessage(Message):
    """What would reduce the error or leave more room for it."""

    kind: RemedyKind
    expected: ChannelErrorMessage | None
    """With this remedy alone; null where it cannot be predicted."""
    landmarks: int | None
    """Their number; null for other remedies."""
    diameter_mm: float | None
    """Of the screw; null for other remedies."""


class SetupCheckMessage(Message):
    """Whether the planned screw of the active channel can be navigated, and what would help."""

    basis: Basis
    """registration, or landmarks as planned, before there is one."""
    method: Method | None
    """Of the registration; null before there is one."""
    vertebra: str
    side: Side
    diameter_mm: float
    """Of the planned screw."""
    tool: str | None
    """The one with the least error; null where no tool is included."""
    found: ChannelErrorMessage
    """The least error of every image with the drill on the channel."""
    remedies: list[RemedyMessage]
    """Empty if it suffices."""


def setup_check_message(check: SetupCheck) -> SetupCheckMessage:
    """Return the message of a check."""
    return SetupCheckMessage(
        basis=check.basis,
        method=check.method,
        vertebra=check.vertebra,
        side=check.side,
        diameter_mm=check.diameter_mm,
        tool=check.tool or None,
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
    return ChannelErrorMessage(
        entry_95_mm=check.entry_95_mm,
        isthmus_95_mm=check.isthmus_95_mm,
        error_95_mm=check.error_95_mm,
        tolerance_mm=check.tolerance_mm,
        suffices=check.suffices,
    )
