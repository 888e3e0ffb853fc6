"""The ring between the processes: newest wins, and no image is torn."""

import multiprocessing
import os
from multiprocessing.connection import Connection

import numpy as np
import pytest

from server.errors import CaptureError
from server.loop.ring import LOCK, SLOTS, ImageRing


def image(level: int, size: int = 40) -> np.ndarray:
    return np.full((size, size, 3), level % 256, dtype=np.uint8)


@pytest.fixture
def ring() -> ImageRing:
    return ImageRing(image_bytes=600 * 600 * 3)


def test_what_was_written_last_is_read(ring: ImageRing) -> None:
    assert ring.newest() is None
    for number in range(1, 11):
        ring.write(b"n%d" % number, image(number))
    entry = ring.newest()
    assert entry is not None
    assert (entry.sequence, entry.payload) == (10, b"n10")
    assert entry.image is not None
    assert np.array_equal(entry.image, image(10))
    assert ring.newest(after=10) is None
    assert ring.images == 10


def test_a_note_may_come_without_an_image(ring: ImageRing) -> None:
    ring.write(b"a", image(1))
    ring.write(b"b")
    entry = ring.newest()
    assert entry is not None
    assert (entry.payload, entry.image) == (b"b", None)
    assert ring.images == 1
    assert ring.written_at_s > 0.0


def test_the_size_of_the_image_may_change(ring: ImageRing) -> None:
    for size in (40, 200, 16):
        ring.write(b"", image(size, size))
        entry = ring.newest()
        assert entry is not None
        assert entry.image is not None
        assert np.array_equal(entry.image, image(size, size))


def test_an_image_read_stays_as_it_was_when_its_slot_is_written_again(ring: ImageRing) -> None:
    ring.write(b"", image(1))
    entry = ring.newest()
    for number in range(2, 2 + SLOTS):
        ring.write(b"", image(number))
    assert entry is not None
    assert entry.image is not None
    assert np.array_equal(entry.image, image(1))


def test_a_slot_whose_writer_died_half_way_is_passed_over(ring: ImageRing) -> None:
    ring.write(b"whole", image(1))
    ring.write(b"half", image(2))
    ring._heads[2 % SLOTS][LOCK] += 1  # as between the two marks of a write
    entry = ring.newest()
    assert entry is not None
    assert entry.payload == b"whole"


def test_a_slot_written_over_while_it_is_read_is_not_given(
    ring: ImageRing, monkeypatch: pytest.MonkeyPatch
) -> None:
    ring.write(b"1", image(1))
    copied = ring._copied
    calls: list[int] = []

    def copied_too_slowly(slot: int, sequence: int) -> object:
        entry = copied(slot, sequence)
        if not calls:
            calls.append(slot)
            for number in range(2, 2 + SLOTS):
                ring.write(b"%d" % number, image(number))
        return entry

    monkeypatch.setattr(ring, "_copied", copied_too_slowly)
    entry = ring.newest()
    assert entry is not None
    assert entry.payload == b"%d" % (1 + SLOTS)
    assert entry.image is not None
    assert np.array_equal(entry.image, image(1 + SLOTS))


def test_an_image_too_large_is_rejected_with_both_sizes(ring: ImageRing) -> None:
    with pytest.raises(CaptureError) as caught:
        ring.write(b"", np.zeros((601, 600, 3), dtype=np.uint8))
    assert caught.value.code == "IMAGE_TOO_LARGE"
    assert "600x601" in caught.value.message
    with pytest.raises(ValueError, match="payload"):
        ring.write(b"x" * 300_000)


def write_many(ring: ImageRing, done: Connection) -> None:
    """Runs in a child: writes one grey level per image, so fast that the reader is always behind."""
    number = 0
    while not done.poll():
        number += 1
        ring.write(b"%d" % number, image(number, 600))


def test_images_of_another_process_are_never_torn(ring: ImageRing) -> None:
    context = multiprocessing.get_context("forkserver")
    child_end, own_end = context.Pipe(duplex=False)
    process = context.Process(target=write_many, args=(ring, child_end), daemon=True)
    process.start()
    after, read = 0, 0
    while read < 300:
        entry = ring.newest(after=after)
        if entry is None:
            assert process.is_alive()
            continue
        assert entry.image is not None
        level = int(entry.payload) % 256
        assert entry.sequence > after
        assert int(entry.image.min()) == int(entry.image.max()) == level
        after, read = entry.sequence, read + 1
    own_end.send(None)
    process.join(30)
    assert process.exitcode == 0
    process.close()


def test_the_memory_has_no_name_that_could_be_left_behind(ring: ImageRing) -> None:
    assert os.fstat(ring._fd).st_nlink == 0
    ring.close()
    ring.close()


def test_a_write_that_begins_between_two_looks_at_the_head_is_noticed(
    ring: ImageRing, monkeypatch: pytest.MonkeyPatch
) -> None:
    ring.write(b"1", image(1))
    whole = ring._stable_slot

    def looked_at_then_written(slot: int) -> tuple[int, int, int] | None:
        found = whole(slot)
        if found is not None and found[0] == 1:
            ring._heads[slot][LOCK] += 1  # the writer begins, and is not done yet
        return found

    monkeypatch.setattr(ring, "_stable_slot", looked_at_then_written)
    assert ring.newest() is None


def test_a_reader_in_order_misses_only_what_was_overwritten(ring: ImageRing) -> None:
    assert ring.next_after(0) is None
    for number in range(1, 7):
        ring.write(b"n%d" % number, image(number), encoded=b"j%d" % number)
    read: list[tuple[int, bytes]] = []
    while (entry := ring.next_after(read[-1][0] if read else 0)) is not None:
        assert entry.image is not None
        assert np.array_equal(entry.image, image(entry.sequence))
        read.append((entry.sequence, entry.encoded))
    # Four slots: the first two are gone.
    assert read == [(3, b"j3"), (4, b"j4"), (5, b"j5"), (6, b"j6")]
    newest = ring.newest()
    assert newest is not None
    assert newest.encoded == b""


def test_a_jpeg_that_does_not_fit_is_left_out(ring: ImageRing) -> None:
    ring.write(b"n", image(1), encoded=b"x" * (600 * 600 * 3 + 1))
    entry = ring.next_after(0)
    assert entry is not None
    assert entry.encoded == b""
    assert entry.image is not None


def test_a_state_is_read_until_another_replaces_it(ring: ImageRing) -> None:
    first = ring.write_state(b"one")
    assert ring.state(first) == b"one"
    second = ring.write_state(b"two, longer")
    assert ring.state(first) is None
    assert ring.state(second) == b"two, longer"
