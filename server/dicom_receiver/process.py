"""The receiver's process, which bytes of others may stop without harm to the server."""

import contextlib
import resource
import socket
import threading
from multiprocessing.connection import Connection
from pathlib import Path

from server.imaging.dicom_network.inbox import Inbox, InboxLimits
from server.imaging.dicom_network.receiver_settings import ReceiverSettings
from server.logs import LogSettings, configure_logging
from server.loop.parent import die_with_parent
from server.priority import lower_process_priority
from tracker.errors import Remark

# Whatever length a sender announces.
MAX_MEMORY_BYTES = 4 * 2**30
# A slice beyond the quota arrives whole, and is answered with the reason.
SLICE_BYTES = 2**26
POLL_S = 0.25


def run_receiver(
    listener: socket.socket,
    settings: ReceiverSettings,
    folder: Path,
    limits: InboxLimits,
    connection: Connection,
    log: LogSettings,
) -> None:
    """Receive until the connection to the web process is closed; each refusal is sent through it."""
    # The packages of DICOM take a second, and only this process needs them.
    from server.imaging.dicom_network.receiver import Receiver  # noqa: PLC0415

    die_with_parent()
    configure_logging(log, process="dicom receiver")
    lower_process_priority()
    with contextlib.suppress(ValueError, OSError):
        resource.setrlimit(resource.RLIMIT_AS, (MAX_MEMORY_BYTES, MAX_MEMORY_BYTES))
        # A write beyond it fails, so that one file cannot fill the disk before the inbox counts it.
        max_file_bytes = limits.max_bytes + SLICE_BYTES
        resource.setrlimit(resource.RLIMIT_FSIZE, (max_file_bytes, max_file_bytes))
    lock = threading.Lock()

    def report(remark: Remark) -> None:
        with lock, contextlib.suppress(OSError):
            connection.send(remark)

    receiver = Receiver(listener, settings, Inbox(folder, limits), report=report)
    receiver.start()
    with contextlib.suppress(EOFError, OSError):
        while not connection.poll(POLL_S):
            receiver.describe_quiet_series()
