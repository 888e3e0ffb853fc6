"""TLS: whether it is spoken here, and with which certificate."""

from server.security.tls.choose import Tls, chosen_tls, reject_unsafe

__all__ = ["Tls", "chosen_tls", "reject_unsafe"]
