"""The warm-up compiles what draws the rehearsal's drill, for the types that the renderer has."""

import subprocess
import sys

LOADED = """
from tracker.compiled import DISPATCHERS
from tracker.rehearsal import Event, EventKind, Theatre, TheatreSettings
from tracker.warm_up import Part, warm_up

def versions():
    return {loop.py_func.__qualname__: len(loop.signatures) for loop in drawing}

warm_up(Part.REST)
drawing = [loop for loop in DISPATCHERS if loop.py_func.__module__.startswith("tracker.rehearsal")]
ahead = versions()
hidden = Event(kind=EventKind.DRILL_HIDDEN, at_s=3.0, lasts_s=1.0)
renderer = Theatre(TheatreSettings(size_wh_px=(320, 180), events=(hidden,))).renderer()
for at_s in (0.0, 1.0, 3.5):
    renderer.image_at(at_s)
print(len(drawing), ahead == versions(), ahead["draw_body"], ahead["composite"])
"""


def test_after_the_warm_up_no_image_of_the_rehearsal_makes_anything_compile() -> None:
    # In a process of its own: other tests draw, which would hide it.
    done = subprocess.run([sys.executable, "-c", LOADED], capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["4", "True", "1", "1"]
