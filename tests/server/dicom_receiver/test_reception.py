"""A CT that is sent waits whole; what is not allowed, broken or no CT is answered and reported."""

import logging
import os
import shutil
import socket
import ssl
import struct
import tempfile
from datetime import UTC, datetime, timedelta
from pathlib import Path

import numpy as np
import pytest
from cryptography import x509
from cryptography.hazmat.primitives import hashes, serialization
from cryptography.hazmat.primitives.asymmetric import ec
from cryptography.x509.oid import NameOID
from pydicom.dataset import Dataset
from pydicom.uid import EnhancedCTImageStorage

from server.imaging.ct_reader import read_ct
from server.imaging.dicom_network.inbox import Inbox, InboxLimits, ReceivedUnknown
from server.imaging.dicom_network.receiver_settings import ReceiverSettings
from server.security.tls.self_signed import load_or_create
from tests.dicom_tools import closed_sockets, orthanc_in  # noqa: F401  a fixture
from tests.server.dicom_receiver.sending import LIMITS, SETTINGS, Door, associated, door, sent, until
from tests.server.imaging.made_ct import NAME, enhanced_of, file_of, made_ct
from tests.server.imaging.made_study import made_study
from tracker.errors import InvalidInput

SUCCESS, FULL, NO_MATCH, NOT_UNDERSTOOD = 0x0000, 0xA700, 0xA900, 0xC000


def complete(opened: Door, slices: list[Dataset]) -> None:
    association = associated(opened.port)
    assert sent(association, slices) == [SUCCESS] * len(slices)
    association.release()


def test_a_series_waits_and_is_read_to_the_voxel(tmp_path: Path) -> None:
    made = made_ct()
    with door(tmp_path / "inbox") as opened:
        complete(opened, made.slices)
        one = opened.described()
        assert one.description is not None
        assert (one.files, one.description.images, one.description.modality) == (5, 5, "CT")
        assert one.description.words == "Spine 2.0 bone"
        opened.inbox.link_into(one.id, tmp_path / "taken")
        assert np.array_equal(read_ct(tmp_path / "taken").volume.hu, made.hu)
        opened.inbox.discard(one.id)
        assert opened.waiting() == ()
        assert opened.codes == []
    assert np.array_equal(read_ct(tmp_path / "taken").volume.hu, made.hu)


LEGACY_CONVERTED = "1.2.840.10008.5.1.4.1.1.2.2"


@pytest.mark.parametrize("sop_class", [EnhancedCTImageStorage, LEGACY_CONVERTED])
def test_a_multi_frame_ct_waits_and_is_read_to_the_voxel(tmp_path: Path, sop_class: str) -> None:
    made = made_ct()
    whole = enhanced_of(made)
    whole.SOPClassUID = sop_class
    with door(tmp_path / "inbox") as opened:
        association = associated(opened.port, classes=[sop_class])
        assert sent(association, [whole]) == [SUCCESS]
        association.release()
        one = opened.described()
        assert one.description is not None
        assert (one.files, one.description.images, one.description.modality) == (1, 5, "CT")
        opened.inbox.link_into(one.id, tmp_path / "taken")
        assert opened.codes == []
    assert np.array_equal(read_ct(tmp_path / "taken").volume.hu, made.hu)


def test_a_multi_frame_ct_without_positions_waits_with_its_reason(tmp_path: Path) -> None:
    whole = enhanced_of(made_ct())
    del whole.PerFrameFunctionalGroupsSequence
    with door(tmp_path) as opened:
        association = associated(opened.port, classes=[EnhancedCTImageStorage])
        assert sent(association, [whole]) == [SUCCESS]
        association.release()
        problem = opened.described().problem
    assert problem is not None
    assert "multi-frame files without positions of their images" in problem.message


def test_it_answers_an_echo(tmp_path: Path) -> None:
    with door(tmp_path) as opened:
        association = associated(opened.port)
        assert association.send_c_echo().Status == SUCCESS
        association.release()


def test_temporary_files_are_in_the_inbox_only_while_it_receives(tmp_path: Path) -> None:
    before = tempfile.gettempdir()
    with door(tmp_path):
        assert Path(tempfile.gettempdir()).is_relative_to(tmp_path)
    assert tempfile.gettempdir() == before


@pytest.mark.parametrize(("title", "called"), [("STRANGER", "COAXIAL"), ("SCANNER", "OTHER")])
def test_a_title_that_is_not_allowed_is_refused(tmp_path: Path, title: str, called: str) -> None:
    with door(tmp_path) as opened:
        association = associated(opened.port, title=title, called=called)
        assert association.is_rejected
        until(lambda: opened.codes == ["RECEIVE_SENDER_REFUSED"])
        assert title in opened.remarks[0].message


def test_what_is_no_ct_is_not_accepted(tmp_path: Path) -> None:
    mr, seg = "1.2.840.10008.5.1.4.1.1.4", "1.2.840.10008.5.1.4.1.1.66.4"
    with door(tmp_path) as opened:
        rejected = associated(opened.port, classes=(mr, seg))
        assert not rejected.is_established
        # And an object that says CT in the request only.
        association = associated(opened.port)
        other = made_ct().slices[0]
        wrong = made_ct().slices[0]
        wrong.SeriesInstanceUID = ""
        assert sent(association, [wrong, other]) == [NO_MATCH, SUCCESS]
        association.release()
        assert opened.codes == ["RECEIVE_DAMAGED"]


def test_a_broken_connection_leaves_the_series_incomplete_until_it_is_sent_again(tmp_path: Path) -> None:
    made = made_ct()
    with door(tmp_path / "inbox") as opened:
        association = associated(opened.port)
        sent(association, made.slices[:3])
        association.abort()
        until(lambda: opened.codes == ["RECEIVE_INTERRUPTED"])
        opened.now_s += 100.0
        opened.receiver.describe_quiet_series()
        (one,) = opened.waiting()
        assert (one.files, one.description) == (3, None)
        with pytest.raises(InvalidInput, match="3 slices have arrived"):
            opened.inbox.link_into(one.id, tmp_path / "taken")
        complete(opened, made.slices)
        one = opened.described()
        assert one.description is not None
        assert one.files == one.description.images == 5


def test_a_series_is_described_and_kept_while_the_clock_is_set(tmp_path: Path) -> None:
    with door(tmp_path) as opened:
        complete(opened, made_ct().slices)
        opened.receiver.describe_quiet_series()
        opened.now_s, opened.clock_set_by_s = opened.now_s - 3600.0, -3600.0
        assert opened.described().description is not None


def test_one_connection_a_slice_is_one_series(tmp_path: Path) -> None:
    with door(tmp_path) as opened:
        for one in made_ct().slices:
            complete(opened, [one])
        assert opened.described().files == 5


def test_a_slice_again_is_accepted_and_another_of_its_identifier_is_not(tmp_path: Path) -> None:
    made = made_ct()
    with door(tmp_path) as opened:
        complete(opened, made.slices)
        complete(opened, made.slices)
        assert opened.described().files == 5
        made.slices[0].PixelData = bytes(len(made.slices[0].PixelData))
        association = associated(opened.port)
        assert sent(association, made.slices[:1]) == [NOT_UNDERSTOOD]
        association.release()
        assert opened.codes == ["RECEIVE_CONTRADICTS"]


def test_the_quota_in_bytes_and_in_series_is_kept_and_told(tmp_path: Path) -> None:
    made = made_ct()
    one_file = len(file_of(made.slices[0]))
    limits = InboxLimits(max_bytes=int(3.5 * one_file), max_series=1, max_age_s=3600.0)
    with door(tmp_path, limits=limits) as opened:
        association = associated(opened.port)
        assert sent(association, made.slices) == [SUCCESS] * 3 + [FULL] * 2
        other = made_ct(series="1.2.3.4").slices[0]
        other.PixelData = bytes(8)
        assert sent(association, [other]) == [FULL]
        association.release()
        assert opened.codes == ["RECEIVE_FULL"] * 2 + ["RECEIVE_MANY_SERIES"]
        assert opened.remarks[-1].message == "a series was refused, because 1 wait already, allowed 1"
        opened.inbox.discard(opened.waiting()[0].id)
        complete(opened, [other])


def test_what_is_too_old_is_deleted(tmp_path: Path) -> None:
    with door(tmp_path) as opened:
        complete(opened, made_ct().slices)
        one = opened.described()
        assert len(opened.inbox.waiting(one.changed_s + 3599.0)) == 1
        assert opened.inbox.waiting(one.changed_s + 3601.0) == ()
        assert sorted(path.name for path in tmp_path.iterdir()) == ["incoming"]


def test_what_a_connection_left_within_a_slice_is_deleted(tmp_path: Path) -> None:
    inbox = Inbox(tmp_path, LIMITS)
    inbox.clear_incoming()
    for name, age_s in (("left", 601.0), ("arriving", 30.0)):
        (inbox.incoming / name).write_bytes(b"half")
        os.utime(inbox.incoming / name, (1e9 - age_s, 1e9 - age_s))
    inbox.prepare(1e9)
    assert [path.name for path in inbox.incoming.iterdir()] == ["arriving"]


def test_hostile_bytes_do_not_stop_it(tmp_path: Path) -> None:
    random = np.random.default_rng(1)
    with door(tmp_path) as opened:
        for content in (
            b"GET / HTTP/1.1\r\n\r\n",
            random.bytes(4096),
            struct.pack(">BBL", 1, 0, 2**32 - 1) + random.bytes(1000),
            struct.pack(">BBL", 4, 0, 10) + random.bytes(10),
            b"",
        ):
            with socket.create_connection(("127.0.0.1", opened.port)) as peer:
                peer.sendall(content)
        complete(opened, made_ct().slices)
        assert opened.described().files == 5


def test_a_slice_that_is_no_dicom_is_refused(tmp_path: Path) -> None:
    with door(tmp_path) as opened:
        association = associated(opened.port)
        one = made_ct().slices[0]
        one.SOPClassUID = "1.2.840.10008.5.1.4.1.1.2"
        one.add_new(0x00080005, "CS", "ISO_IR 100")
        # A length beyond the end: the header cannot be read.
        raw = Dataset()
        raw.SOPClassUID, raw.SOPInstanceUID = one.SOPClassUID, one.SOPInstanceUID
        assert sent(association, [raw]) == [NO_MATCH]
        association.release()
        assert opened.codes == ["RECEIVE_DAMAGED"]
        assert opened.waiting() == ()
        until(lambda: not list(opened.inbox.incoming.iterdir()))


def test_names_are_neither_logged_nor_in_the_description(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    made = made_ct()
    for one in made.slices:
        one.SeriesDescription = "Quibble spine"
    with caplog.at_level(logging.DEBUG), door(tmp_path) as opened:
        complete(opened, made.slices)
        one = opened.described()
    assert one.description is not None
    assert one.description.words == ""
    family = NAME.partition("^")[0]
    assert family not in caplog.text
    assert not [path for path in tmp_path.rglob("*.json") if family in path.read_text()]
    assert {path.stat().st_mode & 0o077 for path in tmp_path.iterdir() if path.is_dir()} == {0}


def test_an_unreadable_series_waits_with_its_reason(tmp_path: Path) -> None:
    made = made_ct()
    for one in made.slices:
        del one.Rows
    with door(tmp_path) as opened:
        complete(opened, made.slices)
        one = opened.described()
        assert one.problem is not None
        assert one.problem.code == "CT_FILE_DAMAGED"


def tls_settings(folder: Path, *, client_ca: Path | None = None) -> ReceiverSettings:
    made = load_or_create(folder, host="127.0.0.1")
    return ReceiverSettings(
        ae_title="COAXIAL",
        allowed=SETTINGS.allowed,
        certificate=made.certificate,
        key=made.key,
        client_ca=client_ca,
    )


def client_certificate(path: Path) -> Path:
    """A certificate of a sender, which is its own authority, with its key in one file."""
    key = ec.generate_private_key(ec.SECP256R1())
    name = x509.Name([x509.NameAttribute(NameOID.COMMON_NAME, "scanner")])
    begin = datetime.now(tz=UTC) - timedelta(hours=1)
    certificate = (
        x509.CertificateBuilder(name, name, key.public_key(), 1, begin, begin + timedelta(days=2))
        .add_extension(x509.BasicConstraints(ca=True, path_length=0), critical=True)
        .sign(key, hashes.SHA256())
    )
    secret = key.private_bytes(
        serialization.Encoding.PEM, serialization.PrivateFormat.PKCS8, serialization.NoEncryption()
    )
    path.write_bytes(certificate.public_bytes(serialization.Encoding.PEM) + secret)
    return path


def test_tls_is_required_where_it_is_set_and_slow_handshakes_hold_up_nobody(tmp_path: Path) -> None:
    settings = tls_settings(tmp_path / "own")
    context = ssl.create_default_context(cafile=str(settings.certificate))
    with door(tmp_path / "inbox", settings=settings) as opened:
        with socket.create_connection(("127.0.0.1", opened.port)) as silent:
            association = associated(opened.port, tls=(context, "127.0.0.1"))
            assert sent(association, made_ct().slices) == [SUCCESS] * 5
            association.release()
            # It was not waited for until its time was over.
            silent.setblocking(False)
            with pytest.raises(BlockingIOError):
                silent.recv(1)
        assert not associated(opened.port).is_established
        assert opened.described().files == 5


def test_senders_need_their_certificate_where_it_is_set(tmp_path: Path) -> None:
    client = client_certificate(tmp_path / "client.pem")
    settings = tls_settings(tmp_path / "own", client_ca=client)
    context = ssl.create_default_context(cafile=str(settings.certificate))
    with door(tmp_path / "inbox", settings=settings) as opened:
        rejected = associated(opened.port, tls=(context, "127.0.0.1"))
        assert not rejected.is_established
        context.load_cert_chain(client)
        association = associated(opened.port, tls=(context, "127.0.0.1"))
        assert sent(association, made_ct().slices[:1]) == [SUCCESS]
        association.release()


def test_orthanc_sends_a_ct(tmp_path: Path) -> None:
    made = made_study()
    with door(tmp_path / "inbox") as opened:
        modality = {"coaxial": ["COAXIAL", "127.0.0.1", opened.port]}
        with orthanc_in(tmp_path / "orthanc", settings={"DicomModalities": modality}) as archive:
            for path in made.write(tmp_path / "ct").iterdir():
                archive.post("/instances", path.read_bytes())
            (series,) = archive.find("Series", {"Modality": "CT"})
            answer = archive.post("/modalities/coaxial/store", series["ID"].encode())
        assert (answer["InstancesCount"], answer["FailedInstancesCount"]) == (12, 0)
        one = opened.described()
        opened.inbox.link_into(one.id, tmp_path / "taken")
    assert np.array_equal(read_ct(tmp_path / "taken").volume.hu, made.hu)


def test_a_series_that_is_not_there_is_said_to_be_unknown(tmp_path: Path) -> None:
    inbox = Inbox(tmp_path / "inbox", LIMITS)
    for series_id in ("../inbox", "0" * 32, ""):
        with pytest.raises(ReceivedUnknown):
            inbox.discard(series_id)
    assert (tmp_path / "inbox").is_dir()
    shutil.rmtree(tmp_path / "inbox")
