"""A certificate is verified elsewhere, and each changed byte of it is found."""

import json
import stat
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import pytest

from server.certificate.signature import (
    KEY_FILE,
    SigningKey,
    canonical_json,
    existing_signer,
    verified_json,
    verified_pdf,
)
from server.printing import Attachment, Label, Sheet, pdf_from_sheets
from tracker.errors import InvalidInput

CONTENT: Mapping[str, Any] = {"error_95_mm": 0.49, "issued_by": "Jörg", "placements": 2, "audit": None}
SHEET = Sheet(title="one", size_mm=(210.0, 297.0), marks=(Label(text="0.49 mm", at_mm=(20.0, 20.0)),))


def pdf_of(key: SigningKey) -> bytes:
    attachment = Attachment(name="certificate.json", content=key.signed_json(CONTENT))
    return key.signed_pdf(pdf_from_sheets([SHEET, SHEET], attachment=attachment))


def test_the_key_is_made_once_and_only_its_owner_reads_it(tmp_path: Path) -> None:
    assert existing_signer(tmp_path) is None
    key = SigningKey(tmp_path / "home")
    assert SigningKey(tmp_path / "home").signer == key.signer == existing_signer(tmp_path / "home")
    assert stat.S_IMODE((tmp_path / "home" / KEY_FILE).stat().st_mode) == 0o600
    assert SigningKey(tmp_path / "other").signer != key.signer


def test_a_damaged_key_is_an_error_and_not_replaced(tmp_path: Path) -> None:
    SigningKey(tmp_path)
    (tmp_path / KEY_FILE).write_text('{"form": 1, "private_key": "00"}')
    with pytest.raises(InvalidInput, match="cannot be read"):
        SigningKey(tmp_path)
    assert existing_signer(tmp_path) is None


def test_content_and_signer_are_read_back(tmp_path: Path) -> None:
    key = SigningKey(tmp_path)
    assert verified_json(key.signed_json(CONTENT)) == (CONTENT, key.signer)
    assert verified_pdf(pdf_of(key)) == (CONTENT, key.signer)


def test_each_changed_byte_of_the_json_is_found(tmp_path: Path) -> None:
    file = SigningKey(tmp_path).signed_json(CONTENT)
    for at in range(len(file)):
        for bit in (1, 32):
            altered = bytes([*file[:at], file[at] ^ bit, *file[at + 1 :]])
            with pytest.raises(InvalidInput):
                verified_json(altered)


def test_each_changed_byte_of_the_pdf_is_found(tmp_path: Path) -> None:
    file = pdf_of(SigningKey(tmp_path))
    for at in range(len(file)):
        altered = bytes([*file[:at], file[at] ^ 1, *file[at + 1 :]])
        with pytest.raises(InvalidInput):
            verified_pdf(altered)


@pytest.mark.parametrize(
    "changed",
    [
        pytest.param(lambda file: file.rstrip(b"\n"), id="without its line end"),
        pytest.param(lambda file: file + b"\n", id="with another line"),
        pytest.param(lambda file: file.replace(b'"placements":2', b'"placements":2.0'), id="2 is 2.0"),
        pytest.param(lambda file: file.replace(b'{"c', b'{"c":1,"c', 1), id="a second member"),
        pytest.param(lambda file: json.dumps(json.loads(file)).encode() + b"\n", id="with white space"),
        pytest.param(
            lambda file: file.replace(
                json.loads(file)["signature"]["value"].encode(),
                json.loads(file)["signature"]["value"].upper().encode(),
            ),
            id="the signature in capitals",
        ),
        pytest.param(lambda _: b"[" * 100_000, id="nested deeply"),
        pytest.param(lambda _: b"", id="empty"),
    ],
)
def test_another_file_of_the_same_values_is_not_the_certificate(
    tmp_path: Path, changed: Callable[[bytes], bytes]
) -> None:
    with pytest.raises(InvalidInput):
        verified_json(changed(SigningKey(tmp_path).signed_json(CONTENT)))


def test_a_certificate_that_is_signed_again_has_another_signer(tmp_path: Path) -> None:
    forged = SigningKey(tmp_path / "forger").signed_json({**CONTENT, "error_95_mm": 0.1})
    _, signer = verified_json(forged)
    assert signer != SigningKey(tmp_path / "issuer").signer


def test_a_pdf_with_the_certificate_of_somebody_else_is_rejected(tmp_path: Path) -> None:
    """Its pages could show other numbers than the file inside."""
    theirs = SigningKey(tmp_path / "issuer").signed_json(CONTENT)
    attachment = Attachment(name="certificate.json", content=theirs)
    forged = SigningKey(tmp_path / "forger").signed_pdf(pdf_from_sheets([SHEET], attachment=attachment))
    with pytest.raises(InvalidInput) as raised:
        verified_pdf(forged)
    assert raised.value.code == "CERTIFICATE_ALTERED"


def test_canonical_json_is_fixed() -> None:
    assert canonical_json({"b": [1, 0.1, 1e-7], "ä": None}) == '{"b":[1,0.1,1e-07],"ä":null}'.encode()
