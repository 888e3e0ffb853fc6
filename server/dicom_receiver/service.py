"""Starts the receiver's process, and starts it again when it ends."""

import multiprocessing
import shutil
import socket
import threading
from dataclasses import dataclass
from multiprocessing.process import BaseProcess
from pathlib import Path

import structlog

from server.config import DicomConfig
from server.dicom_receiver.process import run_receiver
from server.imaging.dicom_network.inbox import Inbox, InboxLimits
from server.imaging.dicom_network.receiver_settings import ReceiverSettings
from server.logs import LogSettings
from server.loop.forks import end_process, exit_text
from tracker.errors import Remark

# Folder of the series that wait, in the data folder.
RECEIVED = "received"
POLL_S = 0.1
RESTART_AFTER_S = 1.0
STOP_TIMEOUT_S = 2.0
log = structlog.get_logger(__name__)


def delete_received(home: Path) -> None:
    """Delete the series that wait; where nothing is received any more, nobody would."""
    shutil.rmtree(home / RECEIVED, ignore_errors=True)


@dataclass(frozen=True, slots=True, kw_only=True)
class ReceiverStatus:
    """State of the receiver.

    Attributes:
        ae_title: own AE title.
        host: address that it listens on.
        port: its port.
        remark: the last refusal, or why it does not run; None if there was none.
    """

    ae_title: str
    host: str
    port: int
    remark: Remark | None


class DicomReceiver:
    """The receiver's process, in a thread of the web process.

    The socket stays open while the process is restarted, so that senders wait.

    Attributes:
        inbox: the series that wait.

    Args:
        listener: the listening socket.
        settings: names and TLS.
        folder: where series wait.
        limits: of the series that wait.
        log_settings: log settings of the process.
        restart_after_s: pause before an ended process is started again.
    """

    def __init__(
        self,
        listener: socket.socket,
        settings: ReceiverSettings,
        *,
        folder: Path,
        limits: InboxLimits,
        log_settings: LogSettings,
        restart_after_s: float = RESTART_AFTER_S,
    ) -> None:
        self._listener = listener
        self._settings = settings
        self._folder, self._limits = folder, limits
        self.inbox = Inbox(folder, limits)
        self._log_settings = log_settings
        self._restart_after_s = restart_after_s
        self._stop = threading.Event()
        self._remark: Remark | None = None
        self._process: BaseProcess | None = None
        self._thread = threading.Thread(target=self._run, name="dicom receiver", daemon=True)

    @classmethod
    def of(
        cls,
        config: DicomConfig,
        listener: socket.socket,
        *,
        home: Path,
        certificate: tuple[Path, Path] | None,
        log_settings: LogSettings,
    ) -> "DicomReceiver":
        """Return the receiver of the settings.

        Args:
            config: the settings.
            listener: the listening socket.
            home: the data folder.
            certificate: PEM files of the own certificate and its key; None without TLS.
            log_settings: log settings of the process.
        """
        own, key = certificate or (None, None)
        receive = config.receive
        return cls(
            listener,
            ReceiverSettings(
                ae_title=config.ae_title,
                allowed=tuple(receive.allowed_ae_titles),
                certificate=own,
                key=key,
                client_ca=receive.client_ca,
            ),
            folder=home / RECEIVED,
            limits=InboxLimits(
                max_bytes=int(receive.max_gb * 1e9),
                max_series=receive.max_series,
                max_age_s=receive.max_age_h * 3600.0,
            ),
            log_settings=log_settings,
        )

    def start(self) -> None:
        """Start; returns at once."""
        self._thread.start()

    def stop(self) -> None:
        """Stop the process, and close the socket."""
        self._stop.set()
        if self._thread.ident is not None:
            self._thread.join()
        self._listener.close()

    @property
    def status(self) -> ReceiverStatus:
        """State of the receiver. From any thread."""
        host, port = self._listener.getsockname()[:2]
        return ReceiverStatus(ae_title=self._settings.ae_title, host=host, port=port, remark=self._remark)

    @property
    def pid(self) -> int | None:
        """Id of its process, for tests."""
        return None if self._process is None else self._process.pid

    def _run(self) -> None:
        context = multiprocessing.get_context("forkserver")
        while not self._stop.is_set():
            ours, theirs = context.Pipe()
            self._process = context.Process(
                target=run_receiver,
                args=(self._listener, self._settings, self._folder, self._limits, theirs, self._log_settings),
                name="dicom receiver",
                daemon=True,
            )
            try:
                self._process.start()
                theirs.close()
                while not self._stop.is_set():
                    if ours.poll(POLL_S):
                        self._remark = ours.recv()
                        log.warning("dicom_refused", code=self._remark.code)
            except (EOFError, OSError):
                self._process.join(STOP_TIMEOUT_S)
                exit_reason = exit_text(self._process.exitcode)
                log.warning("dicom_receiver_ended", how=exit_reason)
                self._remark = Remark(
                    code="RECEIVER_ENDED",
                    message=f"the receiver of DICOM ended {exit_reason} and is started again",
                    remedy="Send the series again that was being sent.",
                    context={"exit_reason": exit_reason},
                )
            finally:
                theirs.close()
                ours.close()
                if self._process.pid is not None:
                    end_process(self._process, timeout_s=STOP_TIMEOUT_S)
            self._stop.wait(self._restart_after_s)
