"""Lease on the name of a theatre: two theatres with one name would overwrite each other's figures.

The owner renews it in the NATS server's key-value store, where a name that is not renewed expires after
`LEASE_S`. Each write states the revision that it replaces, so that of two theatres only one succeeds. The
owner counts from before its request: it stops publishing before the name can be taken.
"""

import json
import socket
from collections.abc import Callable

from nats.js.errors import KeyNotFoundError, KeyWrongLastSequenceError
from nats.js.kv import KeyValue

from server.clock import elapsed_s, utc_now, utc_text
from server.hub.connection import LEASE_S, HubError

RENEW_AFTER_S = LEASE_S / 4.0


class Claim:
    """The lease of one run, over all its connections.

    Args:
        theatre: The name.
        run: This run.
        clock: Monotonic clock that includes sleep.
    """

    def __init__(self, theatre: str, *, run: str, clock: Callable[[], float] = elapsed_s) -> None:
        self.run = run
        self._theatre = theatre
        self._clock = clock
        self._content = json.dumps(
            {"run": run, "host": socket.gethostname(), "since": utc_text(utc_now(), timespec="seconds")}
        ).encode()
        self._revision = 0
        self._valid_until_s = 0.0

    @property
    def is_held(self) -> bool:
        """Whether the name is still this run's, whatever happened to the connection."""
        return self._clock() < self._valid_until_s

    async def renew(self, bucket: KeyValue) -> None:
        """Take or renew the name in the bucket of all names.

        Raises:
            HubError: HUB_NAME_TAKEN.
            nats.errors.Error: the server does not answer.
        """
        requested_s = self._clock()
        try:
            try:
                self._revision = await self._write(bucket)
            except KeyWrongLastSequenceError:
                # It expired, or another has it, or an earlier request succeeded whose answer was lost.
                self._valid_until_s = 0.0
                entry = await _entry_in(bucket, self._theatre)
                self._revision = entry.revision or 0 if entry and _owner(entry).get("run") == self.run else 0
                self._revision = await self._write(bucket)
        except KeyWrongLastSequenceError:
            self._revision = 0
            raise self._taken(await _entry_in(bucket, self._theatre)) from None
        self._valid_until_s = requested_s + LEASE_S

    async def release(self, bucket: KeyValue) -> None:
        """Give the name up, so that a restart need not wait."""
        if self._revision and self.is_held:
            self._valid_until_s = 0.0
            await bucket.delete(self._theatre, last=self._revision)

    async def _write(self, bucket: KeyValue) -> int:
        if self._revision == 0:
            return await bucket.create(self._theatre, self._content)
        return await bucket.update(self._theatre, self._content, last=self._revision)

    def _taken(self, entry: KeyValue.Entry | None) -> HubError:
        owner = {} if entry is None else _owner(entry)
        host, since = str(owner.get("host", "?"))[:80], str(owner.get("since", "?"))[:40]
        return HubError(
            "HUB_NAME_TAKEN",
            f"a theatre {self._theatre} publishes already, from {host} since {since}: two theatres with one "
            "name would be mixed up",
            "Give this theatre another name in hub.theatre. After a crash of this server its own name is "
            f"free again within {LEASE_S:g} s.",
            {"theatre": self._theatre, "host": host, "since": since, "lease_s": LEASE_S},
        )


async def _entry_in(bucket: KeyValue, theatre: str) -> KeyValue.Entry | None:
    try:
        return await bucket.get(theatre)
    except KeyNotFoundError:
        return None


def _owner(entry: KeyValue.Entry) -> dict[str, object]:
    try:
        owner = json.loads(entry.value or b"")
    except ValueError:
        return {}
    return owner if isinstance(owner, dict) else {}
