"""Access tokens. The server stores only their SHA-256, so its disk grants no access.

A token is an id, a dot, and 256 random bits. The id finds its record; only the rest is secret. A plain
SHA-256 is enough: nobody tries 2^256 values.
"""

import hashlib
import hmac
import re
import secrets
from dataclasses import dataclass

SECRET_BYTES = 32
TOKEN_PATTERN = re.compile(r"([0-9a-f]{12})\.([A-Za-z0-9_-]{43})")


@dataclass(frozen=True, slots=True, kw_only=True)
class Token:
    """One token, in its two parts.

    Attributes:
        id: id of its record; not secret.
        secret: the secret part.
    """

    id: str
    secret: str

    @classmethod
    def new(cls) -> "Token":
        """Return a new random token."""
        return cls(id=new_id(), secret=secrets.token_urlsafe(SECRET_BYTES))

    @classmethod
    def read(cls, text: str) -> "Token | None":
        """Parse a token; None for another format."""
        found = TOKEN_PATTERN.fullmatch(text)
        return None if found is None else cls(id=found[1], secret=found[2])

    @property
    def text(self) -> str:
        """As in links and cookies."""
        return f"{self.id}.{self.secret}"

    @property
    def sum(self) -> str:
        """SHA-256 in hexadecimal, as stored."""
        return hashlib.sha256(self.text.encode()).hexdigest()

    def matches(self, stored_sum: str) -> bool:
        """Return whether its sum equals the stored one, in constant time."""
        return hmac.compare_digest(self.sum, stored_sum)

    def __repr__(self) -> str:
        """Without the secret, which must not be logged."""
        return f"Token({self.id})"


def new_id() -> str:
    """Return a random id for a token, an invitation or a person."""
    return secrets.token_hex(6)
