"""Images of a phone through shared memory: newest wins, also across processes and restarts."""

import multiprocessing
import threading
from multiprocessing.connection import Connection

import pytest

from server.capture.phone import PhoneImage, PhoneUpdate
from server.loop.phone_inbox import MAX_JPEG_BYTES, PhoneInbox
from tests.server.capture.fake_phone import image

PATIENCE_S = 60.0


def sent(number: int, jpeg: bytes = b"") -> PhoneUpdate:
    return PhoneUpdate(sender="phone", image=image(number, jpeg=jpeg or b"jpeg %d" % number))


def numbered(entry: tuple[int, PhoneUpdate] | None) -> int:
    assert entry is not None
    assert isinstance(entry[1].image, PhoneImage)
    return entry[1].image.number


def test_who_is_slow_reads_the_newest_and_nothing_twice() -> None:
    inbox = PhoneInbox()
    for number in range(1000):
        # Far more than the pipe holds: nobody reads, and nothing blocks.
        inbox.put(sent(number))
    entry = inbox.next_after(0, 0.0)
    assert numbered(entry) == 999
    assert entry is not None
    assert inbox.next_after(entry[0], 0.0) is None
    inbox.close()


def test_who_waits_is_woken() -> None:
    inbox = PhoneInbox()
    writer = threading.Timer(0.0, inbox.put, [sent(4)])
    writer.start()
    assert numbered(inbox.next_after(0, PATIENCE_S)) == 4
    writer.join()
    inbox.close()


def test_the_largest_image_fits_and_a_larger_one_does_not() -> None:
    inbox = PhoneInbox()
    inbox.put(sent(1, b"x" * MAX_JPEG_BYTES))
    assert numbered(inbox.newest()) == 1
    with pytest.raises(ValueError, match="the maximum is"):
        inbox.put(sent(2, b"x" * (MAX_JPEG_BYTES + 20_000)))
    inbox.close()


def _read(inbox: PhoneInbox, after: int, answer: Connection) -> None:
    entry = inbox.next_after(after, PATIENCE_S)
    answer.send(None if entry is None else (entry[0], numbered(entry)))


def test_one_process_after_the_other_reads_what_came_since() -> None:
    context = multiprocessing.get_context("spawn")
    inbox = PhoneInbox()
    heard, answer = context.Pipe(duplex=False)
    reader = context.Process(target=_read, args=(inbox, 0, answer))
    reader.start()
    inbox.put(sent(5))
    assert heard.poll(PATIENCE_S)
    after, read = heard.recv()
    assert read == 5
    reader.join(PATIENCE_S)
    reader.close()
    # The next process, which is this one, finds the connection unchanged.
    assert inbox.next_after(after, 0.0) is None
    inbox.put(sent(6))
    assert numbered(inbox.next_after(after, PATIENCE_S)) == 6
    inbox.close()
