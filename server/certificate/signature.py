"""Signature of certificates: Ed25519 over canonical JSON.

Canonical JSON has sorted keys, no white space, characters of UTF-8 unescaped, and numbers in Python's
shortest form that reads back exactly. A certificate file is itself canonical, so that each byte of it is
fixed by what is signed: a changed byte gives another content, another signature, or a file that is not
canonical.
"""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from cryptography.exceptions import InvalidSignature
from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PrivateKey, Ed25519PublicKey

from server.store import translate_errors
from server.store.private_file import PrivateJsonFile
from tracker.errors import InvalidInput

FORM = 1
KEY_FILE = "certificate-key.json"
ALGORITHM = "Ed25519"
# A signature of this key over anything else cannot be taken for a certificate.
CONTENT_PREFIX = b"coaxial accuracy certificate\n"
PDF_PREFIX = b"coaxial accuracy certificate as PDF\n"
# A PDF ends with a comment of this length: its signature.
PDF_COMMENT = b"%%coaxial-signature %s %s\n"
PDF_COMMENT_BYTES = len(PDF_COMMENT % (b"0" * 64, b"0" * 128))
MAX_BYTES = 5_000_000
REMEDY = "Give a certificate as it was issued, as JSON or PDF."


class SigningKey:
    """The key of this installation, created at its first use, in a file that only its owner can read.

    Args:
        home: the home folder; created if missing.

    Raises:
        StoreError: the folder cannot be used.
        InvalidInput: CERTIFICATE_KEY_DAMAGED.
    """

    def __init__(self, home: Path) -> None:
        file = PrivateJsonFile(home / KEY_FILE, form=FORM)
        with translate_errors(home):
            home.mkdir(mode=0o700, parents=True, exist_ok=True)
            try:
                stored = file.read()
                if stored is None:
                    file.write({"private_key": Ed25519PrivateKey.generate().private_bytes_raw().hex()})
                    # Read again: of two first uses at the same time, the later key stays.
                    stored = file.read() or {}
                self._key = Ed25519PrivateKey.from_private_bytes(bytes.fromhex(str(stored["private_key"])))
            except (ValueError, KeyError) as error:
                raise InvalidInput(
                    "CERTIFICATE_KEY_DAMAGED",
                    f"the key in {file.path} cannot be read",
                    "Restore this file from a backup, or remove it: then a new key signs, and older "
                    "certificates are of another signer.",
                    {"file": str(file.path)},
                ) from error

    @property
    def signer(self) -> str:
        """Return the public key in hexadecimal, by which others know certificates of this installation."""
        return self._key.public_key().public_bytes_raw().hex()

    def signed_json(self, content: Mapping[str, Any]) -> bytes:
        """Return the certificate file of a content."""
        value = self._key.sign(CONTENT_PREFIX + canonical_json(content)).hex()
        signature = {"algorithm": ALGORITHM, "public_key": self.signer, "value": value}
        return canonical_json({"certificate": content, "signature": signature}) + b"\n"

    def signed_pdf(self, pdf: bytes) -> bytes:
        """Return a PDF with its signature in a comment at its end."""
        value = self._key.sign(PDF_PREFIX + pdf).hex()
        return pdf + PDF_COMMENT % (self.signer.encode(), value.encode())


def existing_signer(home: Path) -> str | None:
    """Return the public key of this installation; None if it has none, or an unusable one."""
    try:
        stored = PrivateJsonFile(home / KEY_FILE, form=FORM).read()
        if stored is None:
            return None
        key = Ed25519PrivateKey.from_private_bytes(bytes.fromhex(str(stored["private_key"])))
        return key.public_key().public_bytes_raw().hex()
    except (OSError, ValueError, KeyError):
        return None


def canonical_json(value: Any) -> bytes:  # noqa: ANN401  JSON may be anything
    """Return the canonical JSON of a value; see the module."""
    text = json.dumps(value, sort_keys=True, separators=(",", ":"), ensure_ascii=False, allow_nan=False)
    return text.encode()


def verified_json(file: bytes) -> tuple[dict[str, Any], str]:
    """Return the content and the signer of a certificate file with a valid signature.

    Raises:
        InvalidInput: CERTIFICATE_UNREADABLE or CERTIFICATE_ALTERED.
    """
    try:
        value = json.loads(file)
        content, signature = value["certificate"], value["signature"]
        signer, signed = str(signature["public_key"]), str(signature["value"])
        is_canonical = (
            canonical_json(value) + b"\n" == file
            and set(value) == {"certificate", "signature"}
            and set(signature) == {"algorithm", "public_key", "value"}
            and signature["algorithm"] == ALGORITHM
            and isinstance(content, dict)
        )
        message = CONTENT_PREFIX + canonical_json(content)
    except (ValueError, KeyError, TypeError, RecursionError):
        raise InvalidInput("CERTIFICATE_UNREADABLE", "the file is not a certificate", REMEDY) from None
    if not (is_canonical and _is_signed(signer, signed, message)):
        raise _altered()
    return content, signer


def verified_pdf(file: bytes) -> tuple[dict[str, Any], str]:
    """Return the content and the signer of a PDF with a valid signature; the attached JSON is verified, too.

    Raises:
        InvalidInput: CERTIFICATE_UNREADABLE or CERTIFICATE_ALTERED.
    """
    pdf, comment = file[:-PDF_COMMENT_BYTES], file[-PDF_COMMENT_BYTES:]
    words = comment.decode("latin-1").split(" ")
    attached = _attached(pdf)
    if len(words) != 3 or not attached:
        raise InvalidInput("CERTIFICATE_UNREADABLE", "the PDF is not a certificate", REMEDY)
    signer, signed = words[1], words[2].removesuffix("\n")
    if comment != PDF_COMMENT % (signer.encode("latin-1"), signed.encode("latin-1")) or not _is_signed(
        signer, signed, PDF_PREFIX + pdf
    ):
        raise _altered()
    content, author = verified_json(attached)
    if author != signer:
        raise _altered()
    return content, signer


def json_of(file: bytes) -> bytes:
    """Return the certificate as JSON, from a verified JSON or PDF.

    Raises:
        InvalidInput: CERTIFICATE_UNREADABLE or CERTIFICATE_ALTERED.
    """
    if not file.startswith(b"%PDF"):
        verified_json(file)
        return file
    verified_pdf(file)
    return _attached(file)


def _attached(pdf: bytes) -> bytes:
    """Return the attached JSON; empty without one."""
    at = pdf.find(b"/Type /EmbeddedFile /Length ")
    first = pdf.find(b"stream\n", at) + len(b"stream\n")
    return pdf[first : pdf.find(b"\nendstream", first)] if at >= 0 else b""


def _is_signed(signer: str, signed: str, message: bytes) -> bool:
    try:
        key, value = bytes.fromhex(signer), bytes.fromhex(signed)
        # Other spellings of the same bytes are other files.
        if key.hex() != signer or value.hex() != signed:
            return False
        Ed25519PublicKey.from_public_bytes(key).verify(value, message)
    except (ValueError, InvalidSignature):
        return False
    return True


def _altered() -> InvalidInput:
    return InvalidInput(
        "CERTIFICATE_ALTERED",
        "the certificate was altered after it was signed",
        "Get the certificate again from whoever issued it; do not use this one.",
    )
