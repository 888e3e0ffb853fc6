"""Names and TLS of the receiver; a module of its own, because the receiver's packages are slow to import."""

from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True, slots=True, kw_only=True)
class ReceiverSettings:
    """Names and TLS of the receiver.

    Attributes:
        ae_title: own AE title.
        allowed: AE titles that may send.
        certificate: PEM file of the own certificate; None without TLS.
        key: PEM file of its key.
        client_ca: PEM file of the authority of the senders' certificates; None if they need none.
    """

    ae_title: str
    allowed: tuple[str, ...]
    certificate: Path | None = None
    key: Path | None = None
    client_ca: Path | None = None
