"""When damaged images are reported, and when their source is reopened."""

import itertools

import pytest

from server.capture.damaged_images import DamagedImages
from server.errors import CaptureError


def counted(images: DamagedImages, damaged: set[int], *, count: int, rate_hz: float = 30.0) -> list[str]:
    """Count images, some of them damaged, and return the different messages in their order."""
    messages = []
    for number in range(count):
        at_s = 100.0 + number / rate_hz
        if number in damaged:
            images.add_damaged("premature end", at_s)
        else:
            images.add_intact(at_s)
        messages.append("" if images.problem is None else images.problem.message)
    return [message for message, _ in itertools.groupby(messages)]


def test_damaged_images_are_reported_at_once_and_then_counted_every_ten_seconds() -> None:
    assert counted(DamagedImages("camera 0"), {90, 91, 120}, count=700) == [
        "",
        "damaged and not used: 1 of 91 images of camera 0 within 3.0 s (premature end)",
        "damaged and not used: 3 of 301 images of camera 0 within 10.0 s (premature end)",
        "",
    ]


@pytest.mark.parametrize(("rate_hz", "row"), [(30.0, 46), (5.0, 8)])
def test_a_source_of_damaged_images_only_is_reopened_before_it_counts_as_silent(
    rate_hz: float, row: int
) -> None:
    images = DamagedImages("camera 0")
    with pytest.raises(CaptureError) as caught:
        counted(images, set(range(10, 99)), count=99, rate_hz=rate_hz)
    assert caught.value.code == "IMAGES_DAMAGED"
    assert f"{row} of {row} images of camera 0 within 1." in caught.value.message
    images.restart()
    assert images.problem is None
    assert len(counted(images, set(range(1, 99, 2)), count=99)) == 2, "every second image is used"
