"""Viewers are counted one by one, also those that saw the same."""

from server.stream.viewers import ViewerKind, Viewers


def test_two_who_saw_the_same_go_one_by_one() -> None:
    viewers = Viewers()
    with viewers.watching(ViewerKind.LIVE) as stays:
        with viewers.watching(ViewerKind.LIVE) as goes:
            stays.took(7)
            goes.took(7)
        # What the other one saw and missed since is its own.
        stays.took(9)
        assert viewers.count(ViewerKind.LIVE) == 1
        assert viewers.dropped(ViewerKind.LIVE) == 1
    assert viewers.count(ViewerKind.LIVE) == 0
    assert viewers.dropped(ViewerKind.LIVE) == 1
