"""Objects of a plan arrive in an archive (Orthanc), in the study of their CT; what it refuses is told."""

import ssl
from collections.abc import Iterator
from pathlib import Path

import pydicom
import pytest
from pynetdicom import AE, evt
from pynetdicom.acse import ACSE
from pynetdicom.sop_class import EncapsulatedSTLStorage  # pyrefly: ignore[missing-module-attribute]  made at its import

from server.config import DicomArchiveConfig, DicomConfig
from server.imaging.dicom_network.sender import ArchiveError, send_objects
from server.imaging.dicom_objects import PlanObject, plan_objects
from server.security.tls.self_signed import load_or_create
from tests.dicom_tools import Orthanc, closed_sockets, free_port, orthanc_in  # noqa: F401  a fixture
from tests.server.dicom_receiver.sending import until
from tests.server.imaging.made_study import PATIENT, STUDY, labels_of, made_study, source_of
from tests.tracker.plan.test_plan_document import document


@pytest.fixture(scope="module")
def orthanc(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Orthanc]:
    with orthanc_in(tmp_path_factory.mktemp("orthanc")) as archive:
        yield archive


@pytest.fixture(scope="module")
def objects(tmp_path_factory: pytest.TempPathFactory) -> tuple[PlanObject, ...]:
    source = source_of(tmp_path_factory.mktemp("study"), made_study())
    return plan_objects(source, document(), version="0.1.0", labels=labels_of(source))


def settings_for(
    port: int, *, title: str = "ORTHANC", tls: bool = False, ca: Path | None = None
) -> DicomConfig:
    archive = DicomArchiveConfig(host="127.0.0.1", port=port, ae_title=title, tls=tls, ca=ca)
    return DicomConfig(archive=archive)


def test_objects_are_in_the_study_of_their_ct(
    orthanc: Orthanc, objects: tuple[PlanObject, ...], tmp_path: Path
) -> None:
    for path in made_study().write(tmp_path / "ct").iterdir():
        orthanc.post("/instances", path.read_bytes())
    answers = send_objects(objects, settings_for(orthanc.port))
    assert [(one.name, one.text) for one in answers] == [(one.name, "stored") for one in objects]
    (study,) = orthanc.find("Study", {"StudyInstanceUID": STUDY})
    assert study["PatientMainDicomTags"]["PatientName"] == PATIENT
    modalities = [
        orthanc.find("Series", {"StudyInstanceUID": STUDY, "Modality": kind})
        for kind in ("CT", "SEG", "M3D", "SR")
    ]
    assert [len(found) for found in modalities] == [1, 1, 1, 1]
    assert [len(found[0]["Instances"]) for found in modalities] == [12, 1, 2, 1]
    stored = orthanc.get(f"/instances/{modalities[3][0]['Instances'][0]}/file")
    (tmp_path / "report.dcm").write_bytes(stored)
    sent = next(one for one in objects if one.name == "report")
    (tmp_path / "sent.dcm").write_bytes(sent.content)
    assert pydicom.dcmread(tmp_path / "report.dcm") == pydicom.dcmread(tmp_path / "sent.dcm")


def test_a_wrong_title_is_told(orthanc: Orthanc, objects: tuple[PlanObject, ...]) -> None:
    with pytest.raises(ArchiveError, match="rejects the connection of COAXIAL") as raised:
        send_objects(objects, settings_for(orthanc.port, title="ANOTHER"))
    assert raised.value.code == "ARCHIVE_REJECTED"


def test_a_rejection_that_comes_before_somebody_waits_for_it_is_told(
    orthanc: Orthanc, objects: tuple[PlanObject, ...], monkeypatch: pytest.MonkeyPatch
) -> None:
    request = ACSE.send_request

    def slowly(acse: ACSE) -> None:
        request(acse)
        # The archive has closed the connection, which looks like one that was never made.
        assert acse.dul.socket is not None
        made = acse.dul.socket
        until(lambda: not (acse.dul.to_user_queue.empty() or made._is_connected))

    monkeypatch.setattr(ACSE, "send_request", slowly)
    with pytest.raises(ArchiveError) as raised:
        send_objects(objects, settings_for(orthanc.port, title="ANOTHER"))
    assert raised.value.code == "ARCHIVE_REJECTED"


def test_an_archive_that_is_not_there_is_told(objects: tuple[PlanObject, ...]) -> None:
    with pytest.raises(ArchiveError, match="does not answer"):
        send_objects(objects, settings_for(free_port()))
    with pytest.raises(ArchiveError, match="name no archive"):
        send_objects(objects, DicomConfig())


def test_each_answer_of_an_archive_is_told(objects: tuple[PlanObject, ...]) -> None:
    entity = AE(ae_title="SMALL")
    for uid in {one.sop_class_uid for one in objects} - {EncapsulatedSTLStorage}:
        entity.add_supported_context(uid)
    statuses = iter([0xA700, 0xB000])
    server = entity.start_server(
        ("127.0.0.1", 0), block=False, evt_handlers=[(evt.EVT_C_STORE, lambda _event: next(statuses))]
    )
    assert server is not None
    try:
        answers = send_objects(objects, settings_for(server.server_address[1], title="SMALL"))
    finally:
        server.shutdown()
    assert [(one.is_stored, one.text) for one in answers] == [
        (False, "not stored, status A700"),
        (False, "it does not accept Encapsulated STL Storage"),
        (False, "it does not accept Encapsulated STL Storage"),
        (True, "stored, status B000"),
    ]


def test_the_certificate_of_the_archive_is_verified(objects: tuple[PlanObject, ...], tmp_path: Path) -> None:
    made = load_or_create(tmp_path, host="127.0.0.1")
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
    context.load_cert_chain(made.certificate, made.key)
    entity = AE(ae_title="SAFE")
    for uid in {one.sop_class_uid for one in objects}:
        entity.add_supported_context(uid)
    server = entity.start_server(
        ("127.0.0.1", 0),
        block=False,
        ssl_context=context,
        evt_handlers=[(evt.EVT_C_STORE, lambda _event: 0x0000)],
    )
    assert server is not None
    port = server.server_address[1]
    try:
        trusted = settings_for(port, title="SAFE", tls=True, ca=made.certificate)
        assert all(one.is_stored for one in send_objects(objects, trusted))
        with pytest.raises(ArchiveError, match="does not answer"):
            send_objects(objects, settings_for(port, title="SAFE", tls=True))
    finally:
        server.shutdown()
    with pytest.raises(ArchiveError, match="no certificate in"):
        send_objects(objects, settings_for(port, tls=True, ca=tmp_path / "missing.pem"))
