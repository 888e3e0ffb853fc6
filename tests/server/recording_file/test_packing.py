"""Images in a recording: packed and unpacked without loss."""

import cv2
import numpy as np

from server.image_file import decoded
from server.recording_file import ImagePacker, PackedImage, Packing, unpacked

COLOUR = np.random.default_rng(1).integers(0, 256, (24, 40, 3)).astype(np.uint8)


def test_a_colour_image_comes_back_with_every_pixel() -> None:
    packed = ImagePacker().pack(COLOUR)
    assert packed.packing is Packing.ZSTD_BGR
    assert packed.size_wh_px == (40, 24)
    back = unpacked(packed)
    assert back is not None
    assert np.array_equal(back, COLOUR)


def test_a_grey_image_takes_one_channel_and_one_other_pixel_makes_it_colour() -> None:
    grey = np.repeat(COLOUR[:, :, :1], 3, axis=2)
    packed = ImagePacker().pack(grey)
    assert packed.packing is Packing.ZSTD_GREY
    back = unpacked(packed)
    assert back is not None
    assert np.array_equal(back, grey)
    grey[5, 7, 2] ^= 1
    assert ImagePacker().pack(grey).packing is Packing.ZSTD_BGR


def test_a_smooth_image_with_noise_takes_less_than_its_pixels_as_they_are() -> None:
    generator = np.random.default_rng(2)
    slope = np.linspace(20.0, 220.0, 320)[:, None, None] + generator.normal(0.0, 2.0, (320, 240, 3))
    image = np.clip(slope, 0.0, 255.0).astype(np.uint8)
    packed = ImagePacker().pack(image)
    back = unpacked(packed)
    assert back is not None
    assert np.array_equal(back, image)
    # The noise of two rows has an entropy of 3.5 bits, the pixels as they are of 7.6.
    assert len(packed.content) < 0.6 * image.size


def test_a_jpeg_of_the_source_is_stored_as_it_came() -> None:
    jpeg = cv2.imencode(".jpg", COLOUR)[1].tobytes()
    image = decoded(jpeg)
    assert image is not None
    packed = ImagePacker().pack(image, jpeg)
    assert packed.content == jpeg
    back = unpacked(packed)
    assert back is not None
    assert np.array_equal(back, image)


def test_damaged_content_is_no_image() -> None:
    good = ImagePacker().pack(COLOUR).content
    for content, size in ((good[:-9], (40, 24)), (good, (41, 24)), (b"", (40, 24)), (good, (0, 0))):
        assert unpacked(PackedImage(packing=Packing.ZSTD_BGR, size_wh_px=size, content=content)) is None
    assert unpacked(PackedImage(packing=Packing.JPEG, size_wh_px=(40, 24), content=b"\xff\xd8")) is None
