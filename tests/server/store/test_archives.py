"""A case exported and imported: identical, or not at all."""

import contextlib
import hashlib
import json
import stat
import zipfile
from collections.abc import Callable, Sequence
from dataclasses import replace
from datetime import datetime
from pathlib import Path

import pytest

from server.clock import utc_text
from server.disk import DiskFull
from server.store import (
    Case,
    CaseStore,
    Change,
    DocumentKind,
    Entry,
    Home,
    OutOfDate,
    StoreConflict,
    StoreError,
)
from server.store.records import SAYS_ARCHIVE
from tests.server.store.test_damaged_rows import damage
from tracker.errors import InvalidInput

PATIENT = "Beeblebrox"


@pytest.fixture
def case(store: CaseStore) -> Case:
    """A case with a file, a replaced plan, a withdrawn check, and a patient."""
    case = store.create(PATIENT)
    store.put(case.id, DocumentKind.PATIENT, "main", {"name": PATIENT}, made_by="ito")
    with store.new_file(case.id, ".nii.gz") as new:
        new.path.write_bytes(bytes(range(256)) * 5000)
    ct = store.put(case.id, DocumentKind.CT, "main", {"mm": 0.1 + 0.2}, made_by="ito", files=[new.stored.id])
    plan = store.put(case.id, DocumentKind.PLAN, "L3 😀", {}, made_by="abe", depends_on=[ct.id])
    check = store.put(case.id, DocumentKind.CHECK, "tip", {}, made_by="abe", depends_on=[plan.id, ct.id])
    store.put(case.id, DocumentKind.PLAN, "L3 😀", {}, made_by="abe", depends_on=[ct.id])
    store.withdraw(check, by="abe", reason="moved")
    return case


def parts_of(archive: Path) -> dict[str, bytes]:
    with zipfile.ZipFile(archive) as read:
        return {name: read.read(name) for name in read.namelist()}


def written(folder: Path, parts: dict[str, bytes], *, fix_manifest: bool = True) -> Path:
    """An archive of these parts, with a consistent manifest."""
    if fix_manifest:
        manifest = json.loads(parts["manifest.json"])
        manifest["parts"] = [
            {"path": path, "size_bytes": len(part), "sha256": hashlib.sha256(part).hexdigest()}
            for path, part in parts.items()
            if path != "manifest.json"
        ]
        parts = {**parts, "manifest.json": json.dumps(manifest).encode()}
    path = folder / "changed.zip"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, part in parts.items():
            archive.writestr(name, part)
    return path


def test_a_case_comes_back_as_it_was(store: CaseStore, case: Case) -> None:
    archive = store.export_case(case.id, with_identity=True)
    again = store.import_archive(archive.path, by="M. Ito")
    assert again.id != case.id
    assert (again.name, again.created_at, again.copied_from) == (PATIENT, case.created_at, case.id)

    def comparable(entries: tuple[Entry, ...]) -> str:
        """Documents without the case that they belong to and were imported into."""
        reported = repr([(replace(one.heading, imported=None), one.validity) for one in entries])
        return reported.replace(case.id, "").replace(again.id, "").replace(SAYS_ARCHIVE, "")

    assert comparable(store.outline(again.id)) == comparable(store.outline(case.id))
    assert store.latest(again.id, DocumentKind.CT, "main").content == {"mm": 0.1 + 0.2}  # pyrefly: ignore[missing-attribute]  # there
    assert store.verify(again.id) == ()
    before, after = store.files(case.id)[0], store.files(again.id)[0]
    assert (before.id, before.sha256) == (after.id, after.sha256)
    assert after.path.read_bytes() == bytes(range(256)) * 5000
    newer = store.put(again.id, DocumentKind.CT, "main", {}, made_by="ito")
    plan = store.latest(again.id, DocumentKind.PLAN, "L3 😀")
    assert newer.version == 2
    assert plan is not None
    assert isinstance(store.validity(plan), OutOfDate)


def test_what_came_in_never_looks_as_if_somebody_here_had_made_it(
    store: CaseStore, case: Case, clock: Callable[[], datetime]
) -> None:
    """An archive may name anybody as the author of its documents and withdrawals."""
    taken_at = utc_text(clock())
    again = store.import_archive(store.export_case(case.id).path, by="M. Ito")
    came = [one.heading for one in store.outline(again.id)]
    assert {(one.made_by, one.maker) for one in came} == {
        ("ito", "ito, says the archive"),
        ("abe", "abe, says the archive"),
    }
    assert [one.imported.by for one in came if one.imported is not None] == ["M. Ito"] * len(came)
    assert all(one.imported is not None and one.imported.at > taken_at for one in came)
    (withdrawn,) = [one.withdrawn for one in came if one.withdrawn is not None]
    assert withdrawn.by == "abe, says the archive"
    plan = store.latest(again.id, DocumentKind.PLAN, "L3 😀")
    assert plan is not None
    assert plan.makers == ("abe", "M. Ito")
    # Documents made after the import were made here, also if based on imported ones.
    made = store.put(again.id, DocumentKind.CHECK, "tip", {}, made_by="abe", depends_on=[plan.id])
    assert (made.imported, made.maker, made.makers) == (None, "abe", ("abe",))
    assert [one.heading.maker for one in store.outline(case.id) if one.heading.imported is None][:1] == [
        "ito"
    ]


def test_imported_twice_it_is_noted_once_with_the_last_importer(store: CaseStore, case: Case) -> None:
    first = store.import_archive(store.export_case(case.id).path, by="M. Ito")
    second = store.import_archive(store.export_case(first.id).path, by="Dr Sato")
    check = store.history(second.id, DocumentKind.CHECK, "tip")[0]
    assert (check.maker, check.withdrawn and check.withdrawn.by) == ("abe, says the archive",) * 2
    assert check.imported is not None
    assert check.imported.by == "Dr Sato"


def test_who_takes_a_case_in_is_in_the_log_of_changes(store: CaseStore, case: Case) -> None:
    changes: list[Change] = []
    store.set_change_listener(changes.append)
    store.import_archive(store.export_case(case.id).path, by="M. Ito")
    assert [(one.after, one.by) for one in changes] == [("copied in", "M. Ito")]


def test_who_the_patient_is_stays_at_home_unless_asked_for(store: CaseStore, case: Case) -> None:
    archive = store.export_case(case.id)
    assert not any(PATIENT.encode() in part for part in parts_of(archive.path).values())
    assert PATIENT not in archive.path.name
    again = store.import_archive(archive.path, by="M. Ito")
    assert again.name == f"Case {case.id[:6]}"
    assert store.all(again.id, DocumentKind.PATIENT) == ()
    assert len(store.outline(again.id)) == len(store.outline(case.id)) - 1


def changed_line(parts: dict[str, bytes], number: int, **changes: object) -> None:
    lines = parts["documents.jsonl"].splitlines()
    lines[number] = json.dumps({**json.loads(lines[number]), **changes}).encode()
    parts["documents.jsonl"] = b"\n".join(lines) + b"\n"


def changed_manifest(parts: dict[str, bytes], **changes: object) -> None:
    parts["manifest.json"] = json.dumps({**json.loads(parts["manifest.json"]), **changes}).encode()


def file_of(parts: dict[str, bytes]) -> str:
    return next(name for name in parts if name.startswith("files/"))


def change_file(parts: dict[str, bytes], change: Callable[[bytes], bytes]) -> None:
    parts[file_of(parts)] = change(parts[file_of(parts)])


def first_id(parts: dict[str, bytes]) -> object:
    return json.loads(parts["documents.jsonl"].split(b"\n")[0])["id"]


def stated(
    parts: dict[str, bytes], *, documents: Sequence[str] = (), files: Sequence[str] = (), name: str = "L3"
) -> object:
    """What a manifest states as missing."""
    del parts
    plan = {"kind": "plan", "name": name, "version": 1}
    return {
        "documents": [{"id": one, **plan} for one in documents],
        "files": [{"id": one, "size_bytes": 1, "sha256": "", "problem": ""} for one in files],
    }


Damaging = Callable[[dict[str, bytes]], object]
AGREEING: list[tuple[str, Damaging, str]] = [
    ("traversal", lambda parts: parts.update({"../../evil": b"x"}), "does not belong to a case"),
    ("absolute", lambda parts: parts.update({"/etc/evil": b"x"}), "does not belong to a case"),
    ("in-a-folder", lambda parts: parts.update({"files/../case.json": b"x"}), "does not belong"),
    (
        "a-file-more",
        lambda parts: parts.update({"files/0123456789abcdef.bin": b"x"}),
        "not those listed in case",
    ),
    ("a-file-less", lambda parts: parts.pop(file_of(parts)), "not those listed in case.json"),
    ("no-documents", lambda parts: parts.pop("documents.jsonl"), "documents.jsonl is missing"),
    ("no-case", lambda parts: parts.pop("case.json"), "case.json is missing"),
    ("cut-documents", lambda parts: parts.update({"documents.jsonl": b'{"id"'}), "inside a line"),
    ("no-json", lambda parts: parts.update({"documents.jsonl": b"{]\n"}), "documents.jsonl, line 1"),
    ("deep-json", lambda parts: parts.update({"case.json": b"[" * 10**6}), "case.json: "),
    ("unknown-kind", lambda parts: changed_line(parts, 0, kind="spell"), "line 1: kind"),
    ("unknown-key", lambda parts: changed_line(parts, 0, spell=1), "line 1: spell"),
    ("nan", lambda parts: changed_line(parts, 0, content={"a": float("nan")}), "it is nan"),
    ("name-with-controls", lambda parts: changed_line(parts, 0, name="a\nb"), "control characters"),
    ("version-missing", lambda parts: changed_line(parts, 0, version=2), "has version 2, but not version 1"),
    ("same-id", lambda parts: changed_line(parts, 1, id=first_id(parts)), "two documents"),
    ("stands-on-nothing", lambda parts: changed_line(parts, 0, stands_on=["0" * 16]), "does not precede it"),
    (
        "strange-file",
        lambda parts: changed_line(parts, 0, files=["0" * 16 + ".bin"]),
        "missing or duplicate files",
    ),
    (
        "newer",
        lambda parts: changed_manifest(parts, version=3, more=1),
        "format version 3, but this Coaxial reads version 2",
    ),
    (
        "missing-and-there",
        lambda parts: changed_manifest(parts, missing=stated(parts, files=[file_of(parts)[6:]])),
        "states as missing is there",
    ),
    (
        "missing-twice",
        lambda parts: changed_manifest(parts, missing=stated(parts, documents=["0" * 16] * 2)),
        "a document as missing twice",
    ),
    (
        "missing-name-of-controls",
        lambda parts: changed_manifest(parts, missing=stated(parts, documents=["0" * 16], name="a\nb")),
        "control characters",
    ),
    ("other-format", lambda parts: changed_manifest(parts, format="recipe"), "manifest.json: format"),
]
DISAGREEING: list[tuple[str, Damaging, str]] = [
    ("changed-file", lambda parts: change_file(parts, lambda part: part[::-1]), "SHA-256 differs"),
    ("longer-file", lambda parts: change_file(parts, lambda part: part + b"x"), "manifest states"),
    ("changed-case", lambda parts: parts.update({"case.json": parts["case.json"][::-1]}), "SHA-256"),
    ("no-manifest", lambda parts: parts.pop("manifest.json"), "it is not a case"),
    ("manifest-of-nonsense", lambda parts: parts.update({"manifest.json": b"\xff\xfe"}), "not valid JSON"),
    ("deep-manifest", lambda parts: parts.update({"manifest.json": b"[" * 10**6}), "not valid JSON"),
]
CHANGES = [(name, change, said, True) for name, change, said in AGREEING] + [
    (name, change, said, False) for name, change, said in DISAGREEING
]


def everything_in(home: Home) -> set[Path]:
    return {path for path in home.folder.rglob("*") if "sqlite3-" not in path.name}


@pytest.mark.parametrize(
    ("change", "said", "agreeing"), [row[1:] for row in CHANGES], ids=[row[0] for row in CHANGES]
)
def test_a_hostile_archive_is_rejected_whole(
    store: CaseStore, home: Home, case: Case, tmp_path: Path, change: Damaging, said: str, *, agreeing: bool
) -> None:
    parts = parts_of(store.export_case(case.id, with_identity=True).path)
    # The patient's line comes first and is not compared.
    parts["documents.jsonl"] = parts["documents.jsonl"].split(b"\n", 1)[1]
    if not agreeing:
        parts = parts_of(written(tmp_path, parts))
    change(parts)
    before = everything_in(home)
    with pytest.raises(InvalidInput) as rejected:
        store.import_archive(written(tmp_path, parts, fix_manifest=agreeing), by="M. Ito")
    assert said in rejected.value.message
    assert rejected.value.code == ("ARCHIVE_NEWER" if "reads version" in said else "ARCHIVE_INVALID")
    assert everything_in(home) == before
    assert store.list() == (store.get(case.id),)


@pytest.mark.parametrize("content", [b"", b"PK\x03\x04", b"no zip at all" * 100])
def test_what_is_no_zip_is_rejected(store: CaseStore, tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "a.zip"
    path.write_bytes(content)
    with pytest.raises(InvalidInput, match="not a valid zip file"):
        store.import_archive(path, by="M. Ito")


def test_an_archive_cut_or_changed_anywhere_is_rejected(store: CaseStore, case: Case, tmp_path: Path) -> None:
    whole = store.export_case(case.id).path.read_bytes()
    path = tmp_path / "a.zip"
    for n in range(0, len(whole), len(whole) // 40):
        for changed in (whole[:n], whole[:n] + bytes([whole[n] ^ 0x55]) + whole[n + 1 :]):
            path.write_bytes(changed)
            with contextlib.suppress(InvalidInput):
                # The byte may be insignificant, such as a time inside the zip.
                taken = store.import_archive(path, by="M. Ito")
                assert store.verify(taken.id) == ()
                assert len(store.outline(taken.id)) == 4


def test_a_bomb_is_rejected_before_it_is_unpacked(
    store: CaseStore, home: Home, case: Case, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    parts = parts_of(store.export_case(case.id).path)
    path = written(tmp_path, parts | {file_of(parts): b"\0" * 2**24})
    assert path.stat().st_size < 2**17
    monkeypatch.setattr("server.store.archive.reader.MAX_UNPACKED_BYTES", 2**23)
    with pytest.raises(InvalidInput, match="it unpacks to"):
        store.import_archive(path, by="M. Ito")
    assert [one.name for one in home.cases.iterdir()] == [case.id]


def test_a_link_in_an_archive_is_rejected(store: CaseStore, case: Case, tmp_path: Path) -> None:
    parts = parts_of(store.export_case(case.id).path)
    path = written(tmp_path, parts)
    with zipfile.ZipFile(path, "w") as archive:
        for name, part in parts.items():
            entry = zipfile.ZipInfo(name)
            if name.startswith("files/"):
                entry.external_attr = (stat.S_IFLNK | 0o777) << 16
            archive.writestr(entry, part)
    with pytest.raises(InvalidInput, match="does not belong"):
        store.import_archive(path, by="M. Ito")


def test_a_case_without_room_is_rejected_before_it_is_unpacked(
    store: CaseStore, case: Case, monkeypatch: pytest.MonkeyPatch
) -> None:
    archive = store.export_case(case.id)
    monkeypatch.setattr("server.disk.RESERVED_BYTES", 2**60)
    with pytest.raises(DiskFull) as full:
        store.import_archive(archive.path, by="M. Ito")
    assert full.value.code == "STORE_FULL"
    assert store.list() == (store.get(case.id),)


def test_a_damaged_file_is_not_copied_out(store: CaseStore, home: Home, case: Case) -> None:
    path = store.files(case.id)[0].path
    path.chmod(0o600)
    path.write_bytes(b"other bytes")
    with pytest.raises(StoreError, match="SHA-256 differs") as damaged:
        store.export_case(case.id)
    assert damaged.value.code == "FILE_DAMAGED"
    path.unlink()
    with pytest.raises(StoreError, match="it is missing"):
        store.export_case(case.id)
    assert list(home.temporary.iterdir()) == []


def test_what_is_intact_is_copied_out_on_request_and_what_is_missing_stays_named(
    store: CaseStore, home: Home, case: Case
) -> None:
    lost_file = store.files(case.id)[0]
    with store.new_file(case.id, ".bin") as new:
        new.path.write_bytes(b"intact")
    tool = store.put(case.id, DocumentKind.TOOL, "drill", {"mm": 1}, made_by="ito", files=[new.stored.id])
    (plan, _), (check,) = (
        store.history(case.id, *of) for of in ((DocumentKind.PLAN, "L3 😀"), (DocumentKind.CHECK, "tip"))
    )
    damage(home, "UPDATE documents SET content = '{\"a\":1}' WHERE id = ?", plan.id)
    lost_file.path.chmod(0o600)
    lost_file.path.write_bytes(b"other bytes")
    with pytest.raises(StoreError, match="damaged"):
        store.export_case(case.id)
    archive = store.export_case(case.id, without_damaged=True)
    assert archive.missing == 2
    parts = parts_of(archive.path)
    assert not any(b"other bytes" in part or b'{"a": 1}' in part for part in parts.values())
    manifest = json.loads(parts["manifest.json"])
    assert (manifest["version"], manifest["missing"]) == (
        2,
        {
            "documents": [{"id": plan.id, "kind": "plan", "name": "L3 😀", "version": 1}],
            "files": [
                {
                    "id": lost_file.id,
                    "size_bytes": 1280000,
                    "sha256": lost_file.sha256,
                    "problem": f"the file {lost_file.id} has 11 bytes, but was stored with 1280000",
                }
            ],
        },
    )
    changes: list[Change] = []
    store.set_change_listener(changes.append)
    again = store.import_archive(archive.path, by="M. Ito")
    assert [one.after for one in changes] == ["copied in, without 2 damaged documents and files"]
    assert [(one.file_id, one.problem, one.documents[0]["en"]) for one in store.verify(again.id)] == [
        (lost_file.id, "missing", "ct 'main' version 1"),
        (plan.id, "document", "plan 'L3 😀' version 1"),
    ]
    assert store.document(again.id, tool.id).content == {"mm": 1}
    assert store.file(again.id, new.stored.id).path.read_bytes() == b"intact"
    outdated = store.validity(store.document(again.id, check.id))
    assert isinstance(outdated, OutOfDate)
    with pytest.raises(StoreError):
        store.file(again.id, lost_file.id)
    # It is not handed on as complete from there either.
    with pytest.raises(StoreError, match="damaged"):
        store.export_case(again.id)
    handed_on = json.loads(parts_of(store.export_case(again.id, without_damaged=True).path)["manifest.json"])
    assert handed_on["missing"]["documents"] == manifest["missing"]["documents"]
    assert handed_on["missing"]["files"][0]["sha256"] == lost_file.sha256


def test_a_complete_case_can_be_read_by_earlier_programs(store: CaseStore, case: Case) -> None:
    archive = store.export_case(case.id, without_damaged=True)
    manifest = json.loads(parts_of(archive.path)["manifest.json"])
    assert (archive.missing, manifest["version"], "missing" in manifest) == (0, 1, False)


def test_a_case_is_not_deleted_while_it_is_copied_out(
    store: CaseStore, case: Case, monkeypatch: pytest.MonkeyPatch
) -> None:
    rejections: list[str] = []

    def all_files(*requested: object) -> tuple[()]:
        del requested
        with pytest.raises(StoreConflict) as rejected:
            store.delete(case.id, confirm=PATIENT)
        rejections.append(rejected.value.code)
        return ()

    monkeypatch.setattr("server.store.archive.packing.all_files", all_files)
    # Inside the read transaction a writer of the same thread must not wait for itself.
    store.export_case(case.id)
    assert rejections == ["CASE_IN_USE"]
    store.delete(case.id, confirm=PATIENT)
