"""Tokens: what opens the door. A server keeps their sums alone, so that its disk opens nothing.

A token is a name, a dot, and 256 bits of chance. The name finds what the token belongs to; only the rest is
secret. A plain SHA-256 is enough for it: nobody tries 2^256 words.
"""

import hashlib
import hmac
import re
import secrets
from dataclasses import dataclass

SECRET_BYTES = 32
SHAPE = re.compile(r"([0-9a-f]{12})\.([A-Za-z0-9_-]{43})")


@dataclass(frozen=True, slots=True, kw_only=True)
class Token:
    """One token, in its two parts.

    Attributes:
        id: of what it belongs to; no secret.
        secret: what nobody else has.
    """

    id: str
    secret: str

    @classmethod
    def new(cls) -> "Token":
        """One that was never there before."""
        return cls(id=new_id(), secret=secrets.token_urlsafe(SECRET_BYTES))

    @classmethod
    def read(cls, text: str) -> "Token | None":
        """What somebody shows; None where it has not the shape of a token."""
        found = SHAPE.fullmatch(text)
        return None if found is None else cls(id=found[1], secret=found[2])

    @property
    def text(self) -> str:
        """As it is written into links and cookies."""
        return f"{self.id}.{self.secret}"

    @property
    def sum(self) -> str:
        """What is kept of it: SHA-256 in hexadecimal."""
        return hashlib.sha256(self.text.encode()).hexdigest()

    def opens(self, kept_sum: str) -> bool:
        """Whether this is the token that was kept; takes as long whatever is wrong with it."""
        return hmac.compare_digest(self.sum, kept_sum)

    def __repr__(self) -> str:
        """Without the secret: it must get into no log."""
        return f"Token({self.id})"


def new_id() -> str:
    """A name for a token, an invitation, a person."""
    return secrets.token_hex(6)
