"""Connection to the NATS server of a hospital, and the errors of it."""

import asyncio
import ssl
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager, suppress
from dataclasses import dataclass
from pathlib import Path

from nats.aio.client import Client
from nats.errors import Error as NatsError
from nats.js import JetStreamContext
from nats.js.api import KeyValueConfig, RetentionPolicy, StorageType, StreamConfig
from nats.js.errors import BucketNotFoundError, NotFoundError
from nats.js.kv import KeyValue

from server.config import HubConfig
from server.hub.subjects import STORED, Hospital
from tracker.errors import NavigationError

CONNECT_TIMEOUT_S = 3.0
REQUEST_TIMEOUT_S = 2.0
PING_S = 2
# Time after which another theatre may take a name whose owner is silent.
LEASE_S = 10.0
RETENTION_S = 30 * 24 * 3600.0
# Whatever goes wrong between here and the server.
LOST = (NatsError, OSError, TimeoutError, ssl.SSLError)


class HubError(NavigationError):
    """The hub cannot be used now; the theatre works without it."""


@dataclass(frozen=True, slots=True, kw_only=True)
class HubAddress:
    """How to reach and use the NATS server; also sent to processes.

    Attributes:
        url: `tls://host:port`, or `nats://`.
        hospital: Names on it.
        user: User and password; None without.
        ca: Authority of its certificate; None for those of this system.
        certificate: PEM files of the own certificate and its key; None without.
    """

    url: str
    hospital: Hospital
    user: tuple[str, str] | None = None
    ca: Path | None = None
    certificate: tuple[Path, Path] | None = None

    @classmethod
    def of(cls, config: HubConfig) -> "HubAddress":
        """Return the address of the settings.

        Raises:
            HubError: HUB_NOT_SET, HUB_CREDENTIALS_UNUSABLE.
        """
        if config.url is None:
            raise HubError(
                "HUB_NOT_SET",
                "the settings name no NATS server",
                "Set hub.url to the address of the hospital's NATS server, as tls://host:4222.",
            )
        tls = config.tls
        return cls(
            url=config.url,
            hospital=Hospital(config.hospital),
            user=None if config.credentials is None else _user_from(config.credentials),
            ca=tls.ca,
            certificate=None if tls.certificate is None or tls.key is None else (tls.certificate, tls.key),
        )

    @asynccontextmanager
    async def connected(self, name: str) -> AsyncIterator["Link"]:
        """Connect once: a lost connection ends the work on it, and whoever wants another one connects again.

        Nothing is sent later than it was handed over, because nothing outlives its connection.

        Args:
            name: Of the client, in the server's log and in the names of its inboxes.

        Raises:
            HubError: HUB_UNREACHABLE, also where the work on it fails by the connection.
        """
        closed = asyncio.Event()

        async def on_closed() -> None:
            closed.set()

        failures: list[Exception] = []
        client = Client()

        async def note(error: Exception) -> None:
            # Later errors reach the calls that wait for the connection.
            if not client.is_connected:
                failures.append(error)

        user, password = self.user or (None, None)
        try:
            async with asyncio.timeout(CONNECT_TIMEOUT_S):
                await client.connect(
                    self.url,
                    name=name,
                    user=user,
                    password=password,
                    tls=self._tls(),
                    allow_reconnect=False,
                    # It tries twice at once; who wants more tries again later, and knows why it failed.
                    max_reconnect_attempts=1,
                    reconnect_time_wait=0,
                    connect_timeout=int(CONNECT_TIMEOUT_S),
                    ping_interval=PING_S,
                    max_outstanding_pings=2,
                    inbox_prefix=f"_INBOX_{name}",
                    closed_cb=on_closed,
                    error_cb=note,
                )
        except LOST as error:
            raise unreachable(self.url, [*failures, error][0]) from error
        try:
            yield Link(client=client, closed=closed, address=self)
        except LOST as error:
            # A subject that is not permitted looks like a server that does not answer.
            raise unreachable(self.url, client.last_error or error) from error
        finally:
            with suppress(*LOST):
                await client.close()

    def _tls(self) -> ssl.SSLContext | None:
        if not self.url.startswith("tls://"):
            return None
        context = ssl.create_default_context(cafile=None if self.ca is None else str(self.ca))
        if self.certificate is not None:
            context.load_cert_chain(*map(str, self.certificate))
        return context


@dataclass(frozen=True, slots=True, kw_only=True)
class Link:
    """A connection.

    Attributes:
        client: Its client.
        closed: Set when it has ended.
        address: Where it leads.
    """

    client: Client
    closed: asyncio.Event
    address: HubAddress

    def jetstream(self) -> JetStreamContext:
        """Return its JetStream."""
        return self.client.jetstream(timeout=REQUEST_TIMEOUT_S)

    async def ensure_stream(self) -> None:
        """Create the stream of what is stored, unless somebody has created it with other settings."""
        hospital, jetstream = self.address.hospital, self.jetstream()
        try:
            await jetstream.stream_info(hospital.stream)
        except NotFoundError:
            await jetstream.add_stream(
                StreamConfig(
                    name=hospital.stream,
                    subjects=[hospital.subject("*", leaf) for leaf in STORED],
                    retention=RetentionPolicy.LIMITS,
                    storage=StorageType.FILE,
                    max_age=RETENTION_S,
                    # A second safeguard beside the expected sequence (`publisher.py`).
                    duplicate_window=120.0,
                )
            )

    async def claims(self) -> KeyValue:
        """Return the bucket of the theatres' names, in which a silent theatre's name expires."""
        jetstream, bucket = self.jetstream(), self.address.hospital.claims
        try:
            return await jetstream.key_value(bucket)
        except BucketNotFoundError:
            return await jetstream.create_key_value(KeyValueConfig(bucket=bucket, history=1, ttl=LEASE_S))

    async def until_lost(self) -> None:
        """Wait for the end of the connection.

        Raises:
            HubError: HUB_UNREACHABLE, always.
        """
        await self.closed.wait()
        raise unreachable(self.address.url, self.client.last_error or ConnectionResetError("it was closed"))


def unreachable(url: str, error: Exception) -> HubError:
    """Return the error of a NATS server that does not answer as it should."""
    reason = str(error) or type(error).__name__
    return HubError(
        "HUB_UNREACHABLE",
        f"the hub's NATS server {url} cannot be used: {reason}",
        "The theatre works without it, and catches up. Check the network, the NATS server, and hub.url, "
        "hub.credentials and hub.tls in the settings.",
        {"url": url, "library_error": reason},
    )


def _user_from(file: Path) -> tuple[str, str]:
    try:
        line = file.read_text(encoding="utf-8").strip()
    except (OSError, UnicodeDecodeError):
        line = ""
    user, separator, password = line.partition(":")
    if not (user and separator and password) or "\n" in line:
        raise HubError(
            "HUB_CREDENTIALS_UNUSABLE",
            f"{file} has not exactly one line of the form user:password",
            "Write the user of this theatre on the NATS server and its password into this file, "
            "readable by the server's user only.",
            {"file": str(file)},
        )
    return user, password
