"""Documents of a case: versions, what they depend on, and whether they are valid."""

import math
import sqlite3
import threading
from collections.abc import Callable

import pytest

from server.store import (
    CaseStore,
    Current,
    Document,
    DocumentKind,
    NewDocument,
    NotFound,
    OutOfDate,
    OutOfDateError,
    StoreConflict,
    StoreError,
)
from server.texts import Language
from tracker.errors import InvalidInput

CT, PLAN, REGISTRATION = DocumentKind.CT, DocumentKind.PLAN, DocumentKind.REGISTRATION


@pytest.fixture
def case_id(store: CaseStore) -> str:
    return store.create("one").id


@pytest.fixture
def put(store: CaseStore, case_id: str) -> Callable[..., Document]:
    def put(kind: DocumentKind, name: str = "main", *on: Document, **content: object) -> Document:
        return store.put(case_id, kind, name, content, made_by="ito", depends_on=[one.id for one in on])

    return put


Put = Callable[..., Document]


def test_what_was_put_is_read_back_whole(store: CaseStore, case_id: str) -> None:
    content = {"text": "Größe 😀", "list": [1, 2.5, None, True], "deep": {"a": {"b": [[]]}}, "tiny": 5e-324}
    put = store.put(case_id, PLAN, "L3/left 🦴", content, made_by="ito")
    read = store.document(case_id, put.id)
    assert read == put
    assert read.content == content
    assert (read.version, read.name, read.made_by) == (1, "L3/left 🦴", "ito")
    assert read.made_at == "2026-11-21T08:00:00.252Z"


def test_versions_count_by_kind_and_name_and_the_last_is_the_latest(store: CaseStore, put: Put) -> None:
    documents = [put(PLAN, "a", n=1), put(PLAN, "a", n=2), put(PLAN, "b", n=3), put(CT, "a", n=4)]
    assert [one.version for one in documents] == [1, 2, 1, 1]
    case_id = documents[0].case_id
    assert store.latest(case_id, PLAN, "a") == documents[1]
    assert store.history(case_id, PLAN, "a") == tuple(documents[:2])
    assert store.all(case_id, PLAN) == (documents[1], documents[2])
    assert store.latest(case_id, PLAN, "c") is None


def reason_of(store: CaseStore, document: Document, language: Language = "en") -> str:
    validity = store.validity(document)
    assert isinstance(validity, OutOfDate)
    return validity.why.message[language]


def test_a_new_plan_puts_what_was_registered_on_the_old_one_out_of_date(store: CaseStore, put: Put) -> None:
    ct = put(CT)
    plan = put(PLAN, "L3", ct)
    registration = put(REGISTRATION, "main", plan)
    check = put(DocumentKind.CHECK, "landmark", registration)
    assert [store.validity(one) for one in (ct, plan, registration, check)] == [Current()] * 4
    newer = put(PLAN, "L3", ct)
    assert store.validity(newer) == Current()
    assert reason_of(store, plan) == "plan 'L3' version 1 was replaced by version 2"
    replaced = "it depends on plan 'L3' version 1, which was replaced by version 2"
    assert reason_of(store, registration) == replaced
    assert reason_of(store, check) == replaced
    validities = {entry.heading.id: entry.validity for entry in store.outline(ct.case_id)}
    assert validities == {one.id: store.validity(one) for one in (ct, plan, newer, registration, check)}


def test_a_withdrawal_invalidates_dependent_documents_and_restores_no_older_version(
    store: CaseStore, put: Put
) -> None:
    old, ct = put(CT), put(CT)
    plan = put(PLAN, "L3", ct)
    withdrawn = store.withdraw(ct, by="ito", reason="another patient")
    assert withdrawn.withdrawn is not None
    assert store.withdraw(ct, by="abe", reason="again") == withdrawn
    assert store.latest(ct.case_id, CT, "main") is None
    assert store.all(ct.case_id, CT) == ()
    assert reason_of(store, old) == "ct 'main' version 1 was replaced by version 2"
    withdrawn_ct = "it depends on ct 'main' version 2, which was withdrawn by ito: another patient"
    assert reason_of(store, plan) == withdrawn_ct
    german = "beruht auf CT „main“ Version 2, zurückgezogen von ito: another patient"
    assert reason_of(store, plan, "de") == german
    assert put(CT).version == 3


def test_the_reason_is_found_through_either_of_two_ways(store: CaseStore, put: Put) -> None:
    camera, plan = put(DocumentKind.CAMERA), put(PLAN)
    registration = put(REGISTRATION, "main", plan, camera)
    check = put(DocumentKind.CHECK, "a", camera, registration)
    put(DocumentKind.CAMERA)
    replaced = "it depends on camera 'main' version 1, which was replaced by version 2"
    assert reason_of(store, check) == replaced


def test_a_step_gets_only_what_holds(store: CaseStore, put: Put, case_id: str) -> None:
    with pytest.raises(OutOfDateError) as missing:
        store.current(case_id, PLAN, "L3")
    assert (missing.value.code, missing.value.message) == ("DOCUMENT_MISSING", "there is no plan 'L3'")
    ct = put(CT)
    plan = put(PLAN, "L3", ct)
    assert store.current(case_id, PLAN, "L3") == plan
    put(CT)
    with pytest.raises(
        OutOfDateError, match=r"plan 'L3' is out of date: it depends on ct 'main' version 1"
    ) as old:
        store.current(case_id, PLAN, "L3")
    assert old.value.code == "DOCUMENT_OUT_OF_DATE"


def test_only_the_newest_valid_documents_are_found(store: CaseStore, put: Put, case_id: str) -> None:
    assert store.find_current(case_id, PLAN, "L3") is None
    ct = put(CT)
    put(PLAN, "L3", ct)
    plan, other = put(PLAN, "L3", ct), put(PLAN, "L4")
    assert store.find_current(case_id, PLAN, "L3") == plan
    assert store.all_current(case_id, PLAN) == (plan, other)
    # The newest plan of L3 depends on a replaced CT, and the older one is not used in its place.
    put(CT)
    assert store.find_current(case_id, PLAN, "L3") is None
    assert store.all_current(case_id, PLAN) == (other,)
    store.withdraw(other, by="M. Ito", reason="wrong level")
    assert store.all_current(case_id, PLAN) == ()


@pytest.mark.parametrize("expected", [0, 1, 3])
def test_a_change_made_on_another_version_is_rejected_with_both_numbers(
    store: CaseStore, put: Put, case_id: str, expected: int
) -> None:
    put(PLAN, "L3"), put(PLAN, "L3")
    with pytest.raises(
        StoreConflict, match=f"is at version 2, but the change was made on version {expected}"
    ):
        store.put(case_id, PLAN, "L3", {}, made_by="ito", expected_version=expected)
    assert len(store.history(case_id, PLAN, "L3")) == 2
    assert store.put(case_id, PLAN, "L3", {}, made_by="ito", expected_version=2).version == 3


@pytest.mark.parametrize(
    ("content", "said"),
    [
        pytest.param({"a": {"b": [1.0, math.nan]}}, r"at a\.b\[1\] it is nan", id="nan"),
        pytest.param({"a": -math.inf}, r"at a it is -inf", id="infinity"),
        pytest.param({"a": {1: 2}}, r"its key 1 is a int", id="number-as-key"),
        pytest.param({"a": b"x"}, r"it is a bytes", id="bytes"),
        pytest.param({"a": object()}, r"it is a object", id="object"),
        pytest.param({"a": "\ud800"}, r"surrogates not allowed", id="half-a-letter"),
        pytest.param([1], r"it is a list, not a mapping", id="no-mapping"),
    ],
)
def test_what_json_cannot_say_is_rejected(store: CaseStore, case_id: str, content: object, said: str) -> None:
    with pytest.raises(InvalidInput, match=said) as rejected:
        store.put(case_id, PLAN, "a", content, made_by="ito")  # pyrefly: ignore[bad-argument-type]  # wrong on purpose
    assert rejected.value.code == "CONTENT_NOT_JSON"
    assert store.history(case_id, PLAN, "a") == ()


def test_a_bottomless_and_a_huge_content_are_rejected(store: CaseStore, case_id: str) -> None:
    deep: dict[str, object] = {}
    for _ in range(10_000):
        deep = {"a": deep}
    with pytest.raises(InvalidInput, match="more than 64 levels deep"):
        store.put(case_id, PLAN, "a", deep, made_by="ito")
    with pytest.raises(InvalidInput, match=r"has 17\.0 MB, the maximum is 16 MB"):
        store.put(case_id, PLAN, "a", {"a": "x" * 17 * 2**20}, made_by="ito")


@pytest.mark.parametrize("name", ["", "   ", "a\nb", "a\0b", "x" * 201, "\ud800"])
def test_an_unreadable_name_is_rejected(store: CaseStore, case_id: str, name: str) -> None:
    with pytest.raises(InvalidInput) as rejected:
        store.put(case_id, PLAN, name, {}, made_by="ito")
    assert rejected.value.code == "NAME_INVALID"


def test_documents_stand_only_on_documents_of_their_own_case(store: CaseStore, put: Put) -> None:
    ct = put(CT)
    other = store.create("two").id
    with pytest.raises(NotFound, match=f"there is no document {ct.id} in the case {other}"):
        store.put(other, PLAN, "a", {}, made_by="ito", depends_on=[ct.id])
    assert store.all(other, PLAN) == ()


def test_no_document_depends_on_the_patients_identity(store: CaseStore, put: Put, case_id: str) -> None:
    patient = put(DocumentKind.PATIENT)
    with pytest.raises(InvalidInput) as rejected:
        store.put(case_id, PLAN, "a", {}, made_by="ito", depends_on=[patient.id])
    assert rejected.value.code == "DEPENDS_ON_IDENTITY"


def test_a_readers_change_of_a_content_affects_no_other(store: CaseStore, put: Put) -> None:
    document = put(PLAN, "a", numbers=[1])
    document.content["numbers"].append(2)  # pyrefly: ignore[missing-attribute]  # a list, as JSON has it
    assert store.document(document.case_id, document.id).content == {"numbers": [1]}


def test_writers_in_many_threads_get_a_version_each(store: CaseStore, case_id: str) -> None:
    gate = threading.Barrier(8)

    def write(who: int) -> None:
        gate.wait()
        for n in range(5):
            store.put(case_id, PLAN, "L3", {"who": who, "n": n}, made_by="ito")

    threads = [threading.Thread(target=write, args=(who,)) for who in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    versions = store.history(case_id, PLAN, "L3")
    assert [one.version for one in versions] == list(range(1, 41))
    assert {(one.content["who"], one.content["n"]) for one in versions} == {
        (who, n) for who in range(8) for n in range(5)
    }


def test_what_is_stored_with_a_document_is_seen_with_it_or_not_at_all(store: CaseStore, case_id: str) -> None:
    seen: list[list[bool]] = []

    def look() -> None:
        seen.append([store.latest(case_id, PLAN, name) is not None for name in ("main", "choice")])

    def choice_on(plan: Document) -> list[NewDocument]:
        # Another connection, while the transaction is open: neither is there.
        look()
        return [NewDocument.validated(PLAN, "choice", {"n": 1}, made_by="ito", depends_on=[plan.id])]

    store.add_commit_listener(look)
    plan = store.put(case_id, PLAN, "main", {}, made_by="ito", companions=choice_on)
    assert seen == [[False, False], [True, True]]
    choice = store.latest(case_id, PLAN, "choice")
    assert choice is not None
    assert choice.depends_on == (plan.id,)


def test_what_cannot_be_stored_with_a_document_keeps_it_out_too(store: CaseStore, case_id: str) -> None:
    def stranger(_plan: Document) -> list[NewDocument]:
        return [NewDocument.validated(PLAN, "choice", {}, made_by="ito", depends_on=["not a document"])]

    with pytest.raises(NotFound):
        store.put(case_id, PLAN, "main", {}, made_by="ito", companions=stranger)
    assert store.latest(case_id, PLAN, "main") is None


def test_a_content_that_the_disk_changed_is_reported_and_other_cases_are_read(
    store: CaseStore, case_id: str
) -> None:
    document = store.put(case_id, DocumentKind.PLAN, "a", {"number": 12345}, made_by="ito")
    other = store.create("other").id
    sound = store.put(other, DocumentKind.PLAN, "a", {"number": 1}, made_by="ito")
    with sqlite3.connect(store.home.database) as database:
        # A disk asks no trigger.
        for (name,) in database.execute("SELECT name FROM sqlite_master WHERE type = 'trigger'").fetchall():
            database.execute(f"DROP TRIGGER {name}")
        database.execute("UPDATE documents SET content = '{\"number\": 12C45}' WHERE id = ?", (document.id,))
    database.close()
    with pytest.raises(StoreError) as reported:
        store.document(case_id, document.id)
    assert reported.value.code == "DOCUMENT_DAMAGED"
    assert document.id in reported.value.message
    assert store.document(other, sound.id).content == {"number": 1}
