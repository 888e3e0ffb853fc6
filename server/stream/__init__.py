"""Output to viewers: MJPEG, image and pose in one WebSocket message, pose alone as JSON.

messages.py    the wire schema; composed of the other *_messages.py
viewers.py     who watches, and how many instants each viewer skipped
connection.py  connection to one viewer: short buffers, aborted when it stalls
no_video.py    the card that is shown without an image
mjpeg.py, live_socket.py, view_socket.py   the three outputs
"""
