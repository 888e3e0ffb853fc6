"""Reception of CT series by C-STORE, and of C-ECHO. For a process of its own.

A slice is answered with success when it is on the disk. A series is complete when all connections that
sent slices of it have been released: what a broken connection sent stays incomplete until it is sent again.
"""

import math
import socket
import socketserver
import ssl
import tempfile
import threading
import time
from collections.abc import Callable
from typing import cast

import pydicom
from pydicom import uid
from pynetdicom import AE, _config, evt
from pynetdicom.dimse_primitives import C_STORE
from pynetdicom.sop_class import Verification  # pyrefly: ignore[missing-module-attribute]  made at its import
from pynetdicom.transport import ThreadedAssociationServer

from server.clock import SteadyClock
from server.imaging.ct_reader import list_series
from server.imaging.dicom.header import BAD_DICOM, CT_CLASSES, text, without_warnings
from server.imaging.dicom_network.inbox import Inbox
from server.imaging.dicom_network.receiver_settings import ReceiverSettings
from tracker.errors import InvalidInput, Remark

# Status of C-STORE (PS3.4, B.2.3).
SUCCESS, OUT_OF_RESOURCES, DOES_NOT_MATCH, CANNOT_UNDERSTAND = 0x0000, 0xA700, 0xA900, 0xC000
SYNTAXES = (
    uid.ExplicitVRLittleEndian,
    uid.ImplicitVRLittleEndian,
    uid.ExplicitVRBigEndian,
    uid.RLELossless,
    uid.JPEGLossless,
    uid.JPEGLosslessSV1,
    uid.JPEGLSLossless,
    uid.JPEG2000Lossless,
    uid.JPEG2000,
)
MAX_CONNECTIONS = 16
TIMEOUT_S, POLL_S = 30.0, 0.1
# A sender may use a connection for each slice: a series is described after none came for so long.
QUIET_S = 1.0
PREPARE_EACH_S = 60.0
# Titles are shown and logged; the standard allows 16 letters.
MAX_TITLE = 16


class _Context(ssl.SSLContext):
    """A context whose handshake is made by the thread of a connection, not by that which accepts all."""

    def wrap_socket(self, sock: socket.socket, *_: object, **__: object) -> ssl.SSLSocket:
        sock.settimeout(TIMEOUT_S)
        return super().wrap_socket(sock, server_side=True, do_handshake_on_connect=False)


class _Server(ThreadedAssociationServer):
    """A server on a socket that is listening already."""

    listener: socket.socket

    def server_bind(self) -> None:
        if self.socket is not None:
            self.socket.close()
        self.socket = self.listener
        self.server_address = self.listener.getsockname()

    def verify_request(self, request: object, client_address: object) -> bool:  # noqa: ARG002  its signature
        return len(self.active_associations) < MAX_CONNECTIONS

    def shutdown(self) -> None:
        # The method of pynetdicom expects that its entity started the server.
        socketserver.TCPServer.shutdown(self)
        self.server_close()

    def handle_error(self, request: object, client_address: object) -> None:
        """Write no traceback of a connection that failed."""


class Receiver:
    """Receives series into the inbox.

    Args:
        listener: the listening socket.
        settings: names and TLS.
        inbox: where series are stored.
        report: called with each refusal, from any thread.
        clock: Unix time, to which the ages of files are compared. By default one that is steady, so that
            nothing is deleted because the computer's clock was set.
        seconds: monotonic time.
    """

    def __init__(
        self,
        listener: socket.socket,
        settings: ReceiverSettings,
        inbox: Inbox,
        *,
        report: Callable[[Remark], None],
        clock: Callable[[], float] | None = None,
        seconds: Callable[[], float] = time.monotonic,
    ) -> None:
        self._inbox = inbox
        self._report = report
        steady = SteadyClock()
        self._clock = clock or (lambda: steady().timestamp())
        self._seconds = seconds
        self._lock = threading.Lock()
        self._touched: dict[object, set[str]] = {}
        self._released: dict[str, float] = {}
        self._prepared_s = -math.inf
        inbox.clear_incoming()
        # Slices are written to the disk while they arrive. The setting is the process's, until `stop`.
        self._former_tempdir = tempfile.tempdir
        tempfile.tempdir = str(inbox.incoming)
        _config.STORE_RECV_CHUNKED_DATASET = True
        _config.LOG_HANDLER_LEVEL = "none"
        self._entity = _entity(settings)
        server_class = type("_ListeningServer", (_Server,), {"listener": listener})
        self._server = self._entity.make_server(
            listener.getsockname()[:2],
            ssl_context=_tls_context(settings),
            evt_handlers=[
                (evt.EVT_REQUESTED, self._requested),
                (evt.EVT_C_STORE, self._store),
                (evt.EVT_RELEASED, self._release),
                (evt.EVT_REJECTED, self._reject),
                (evt.EVT_CONN_CLOSE, self._close),
            ],
            server_class=server_class,
        )

    def start(self) -> None:
        """Receive in another thread."""
        threading.Thread(
            target=self._server.serve_forever, args=(POLL_S,), name="dicom receiver", daemon=True
        ).start()

    def stop(self) -> None:
        """End all connections, and close the socket."""
        for association in self._entity.active_associations:
            # One that was rejected waits for the sender to close it, and cannot be aborted.
            if association.is_established:
                association.abort()
        self._server.shutdown()
        tempfile.tempdir = self._former_tempdir

    def describe_quiet_series(self) -> None:
        """Describe series to which nothing was added for a moment; call it again and again.

        Each minute, what is too old is deleted.
        """
        now_s = self._seconds()
        if now_s - self._prepared_s > PREPARE_EACH_S:
            self._prepare()
        with self._lock:
            busy = set().union(*self._touched.values())
            quiet = [
                one for one, at_s in self._released.items() if now_s - at_s >= QUIET_S and one not in busy
            ]
            for one in quiet:
                del self._released[one]
        for one in quiet:
            try:
                (described,) = list_series(self._inbox.files_of(one))
                self._inbox.describe(one, described)
            except InvalidInput as error:
                self._inbox.describe(one, Remark.from_error(error))

    def _requested(self, _event: evt.Event) -> None:
        self._prepare()

    def _prepare(self) -> None:
        self._prepared_s = self._seconds()
        self._inbox.prepare(self._clock())

    def _store(self, event: evt.Event) -> int:
        """Store one slice; return the status."""
        try:
            with without_warnings():
                header = pydicom.dcmread(
                    event.dataset_path,
                    stop_before_pixels=True,
                    specific_tags=["SOPClassUID", "SOPInstanceUID", "SeriesInstanceUID"],
                )
            series_uid, instance_uid = text(header, "SeriesInstanceUID"), text(header, "SOPInstanceUID")
            sop_class = text(header, "SOPClassUID")
        except BAD_DICOM:
            self._report(_damaged())
            return CANNOT_UNDERSTAND
        request = cast("C_STORE", event.request)
        announced = str(request.AffectedSOPClassUID), str(request.AffectedSOPInstanceUID)
        if not series_uid or sop_class not in CT_CLASSES or (sop_class, instance_uid) != announced:
            self._report(_damaged())
            return DOES_NOT_MATCH
        try:
            stored = self._inbox.put(event.dataset_path, series_uid=series_uid, instance_uid=instance_uid)
        except InvalidInput as error:
            self._report(Remark.from_error(error))
            return CANNOT_UNDERSTAND if error.code == "RECEIVE_CONTRADICTS" else OUT_OF_RESOURCES
        except OSError:
            self._report(
                Remark(
                    code="RECEIVE_NOT_WRITTEN",
                    message="a slice was refused, because it cannot be written to the disk",
                    remedy="Free space on the disk, and send again.",
                )
            )
            return OUT_OF_RESOURCES
        with self._lock:
            self._touched.setdefault(event.assoc, set()).add(stored)
            self._released.pop(stored, None)
        return SUCCESS

    def _release(self, event: evt.Event) -> None:
        with self._lock:
            for one in self._touched.pop(event.assoc, ()):
                self._released[one] = self._seconds()

    def _close(self, event: evt.Event) -> None:
        """Report what a connection leaves incomplete that ended without release."""
        if event.assoc.is_released:
            self._release(event)
            return
        with self._lock:
            broken = self._touched.pop(event.assoc, set())
            for one in broken:
                self._released.pop(one, None)
        if broken:
            self._report(
                Remark(
                    code="RECEIVE_INTERRUPTED",
                    message="a connection ended before the sender had finished; its series is not complete",
                    remedy="Send the series again.",
                )
            )

    def _reject(self, event: evt.Event) -> None:
        title = str(event.assoc.requestor.ae_title)
        shown = "".join(letter if letter.isprintable() else "?" for letter in title)[:MAX_TITLE]
        self._report(
            Remark(
                code="RECEIVE_SENDER_REFUSED",
                message=f"a connection of {shown} was refused: its title or the called title is not in the "
                "settings, or there are too many connections",
                remedy="Check the AE titles under dicom in the settings, and those of the sender.",
                context={"title": shown},
            )
        )


def _damaged() -> Remark:
    return Remark(
        code="RECEIVE_DAMAGED",
        message="a file was refused, because it is no readable CT slice",
        remedy="Send the CT series alone.",
    )


def _entity(settings: ReceiverSettings) -> AE:
    entity = AE(ae_title=settings.ae_title)
    entity.require_called_aet = True
    entity.require_calling_aet = list(settings.allowed)
    entity.maximum_associations = MAX_CONNECTIONS
    entity.acse_timeout = entity.dimse_timeout = entity.network_timeout = TIMEOUT_S
    for sop_class in sorted(CT_CLASSES):
        entity.add_supported_context(sop_class, list(SYNTAXES))
    entity.add_supported_context(Verification)
    return entity


def _tls_context(settings: ReceiverSettings) -> ssl.SSLContext | None:
    if settings.certificate is None or settings.key is None:
        return None
    context = _Context(ssl.PROTOCOL_TLS_SERVER)
    context.load_cert_chain(settings.certificate, settings.key)
    if settings.client_ca is not None:
        context.verify_mode = ssl.CERT_REQUIRED
        context.load_verify_locations(settings.client_ca)
    return context
