"""The 3-D scene at `/scene/`: vertebra, channel, live drill and camera, drawn by viser in the browser.

Only this package imports viser. viser opens no port and starts no thread here: a WebSocket of the application
drives its message producer (`door.py`), and no message of a viewer reaches it (`gate.py`). `nodes.py`,
`drills.py`, `marks.py` and `stage.py` define the content, `views.py` the viewpoints. `page.py` and `watch.js`
make the page of viser report the drawn image and clicks on the bone, and apply a viewpoint.
"""

from server.scene.scene import Admit, Cut, Scene, mount_scene

__all__ = ["Admit", "Cut", "Scene", "mount_scene"]
