"""A sender of slices, and a receiver in this process or in one of its own."""

import socket
import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from pydicom.dataset import Dataset, FileMetaDataset
from pydicom.uid import UID, ExplicitVRLittleEndian
from pynetdicom import AE
from pynetdicom.association import Association

from server.imaging.dicom_network.inbox import Inbox, InboxLimits, ReceivedSeries
from server.imaging.dicom_network.receiver import Receiver
from server.imaging.dicom_network.receiver_settings import ReceiverSettings
from tracker.errors import Remark

LIMITS = InboxLimits(max_bytes=10**8, max_series=3, max_age_s=3600.0)
SETTINGS = ReceiverSettings(ae_title="COAXIAL", allowed=("SCANNER", "ORTHANC"))


def until(is_done: Callable[[], Any], *, timeout_s: float = 30.0) -> Any:  # noqa: ANN401  whatever it returns
    """What the function returns as soon as it is true."""
    end_s = time.monotonic() + timeout_s
    while not (found := is_done()):
        assert time.monotonic() < end_s, "it did not happen"
        time.sleep(0.02)
    return found


def listening() -> socket.socket:
    """A socket on a free port."""
    listener = socket.socket()
    listener.bind(("127.0.0.1", 0))
    listener.listen(16)
    return listener


@dataclass(kw_only=True)
class Door:
    """A running receiver, with what it reported."""

    port: int
    inbox: Inbox
    receiver: Receiver
    now_s: float = 1e9
    clock_set_by_s: float = 0.0
    remarks: list[Remark] = field(default_factory=list)

    @property
    def codes(self) -> list[str]:
        return [one.code for one in self.remarks]

    def waiting(self) -> tuple[ReceivedSeries, ...]:
        return self.inbox.waiting(time.time())

    def described(self) -> ReceivedSeries:
        """The only series, as soon as it is complete."""

        def find() -> ReceivedSeries | None:
            self.now_s += 10.0
            self.receiver.describe_quiet_series()
            (one,) = self.waiting()
            return one if one.description or one.problem else None

        found: ReceivedSeries = until(find)
        return found


@contextmanager
def door(
    folder: Path, *, limits: InboxLimits = LIMITS, settings: ReceiverSettings = SETTINGS
) -> Iterator[Door]:
    """A receiver in this process."""
    listener = listening()
    remarks: list[Remark] = []
    inbox = Inbox(folder, limits)
    opened: list[Door] = []
    receiver = Receiver(
        listener,
        settings,
        Inbox(folder, limits),
        report=remarks.append,
        clock=lambda: opened[0].now_s if opened else 1e9,
        seconds=lambda: opened[0].now_s - opened[0].clock_set_by_s if opened else 0.0,
    )
    opened.append(Door(port=listener.getsockname()[1], inbox=inbox, receiver=receiver, remarks=remarks))
    opened[0].now_s = time.time()
    receiver.start()
    try:
        yield opened[0]
    finally:
        receiver.stop()


def associated(
    port: int,
    *,
    title: str = "SCANNER",
    called: str = "COAXIAL",
    classes: Iterable[str] = ("1.2.840.10008.5.1.4.1.1.2", "1.2.840.10008.1.1"),
    syntax: str = ExplicitVRLittleEndian,
    tls: Any = None,  # noqa: ANN401  as pynetdicom takes it
) -> Association:
    """A connection to the receiver."""
    entity = AE(ae_title=title)
    entity.acse_timeout = entity.dimse_timeout = entity.network_timeout = 20
    for one in classes:
        entity.add_requested_context(one, syntax)
    return entity.associate("127.0.0.1", port, ae_title=called, tls_args=tls)


def sent(association: Association, slices: Iterable[Dataset]) -> list[int]:
    """Status of each slice."""
    return [int(association.send_c_store(with_meta(one)).Status) for one in slices]


def with_meta(one: Dataset, syntax: str = ExplicitVRLittleEndian) -> Dataset:
    """A slice as pynetdicom takes it."""
    one.file_meta = FileMetaDataset()
    one.file_meta.TransferSyntaxUID = UID(syntax)
    return one
