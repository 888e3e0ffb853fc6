"""Everything that reads bytes of strangers: seeds, which the project's own writers make, and the reader.

A reader may return, or raise one of the project's errors, which has code, message and remedy. Everything else
is a finding.
"""

import gzip
import hashlib
import io
import json
import tempfile
import zipfile
import zlib
from collections.abc import Callable, Iterator, Sequence
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass
from datetime import UTC, datetime
from functools import cache
from pathlib import Path

import cv2
import msgspec
import numpy as np
import yaml

from server.camera_file import CameraFile, camera_file_text, read_camera_file
from server.capture.address import mask_secrets, source_from_text
from server.capture.jpeg_header import jpeg_size_wh_px
from server.capture.pose_frames import PoseFrames
from server.certificate import ExaminedSystem, Issue, PlateFile, SigningKey, certificate_of, verified
from server.certificate.plate_file import plate_file_in, printed_plate, text_of_plate_file
from server.cli.certify_captures import load_captures
from server.cli.landmark_rows import read_landmarks
from server.cli.point_rows import read_columns
from server.cli.replay import describe_file
from server.config_file import load_config
from server.image_file import decoded
from server.imaging.ct_reader import list_series, read_ct
from server.imaging.labels.label_file import label_file_bytes, load_label_file
from server.imaging.labels.names import names_from_text
from server.imaging.labels.placement import labels_on_ct
from server.imaging.labels.reader import read_label_images
from server.imaging.meshes import mesh_from_bytes
from server.imaging.nifti import nifti_bytes
from server.marker_file import marker_image
from server.openigtlink.requests import RequestReader
from server.openigtlink_wire import (
    TRACKED_TOOL,
    Message,
    Point,
    Status,
    WireError,
    pack,
    points_content,
    points_of,
    status_content,
    string_content,
    string_of,
    transform_content,
)
from server.pose_file import Unit, read_poses
from server.recording.cut import cut_recording
from server.recording.export import Table, csv_lines
from server.recording.replay import check_recording
from server.recording.sequence_metafile import write_sequence
from server.recording.timeline import index_path, store_index, stored_index, stored_summary
from server.recording_file import RecordingReader, RecordingWriter, Topic
from server.recording_file.codec import CodecError, decoded_value, encoded_value
from server.recording_file.locations import read_duration_s
from server.recording_file.packing import ImagePacker
from server.recording_file.writer import compressed_json
from server.scene.gate import CAMERA_MESSAGE, Gate
from server.security.audit.chain import Head, chained_line
from server.security.audit.files import last_lines, read_head, verify_files
from server.security.hosts import KnownHosts, is_same_origin
from server.security.people.file import read_people, write_people
from server.security.people.records import Invitation, Session
from server.security.people.tokens import Token
from server.security.person import Person, Role
from server.setup import build_setup
from server.slicer_file import markups_from_bytes, markups_to_bytes
from server.slicer_file.markups import Markup, MarkupKind
from server.slicer_file.plan_markups import landmarks_from_markups, line_from_markups
from server.slicer_file.transform import fixed_from_moving_in_itk, itk_text
from server.store import CaseStore, DocumentKind, Home
from server.stream.messages import translated_problem
from server.stream.phone.sender import Sender, parse_hello
from server.stream.socket import ProtocolViolation
from server.tool_file import PivotPart, ToolFile, load_tool_file, text_of_tool_file
from tests.server.imaging.made_ct import enhanced_of, file_of, made_ct, nifti_of
from tests.server.imaging.made_labels import label_nifti, segmentation_file, segmentation_of
from tests.server.imaging.test_meshes import ascii_stl, binary_ply, binary_stl, obj, text_ply
from tests.server.pose_file.test_read_poses import MATRICES, rows, tracked_line
from tests.server.recording.recorded import HEIGHT, WIDTH, RecordedTheatre, made_config
from tests.server.recording_file.written import NO_LIMITS, write_recording
from tests.tracker.accuracy.test_accuracy_assessment import MEASURED, PLATE, POINTS, SOUND, captures_of
from tracker.accuracy import assess_accuracy
from tracker.camera import CameraModel
from tracker.errors import NavigationError
from tracker.geometry import Anchor, Rigid, Vertebra, rotation_from_vector
from tracker.plan import Volume
from tracker.plan.labels import LabelVolume

CHECKOUT = Path(__file__).parents[2]
Read = Callable[[bytes], object]


@dataclass(frozen=True, slots=True, kw_only=True)
class Target:
    """A reader of bytes.

    Attributes:
        name: for the command line.
        seeds: valid inputs.
        opened: context manager for the reader; it gets an empty folder.
        wrap: makes the input of the reader from changed bytes, as by packing them with a right checksum.
        expected: exceptions that are caught and handled by the caller of the reader in the product.
    """

    name: str
    seeds: Callable[[], Sequence[bytes]]
    opened: Callable[[Path], AbstractContextManager[Read]]
    wrap: Callable[[bytes], bytes] = bytes
    expected: tuple[type[Exception], ...] = ()


def in_memory(read: Read) -> Callable[[Path], AbstractContextManager[Read]]:
    """Open a reader of bytes."""

    @contextmanager
    def opened(_folder: Path) -> Iterator[Read]:
        yield read

    return opened


def of_file(name: str, read: Callable[[Path], object]) -> Callable[[Path], AbstractContextManager[Read]]:
    """Open a reader of a file of this name."""

    @contextmanager
    def opened(folder: Path) -> Iterator[Read]:
        path = folder / name

        def read_bytes(content: bytes) -> object:
            path.write_bytes(content)
            return read(path)

        yield read_bytes

    return opened


# ---------------------------------------------------------------- CT and segmentations

AFFINE = np.diag([0.7, 0.7, 2.0, 1.0])
HU = np.random.default_rng(5).integers(-1000, 2000, (6, 7, 8)).astype(np.int16)


@cache
def small_labels() -> LabelVolume:
    """Three boxes, each with the number of a vertebra."""
    labels = np.zeros((12, 12, 12), dtype=np.uint8)
    for number, low in ((29, 0), (28, 4), (27, 8)):
        labels[low : low + 4, 1:11, 1:11] = number
    return LabelVolume(labels=labels, lps_from_ijk=np.diag([4.0, 4.0, 6.0, 1.0]), voxel_mm=4.0)


@cache
def ct_of_labels() -> Volume:
    """A CT in which the boxes are bone."""
    labels = small_labels().labels
    return Volume(
        hu=np.where(labels > 0, 400, 20).astype(np.int16), lps_from_ijk=np.diag([4.0, 4.0, 6.0, 1.0])
    )


@cache
def slices() -> list[bytes]:
    """Files of a slice, and of several frames."""
    made = made_ct(count=3)
    return [
        file_of(made.slices[0]),
        file_of(made.slices[1], "1.2.840.10008.1.2.2"),
        file_of(enhanced_of(made)),
    ]


def nifti() -> list[bytes]:
    """NIfTI of two kinds of numbers."""
    return [nifti_of(HU, AFFINE), nifti_of(HU.astype(np.float32), AFFINE)]


@cache
def _other_slices() -> list[bytes]:
    return [file_of(one) for one in made_ct(count=4).slices[1:]]


@contextmanager
def series_opened(folder: Path) -> Iterator[Read]:
    """A folder of slices, one of which is the input."""
    for number, content in enumerate(_other_slices()):
        (folder / f"IM{number}").write_bytes(content)

    def read(content: bytes) -> object:
        (folder / "IM9").write_bytes(content)
        list_series(folder)
        return read_ct(folder)

    yield read


def _zipped(contents: Sequence[bytes], *, names: str = "IM{}") -> bytes:
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive:
        for number, content in enumerate(contents):
            archive.writestr(zipfile.ZipInfo(names.format(number)), content)
    return file.getvalue()


def _read_ct_file(path: Path) -> object:
    list_series(path)
    return read_ct(path, into=path.with_name("voxels.npy"))


def _read_labels(path: Path) -> object:
    return labels_on_ct(read_label_images(path, names={}), ct_of_labels())


@cache
def segmentations() -> list[bytes]:
    """DICOM SEG with codes, and with names."""
    return [segmentation_file(segmentation_of(small_labels(), coded=coded)) for coded in (True, False)]


def unpacked_labels() -> list[bytes]:
    """NIfTI of labels, with and without a table of names."""
    names = {29: "vertebrae_L3", 28: "vertebrae_L4", 27: "vertebrae_L5"}
    return [gzip.decompress(label_nifti(small_labels(), names=one)) for one in (None, names)]


# ---------------------------------------------------------------- text files


def camera_model() -> CameraModel:
    """A camera model."""
    return CameraModel(
        matrix=np.array([[900.0, 0.0, 640.0], [0.0, 900.0, 360.0], [0.0, 0.0, 1.0]]),
        distortion=np.array([0.01, -0.02, 0.0, 0.0, 0.0]),
        size_wh_px=(1280, 720),
    )


def camera_files() -> list[bytes]:
    """Camera files as the calibration writes them, and as JSON."""
    file = CameraFile(model=camera_model(), camera_name="main", camera_source="0", readout_ms=12.0)
    text = camera_file_text(file, {"rms_px": 0.2, "sd": {"fx": 0.1}, "warnings": ["few views"]})
    aliased = "controls: &a {focus: 1}\n"
    return [text.encode(), json.dumps(yaml.safe_load(text)).encode(), (text + aliased).encode()]


def tool_file() -> ToolFile:
    """A calibrated tool."""
    pivot = PivotPart(
        tip_in_marker_mm=[1.0, -120.0, 4.0],
        covariance_mm2=np.eye(3).tolist(),
        rms_3d_mm=0.2,
        used=40,
        rejected=1,
        tilt_range_deg=40.0,
        made_at=datetime(2026, 1, 1, tzinfo=UTC),
    )
    return ToolFile(marker="drill", side_mm=30.0, pivot=pivot)


def configs() -> list[bytes]:
    """The settings of the repository, and small ones with aliases."""
    text = (CHECKOUT / "config.yaml").read_bytes()
    aliased = b"x: &a [1, 2]\ny: &b [*a, *a]\ncamera: {source: *b}\n"
    return [text, aliased, json.dumps(yaml.safe_load(text)).encode(), b"server: {port: 0x1f}\nlimits: {}\n"]


def captures() -> list[bytes]:
    """A captures file, whose poses are missing."""
    entry = {"divot": "a1", "placement": "1", "posture": "upright", "poses": "poses.json"}
    return [json.dumps({"kind": "coaxial accuracy captures", "captures": [entry] * 2}).encode()]


def _read_captures(path: Path) -> object:
    path.with_name("poses.json").write_text(json.dumps(MATRICES.tolist()))
    return load_captures(path, tool_file(), SOUND.tool, unit=Unit.MM)


def poses_as_text() -> list[bytes]:
    """Rows of numbers, and named columns."""
    flat = np.hstack([np.arange(12)[:, None] / 30.0, MATRICES.reshape(12, 16)])
    header = "time_s,x,y,z,qw,qx,qy,qz\n"
    return [
        "\n".join(rows(matrix) for matrix in MATRICES[:3]).encode(),
        ("time," + ",".join(f"m{n}" for n in range(16)) + "\n" + rows(flat[:3], ";")).encode(),
        (header + "0.1,1,2,300,1,0,0,0\n0.2,1,2,301,1,0,0,0\n").encode(),
        np.array2string(MATRICES[:2], separator=", ").encode(),
    ]


def poses_as_json() -> list[bytes]:
    """Matrices, objects and lines of `coaxial track`."""
    poses = [{"rotation": m[:3, :3].tolist(), "translation_mm": m[:3, 3].tolist()} for m in MATRICES[:3]]
    lines = "".join(
        tracked_line(m, time_s=0.1, side_mm=30.0, calibration_sha256="0" * 64) for m in MATRICES[:2]
    )
    return [json.dumps(MATRICES[:2].tolist()).encode(), json.dumps({"poses": poses}).encode(), lines.encode()]


def poses_as_array() -> list[bytes]:
    """An array of NumPy."""
    file = io.BytesIO()
    np.save(file, MATRICES[:3])
    return [file.getvalue()]


def poses_as_archive() -> list[bytes]:
    """An array in an archive of NumPy."""
    file = io.BytesIO()
    np.savez_compressed(file, poses=MATRICES[:3].reshape(3, 16))
    return [file.getvalue()]


def _read_poses(path: Path) -> object:
    found = read_poses(path)
    json.dumps([[one.place, one.marker, one.time_s, one.side_mm] for one in found.records]).encode()
    return found.poses


def markups() -> list[bytes]:
    """Points and a line."""
    points = np.array([[1.0, -2.0, 3.0], [4.0, -50.0, 6.0]])
    names = ("entry", "target")
    both = [Markup(kind=kind, name="L3", points_lps_mm=points, labels=names) for kind in list(MarkupKind)[:3]]
    return [markups_to_bytes([one]) for one in both] + [markups_to_bytes(both[:2])]


def _read_markups(content: bytes) -> object:
    found = markups_from_bytes(content, name="a.mrk.json")
    for read in (landmarks_from_markups, line_from_markups):
        try:
            read(found, name="a.mrk.json")
        except NavigationError as error:
            check_error(error)
    return found


def transforms() -> list[bytes]:
    """Transforms of each class."""
    pose: Rigid[Vertebra, Anchor] = Rigid(
        rotation=rotation_from_vector([0.1, 0.2, 0.3]), translation_mm=np.array([1.0, 2.0, 3.0])
    )
    affine = itk_text(pose)
    euler = affine.replace("AffineTransform", "Euler3DTransform")
    lines = euler.splitlines()
    lines[3] = "Parameters: 0.1 0.2 0.3 1 2 3"
    versor = "\n".join(lines).replace("Euler3D", "VersorRigid3D")
    return [affine.encode(), ("\n".join(lines) + "\n").encode(), (versor + "\n").encode()]


def _read_landmarks_named(name: str) -> Callable[[Path], AbstractContextManager[Read]]:
    return of_file(name, read_landmarks)


# ---------------------------------------------------------------- pictures


def pictures() -> list[bytes]:
    """A marker in the formats that are read."""
    image = np.full((40, 40), 255, np.uint8)
    image[:20, :20] = 0
    kinds = (".png", ".jpg", ".bmp", ".webp", ".tiff", ".pgm", ".jp2")
    return [cv2.imencode(kind, image)[1].tobytes() for kind in kinds]


def _png_chunks(content: bytes) -> bytes:
    """Return a PNG with right checksums, so that its decoder takes changed chunks."""
    if content[:8] != pictures()[0][:8]:
        return content
    repaired, at = [content[:8]], 8
    while at + 8 <= len(content):
        length = int.from_bytes(content[at : at + 4], "big")
        body = content[at + 4 : at + 8 + length]
        repaired.append(content[at : at + 4] + body + zlib.crc32(body).to_bytes(4, "big"))
        at += 12 + length
    return b"".join(repaired)


# ---------------------------------------------------------------- archives and recordings


@cache
def archive_parts() -> dict[str, bytes]:
    """The parts of an exported case."""
    with tempfile.TemporaryDirectory() as folder, Home(Path(folder)) as home, CaseStore(home) as store:
        case = store.create("L3")
        with store.new_file(case.id, ".bin") as new:
            new.path.write_bytes(bytes(range(200)))
        ct = store.put(case.id, DocumentKind.CT, "main", {"mm": 0.3}, made_by="ito", files=[new.stored.id])
        plan = store.put(
            case.id, DocumentKind.PLAN, "L3", {"a": [1, None]}, made_by="abe", depends_on=[ct.id]
        )
        store.withdraw(plan, by="abe", reason="moved")
        path = store.export_case(case.id, with_identity=True).path
        with zipfile.ZipFile(path) as archive:
            return {name: archive.read(name) for name in archive.namelist()}


def archives() -> list[bytes]:
    """An exported case."""
    return [_archive(archive_parts())]


def archive_texts() -> list[bytes]:
    """The texts of an archive, which `archive_with` packs."""
    return [archive_parts()[name] for name in ("case.json", "documents.jsonl", "manifest.json")]


def archive_with(text: bytes) -> bytes:
    """Return an archive with this text as the part that it is most like, and a manifest that agrees."""
    parts = dict(archive_parts())
    if b"format" in text[:200]:
        return _archive({**parts, "manifest.json": text})
    parts["documents.jsonl" if b"stands_on" in text else "case.json"] = text
    manifest = json.loads(parts["manifest.json"])
    manifest["parts"] = [
        {"path": path, "size_bytes": len(part), "sha256": hashlib.sha256(part).hexdigest()}
        for path, part in parts.items()
        if path != "manifest.json"
    ]
    return _archive({**parts, "manifest.json": json.dumps(manifest).encode()})


def _archive(parts: dict[str, bytes]) -> bytes:
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w") as archive:
        for name, content in parts.items():
            archive.writestr(zipfile.ZipInfo(name), content)
    return file.getvalue()


@contextmanager
def store_opened(folder: Path) -> Iterator[Read]:
    """A store that imports an archive, reads all of it, and deletes it."""
    with Home(folder / "home") as home, CaseStore(home) as store:

        def read(content: bytes) -> object:
            path = folder / "case.zip"
            path.write_bytes(content)
            before = {one.id for one in store.list()}
            try:
                case = store.import_archive(path, by="M. Ito")
            except NavigationError:
                if {one.id for one in store.list()} != before:
                    raise AssertionError("a rejected archive left a case") from None
                raise
            for entry in store.outline(case.id):
                store.document(case.id, entry.heading.id)
            damages = store.verify(case.id)
            store.delete(case.id, confirm=case.name)
            if damages:
                raise AssertionError(f"an imported case is damaged: {damages}")
            return case

        yield read


@cache
def recordings() -> list[bytes]:
    """A small recording with notes, and one with the messages of an index."""
    with tempfile.TemporaryDirectory() as folder:
        return [write_recording(Path(folder) / "a.mcap", 3).read_bytes()]


def _read_recording(path: Path) -> object:
    read_duration_s(path)
    store_index(lambda _ratio, _doing: None, recording=str(path))
    for table in Table:
        "".join(csv_lines(path, table)).encode()
    check_recording(path)
    describe_file(path, as_json=True)
    cut_recording(path, path.with_name("cut.mcap"), from_s=0.0, to_s=3.0, report=lambda _ratio, _doing: None)
    return write_sequence(path, path.with_name("a.igs.mha"), to_s=2.0)


@cache
def recorded_messages() -> list[bytes]:
    """All messages of a tracked recording of black images, as JSON: topic, number of the image, content."""
    config = made_config()
    image = np.zeros((HEIGHT, WIDTH, 3), np.uint8)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "a.mcap"
        theatre = RecordedTheatre(
            path=path, images=[image] * 12, preparation=build_setup(config), config=config
        )
        theatre.track(0)
        theatre.begin()
        for number in range(1, 8):
            theatre.track(number)
        theatre.end()
        messages = [
            [one.topic.value, one.sequence, None if one.topic is Topic.IMAGE else one.json()]
            for one in RecordingReader(path).messages()
        ]
    # The state of tracking has megabytes; its form has a target of its own.
    small = [one for one in messages if one[0] != Topic.STATE]
    return [json.dumps(one).encode() for one in (small[:9], small[9:20], small[-8:])]


def recording_of(content: bytes) -> bytes:
    """Return a recording with these messages, if they are a list of them."""
    try:
        messages = [(Topic(topic), int(number) % 2**32, one) for topic, number, one in json.loads(content)]
    except (ValueError, TypeError, OverflowError, RecursionError):
        return content
    packer, image = ImagePacker(), np.zeros((HEIGHT, WIDTH, 3), np.uint8)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "a.mcap"
        writer = RecordingWriter(path, limits=NO_LIMITS, unix_offset_s=1.7e9, library="test")
        for at, (topic, number, one) in enumerate(messages):
            if topic is Topic.IMAGE:
                writer.add_image(packer.pack(image), number=number, at_s=float(at))
            elif topic in {Topic.STATE, Topic.ALARM_STATE}:
                writer.add_compressed(topic, float(at), compressed_json(one), sequence=number)
            else:
                writer.register(topic, {})
                writer.add_json(topic, float(at), json.dumps(one), sequence=number)
        writer.close()
        return path.read_bytes()


def without_checksums(content: bytes) -> bytes:
    """Return a recording whose chunks and end state no checksum."""
    changed, at = bytearray(content), 8
    while at + 9 <= len(changed):
        opcode, length = changed[at], int.from_bytes(changed[at + 1 : at + 9], "little")
        if opcode == 0x06:
            changed[at + 9 + 24 : at + 9 + 28] = bytes(4)
        elif opcode in {0x02, 0x0F}:
            changed[at + 9 + length - 4 : at + 9 + length] = bytes(4)
        at += 9 + length
    return bytes(changed)


def recorded_states() -> list[bytes]:
    """Values as a recording stores them."""
    value = {"a": np.eye(3), "b": (1, 2.5, None), "c": {frozenset({1}), 2}, "d": slice(1, 2), "e": b"x"}
    return [json.dumps(encoded_value(value)).encode(), json.dumps(encoded_value(camera_model())).encode()]


def _read_recorded_state(content: bytes) -> object:
    try:
        values = json.loads(content)
    except (ValueError, RecursionError):
        return None
    return decoded_value(values)


@cache
def indexes() -> list[bytes]:
    """The stored index of a recording."""
    with tempfile.TemporaryDirectory() as folder:
        path = write_recording(Path(folder) / "a.mcap", 3)
        store_index(lambda _ratio, _doing: None, recording=str(path))
        return [index_path(path).read_bytes()]


def _read_index(path: Path) -> object:
    recording = path.with_name("a.mcap")
    stored_summary(recording)
    return stored_index(recording)


# ---------------------------------------------------------------- certificates and the server's folder


@cache
def signing_key() -> SigningKey:
    """A key of somebody who signs what they like."""
    with tempfile.TemporaryDirectory() as folder:
        return SigningKey(Path(folder))


@cache
def certificate_contents() -> list[bytes]:
    """The content of a certificate, unsigned."""
    found = assess_accuracy(captures_of(SOUND), PLATE, SOUND.tool, plate_scale=MEASURED)
    divots = {name: list(point) for name, point in POINTS.items()}
    examined = ExaminedSystem(
        camera=CameraFile(model=SOUND.tool.camera, camera_name="main"),
        marker="drill",
        tool=SOUND.tool,
        plate=PlateFile(name="A4", sd_mm=0.1, rulers_mm=100.0, divots=divots),
        scale=MEASURED,
    )
    at = datetime(2026, 1, 1, tzinfo=UTC)
    issue = Issue(at=at, valid_days=30, by="ito", software_version="1", audit=None, latency=None)
    return [certificate_of(found, captures_of(SOUND), examined, issue).model_dump_json().encode()]


def signed(content: bytes) -> bytes:
    """Return a content with a valid signature, if it is JSON."""
    try:
        return signing_key().signed_json(json.loads(content))
    except (ValueError, RecursionError):
        return content


def certificates() -> list[bytes]:
    """Signed files, of a content that is no certificate."""
    return [signed(b'{"a": 1, "tool": {"marker": "drill"}}'), signing_key().signed_pdf(b"%PDF-1.7\n%%EOF\n")]


@cache
def people() -> list[bytes]:
    """The file of people, empty and with an invitation and a session."""
    at, later = datetime(2026, 1, 1, tzinfo=UTC), datetime(2026, 1, 2, tzinfo=UTC)
    person = Person(id="a" * 16, name="Ito", role=Role.OPERATOR)
    invitation = Invitation(
        id="b" * 16,
        person=person,
        made_by="abe",
        made_at=at,
        expires_at=later,
        single_use=True,
        for_machine=False,
        session_lasts=later - at,
        token_sum="c" * 64,
    )
    session = Session(
        id="d" * 16,
        person=person,
        invitation_id="b" * 16,
        started_at=at,
        expires_at=later,
        for_machine=False,
        token_sum="c" * 64,
    )
    files = []
    with tempfile.TemporaryDirectory() as folder:
        for invitations, sessions in (([], []), ([invitation], [session])):
            write_people(Path(folder) / "people.json", invitations, sessions)
            files.append((Path(folder) / "people.json").read_bytes())
    return files


def audit_logs() -> list[bytes]:
    """Lines that are chained."""
    lines, head = [], Head()
    for code in ("signed_in", "changed"):
        raw, head = chained_line(head, {"at": "2026-01-01T00:00:00.000Z", "by": "ito", "code": code})
        lines.append(raw + b"\n")
    return [b"".join(lines)]


def _read_audit_log(path: Path) -> object:
    read_head(path)
    last_lines(path, 3)
    return verify_files(path, None)


# ---------------------------------------------------------------- sockets


def openigtlink() -> list[bytes]:
    """Messages of both versions."""
    contents = {
        "TRANSFORM": transform_content(np.eye(4)),
        "STATUS": status_content(Status(code=1, name="OK", text="all is well")),
        "STRING": string_content("GET_CAPABIL"),
        "POINT": points_content([Point(name="a", group="b", position_mm=np.ones(3))]),
        "TDATA": TRACKED_TOOL.pack(b"DrillToTracker", 2, *np.eye(4)[:3].T.ravel()),
    }
    return [
        b"".join(
            pack(
                Message(type=kind, device="x", timestamp_s=1.5, content=one, metadata={"a": "b"}),
                version=version,
            )
            for kind, one in contents.items()
        )
        for version in (1, 2)
    ]


def _read_openigtlink(content: bytes) -> object:
    reader, found = RequestReader(), []
    readers = {"STRING": string_of, "POINT": points_of}
    frames = PoseFrames(["x", "DrillToTracker"])
    for at in range(0, len(content), 700):
        for one in reader.feed(content[at : at + 700], now_s=0.1 * at):
            found.append(one)
            if isinstance(one, Message) and one.type in readers:
                readers[one.type](one.content)
            elif isinstance(one, Message):
                frames.take(one)
    return found


def phone_messages() -> list[bytes]:
    """What a page that sends its camera says; a line with # is a part of an image."""
    jpeg = pictures()[1].hex().encode()
    camera = {
        **{"label": "back", "width_px": 1280, "height_px": 720, "rate_hz": 30.0},
        **{"focus": "fixed", "focus_mm": None, "zoom_percent": 100},
    }
    image = {"bytes": len(jpeg) // 2, "captured_ms": 1000.0, "clock": "capture"}
    lines = [
        json.dumps(one).encode()
        for one in ({"pong": {"ping": 0, "at_ms": 900.0}}, {"camera": camera}, {"image": image})
    ]
    return [b"\n".join([*lines, b"#" + jpeg]), json.dumps({"hello": {"key": "0" * 32}}).encode(), *lines]


def _read_phone(content: bytes) -> object:
    sender, result = Sender(), None
    for number, line in enumerate(content.split(b"\n")[:40]):
        now_s = 1.0 + 0.01 * number
        sender.update_credit(now_s)
        if line.startswith(b"#"):
            try:
                part = bytes.fromhex(line[1:].decode("ascii"))
            except ValueError:
                part = line
            result = sender.take_part(part, now_s)
            continue
        # A socket passes on valid UTF-8 only.
        text = line.decode("utf-8", errors="replace")
        if number == 0 and "hello" in text:
            parse_hello(text)
        else:
            sender.receive_text(text, now_s)
    return result


def scene_messages() -> list[bytes]:
    """Camera messages of the 3-D scene."""
    return [msgspec.msgpack.encode({"type": CAMERA_MESSAGE, "position": [1.0, 2.0, 3.0], "fov": 0.7})]


def _read_scene(content: bytes) -> object:
    return Gate(counts={}).judge(content, now_s=0.0)


def small_texts() -> list[bytes]:
    """Addresses of cameras, tokens and lists of names."""
    return [
        *(
            b"rtsp://user:secret@192.168.0.1:554/a?password=x#t",
            b"http://[::1]:80/x.mjpg",
            b"/dev/video0",
            b"12",
        ),
        *(Token.new().text.encode(), b"29:L3,28:L4, 27 : L5", b"localhost:8000", b"https://[::1]:8443"),
    ]


def _read_small_text(content: bytes) -> object:
    text = content.decode("latin-1")
    mask_secrets(text)
    KnownHosts.of("coaxial.local").has(text)
    is_same_origin(origin=text, host="localhost:8000")
    is_same_origin(origin="http://localhost:8000", host=text)
    Token.read(text)
    for read in (source_from_text, names_from_text):
        try:
            read(text)
        except NavigationError as error:
            check_error(error)
    return None


def check_error(error: NavigationError) -> None:
    """Assert that an error is one for a person: with code, message, and remedy, which can be sent and shown.

    Raises:
        AssertionError: it is not.
    """
    problem = translated_problem(error)
    json.dumps(problem.model_dump(mode="json"), ensure_ascii=False, allow_nan=False).encode()
    str(error).encode()
    complete = error.code.isupper() and error.message.strip() and error.remedy.endswith((".", ")"))
    if not complete:
        raise AssertionError(f"incomplete error: {error!r}")


TARGETS: tuple[Target, ...] = (
    Target(name="ct-slice", seeds=slices, opened=of_file("ct.dcm", _read_ct_file)),
    Target(name="ct-series", seeds=lambda: slices()[:1], opened=series_opened),
    Target(name="ct-zip", seeds=lambda: [_zipped(_other_slices())], opened=of_file("ct.zip", _read_ct_file)),
    Target(name="nifti", seeds=nifti, opened=of_file("ct.nii", _read_ct_file)),
    Target(
        name="nifti-packed",
        seeds=lambda: [nifti_bytes(Volume(hu=HU, lps_from_ijk=AFFINE))],
        opened=of_file("ct.nii.gz", _read_ct_file),
    ),
    Target(name="labels-nifti", seeds=unpacked_labels, opened=of_file("labels", _read_labels)),
    Target(name="labels-seg", seeds=segmentations, opened=of_file("labels", _read_labels)),
    Target(
        name="labels-stored",
        seeds=lambda: [gzip.decompress(label_file_bytes(small_labels()))],
        opened=of_file("labels.nii.gz", lambda path: load_label_file(path, voxel_mm=0.4)),
        wrap=gzip.compress,
    ),
    Target(
        name="mesh-stl",
        seeds=lambda: [binary_stl(), ascii_stl()],
        opened=in_memory(lambda c: mesh_from_bytes(c, file_format="stl")),
    ),
    Target(
        name="mesh-obj",
        seeds=lambda: [obj(), obj(quads=False)],
        opened=in_memory(lambda c: mesh_from_bytes(c, file_format="obj")),
    ),
    Target(
        name="mesh-ply",
        seeds=lambda: [binary_ply(), binary_ply(order="big"), text_ply()],
        opened=in_memory(lambda c: mesh_from_bytes(c, file_format="ply")),
    ),
    Target(name="camera-file", seeds=camera_files, opened=of_file("camera.yaml", read_camera_file)),
    Target(
        name="tool-file",
        seeds=lambda: [text_of_tool_file(tool_file()).encode()],
        opened=of_file("tool.yaml", load_tool_file),
    ),
    Target(
        name="config",
        seeds=configs,
        opened=of_file("config.yaml", lambda path: load_config(path, environment={})),
    ),
    Target(
        name="plate-file",
        seeds=lambda: [text_of_plate_file(printed_plate()).encode()],
        opened=in_memory(lambda c: plate_file_in(c.decode("latin-1"))),
    ),
    Target(name="captures-file", seeds=captures, opened=of_file("captures.yaml", _read_captures)),
    Target(name="poses-text", seeds=poses_as_text, opened=of_file("poses.txt", _read_poses)),
    Target(name="poses-json", seeds=poses_as_json, opened=of_file("poses.json", _read_poses)),
    Target(name="poses-npy", seeds=poses_as_array, opened=of_file("poses.npy", _read_poses)),
    Target(name="poses-npz", seeds=poses_as_archive, opened=of_file("poses.npz", _read_poses)),
    Target(
        name="landmarks",
        seeds=lambda: [b"name,x,y,z\na,1,2,3\nb,4,5,6\n", b"1,5 2,5 3,5\n4,5 5,0 6,0\n", b"0;1;2;3\n1;4;5;6"],
        opened=of_file("points.txt", read_landmarks),
    ),
    Target(
        name="columns",
        seeds=lambda: [b"x,y,z\n1,2,3\n4,5,6\n", b'"x"\ty\tz\n1\t2\t3\n'],
        opened=of_file("points.csv", lambda path: read_columns(path, ("x", "y", "z"))),
    ),
    Target(name="markups", seeds=markups, opened=in_memory(_read_markups)),
    Target(
        name="transform",
        seeds=transforms,
        opened=in_memory(lambda c: fixed_from_moving_in_itk(c, name="a.tfm")),
    ),
    Target(
        name="picture",
        seeds=pictures,
        opened=in_memory(lambda c: (jpeg_size_wh_px(c), decoded(c), marker_image(c, named="a"))),
        wrap=_png_chunks,
    ),
    Target(name="archive", seeds=archives, opened=store_opened),
    Target(name="archive-texts", seeds=archive_texts, opened=store_opened, wrap=archive_with),
    Target(
        name="recording", seeds=recordings, opened=of_file("a.mcap", _read_recording), wrap=without_checksums
    ),
    Target(
        name="recording-messages",
        seeds=recorded_messages,
        opened=of_file("a.mcap", _read_recording),
        wrap=recording_of,
    ),
    Target(
        name="recorded-state",
        seeds=recorded_states,
        opened=in_memory(_read_recorded_state),
        expected=(CodecError,),
    ),
    Target(name="recording-index", seeds=indexes, opened=of_file("a.mcap.index.npz", _read_index)),
    Target(name="certificate", seeds=certificates, opened=in_memory(verified)),
    Target(name="certificate-signed", seeds=certificate_contents, opened=in_memory(verified), wrap=signed),
    Target(name="people-file", seeds=people, opened=of_file("people.json", read_people)),
    Target(name="audit-log", seeds=audit_logs, opened=of_file("audit.jsonl", _read_audit_log)),
    Target(name="openigtlink", seeds=openigtlink, opened=in_memory(_read_openigtlink), expected=(WireError,)),
    Target(name="phone", seeds=phone_messages, opened=in_memory(_read_phone), expected=(ProtocolViolation,)),
    Target(name="scene", seeds=scene_messages, opened=in_memory(_read_scene)),
    Target(name="texts", seeds=small_texts, opened=in_memory(_read_small_text)),
)
