"""Sending of objects to an archive (C-STORE)."""

import io
import ssl
from collections.abc import Sequence
from dataclasses import dataclass

import pydicom
from pydicom.uid import ExplicitVRLittleEndian
from pynetdicom import AE, evt
from pynetdicom.association import Association
from pynetdicom.pdu import A_ASSOCIATE_RJ

from server.config import DicomConfig
from server.imaging.dicom.header import without_warnings
from server.imaging.dicom_objects import PlanObject
from tracker.errors import NavigationError

TIMEOUT_S = 20.0
# Status of C-STORE (PS3.4, B.2.3): stored, and stored with a warning.
STORED, STORED_WITH_WARNING = 0x0000, range(0xB000, 0xC000)


class ArchiveError(NavigationError):
    """The archive cannot be reached, or does not accept the connection."""


@dataclass(frozen=True, slots=True, kw_only=True)
class StoreAnswer:
    """Answer of the archive for one object.

    Attributes:
        name: name of the object.
        is_stored: whether the archive has it.
        text: its answer, as a part of a sentence.
    """

    name: str
    is_stored: bool
    text: str


def send_objects(objects: Sequence[PlanObject], settings: DicomConfig) -> tuple[StoreAnswer, ...]:
    """Send objects in one association; return the archive's answer for each.

    Raises:
        ArchiveError: ARCHIVE_NOT_SET, ARCHIVE_CERTIFICATE_UNUSABLE, ARCHIVE_UNREACHABLE, ARCHIVE_REJECTED.
    """
    archive = settings.archive
    if archive.host is None:
        raise ArchiveError(
            "ARCHIVE_NOT_SET",
            "the settings name no archive",
            "Set host, port and ae_title under dicom.archive.",
        )
    entity = AE(ae_title=settings.ae_title)
    entity.acse_timeout = entity.dimse_timeout = entity.network_timeout = TIMEOUT_S
    entity.connection_timeout = TIMEOUT_S
    for uid in sorted({one.sop_class_uid for one in objects}):
        entity.add_requested_context(uid, ExplicitVRLittleEndian)
    rejections: list[A_ASSOCIATE_RJ] = []

    def note(event: evt.Event) -> None:
        # An archive that closes the connection at once looks to `associate` like one that cannot be reached.
        if isinstance(event.pdu, A_ASSOCIATE_RJ):
            rejections.append(event.pdu)

    association = entity.associate(
        archive.host,
        archive.port,
        ae_title=archive.ae_title,
        tls_args=(_tls_context(settings), archive.host) if archive.tls else None,
        evt_handlers=[(evt.EVT_PDU_RECV, note)],
    )
    if not association.is_established:
        is_rejected = bool(rejections or association.rejected_contexts)
        raise _not_established(settings, is_rejected=is_rejected)
    try:
        return tuple(_sent(association, one) for one in objects)
    finally:
        if association.is_established:
            association.release()


def _sent(association: Association, one: PlanObject) -> StoreAnswer:
    accepted = {context.abstract_syntax for context in association.accepted_contexts}
    if one.sop_class_uid not in accepted and association.is_established:
        kind = pydicom.uid.UID(one.sop_class_uid).name
        return StoreAnswer(name=one.name, is_stored=False, text=f"it does not accept {kind}")
    if not association.is_established:
        return StoreAnswer(name=one.name, is_stored=False, text="the connection ended before")
    with without_warnings():
        status = association.send_c_store(pydicom.dcmread(io.BytesIO(one.content)))
    code = status.get("Status")
    if code is None:
        return StoreAnswer(name=one.name, is_stored=False, text="no answer within the time limit")
    if code == STORED:
        return StoreAnswer(name=one.name, is_stored=True, text="stored")
    return StoreAnswer(
        name=one.name,
        is_stored=code in STORED_WITH_WARNING,
        text=f"{'stored' if code in STORED_WITH_WARNING else 'not stored'}, status {code:04X}",
    )


def _tls_context(settings: DicomConfig) -> ssl.SSLContext:
    """Return a context that verifies the archive's certificate."""
    file = settings.archive.ca
    try:
        return ssl.create_default_context(cafile=None if file is None else str(file))
    except (OSError, ValueError):
        raise ArchiveError(
            "ARCHIVE_CERTIFICATE_UNUSABLE",
            f"there is no certificate in {file} that the archive's could be verified with",
            "Give a PEM file in dicom.archive.ca.",
            {"file": str(file)},
        ) from None


def _not_established(settings: DicomConfig, *, is_rejected: bool) -> ArchiveError:
    archive = settings.archive
    place = {"host": archive.host, "port": archive.port, "ae_title": archive.ae_title}
    if is_rejected:
        return ArchiveError(
            "ARCHIVE_REJECTED",
            f"the archive {archive.ae_title} at {archive.host}:{archive.port} rejects the connection of "
            f"{settings.ae_title}",
            "Enter this AE title in the archive, and check the archive's own AE title in the settings.",
            {**place, "own_title": settings.ae_title},
        )
    return ArchiveError(
        "ARCHIVE_UNREACHABLE",
        f"the archive at {archive.host}:{archive.port} does not answer",
        "Check address, port, TLS and network of the archive.",
        place,
    )
