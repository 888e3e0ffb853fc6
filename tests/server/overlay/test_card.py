"""The card for missing video shows its text inside the picture."""

import numpy as np
import pytest

from server.overlay import draw_card
from server.overlay.card import BACKGROUND


@pytest.mark.parametrize("size_wh_px", [(1280, 720), (640, 480), (480, 1080), (160, 120)])
def test_long_reasons_stay_inside_the_picture(size_wh_px: tuple[int, int]) -> None:
    path = "/very" * 60 + ".mov"
    card = draw_card(size_wh_px=size_wh_px, title="NO VIDEO", lines=(f"Cannot open {path}", "12:00:00"))
    assert card.shape == (size_wh_px[1], size_wh_px[0], 3)
    edge = np.concatenate([card[:, :2].ravel(), card[:, -2:].ravel(), card[:2].ravel(), card[-2:].ravel()])
    assert (edge == BACKGROUND).all()
    assert (card > 100).any()


def test_another_reason_is_another_picture() -> None:
    one = draw_card(size_wh_px=(640, 360), title="NO VIDEO", lines=("The camera is gone.",))
    other = draw_card(size_wh_px=(640, 360), title="NO VIDEO", lines=("Tracking is starting.",))
    assert not np.array_equal(one, other)
