"""The 3-D scene at `/scene/`: vertebra, channel, live drill and camera, drawn by viser in the browser.

The only room that knows viser. viser opens no port here and starts no thread: its producer of messages is
driven from a WebSocket of the application itself (`door.py`), and nothing that a viewer sends reaches it
(`gate.py`). What is drawn is decided in `nodes.py`, `drills.py` and `stage.py`, from where in `views.py`, and
`page.py` with `watch.js` makes the page of viser say which image it has drawn, and look from there.
"""

from server.scene.scene import Scene, mount_scene

__all__ = ["Scene", "mount_scene"]
