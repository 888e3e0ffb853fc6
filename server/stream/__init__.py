"""Output to viewers: MJPEG, image and pose in one WebSocket message, and pose only as JSON.

messages.py    the wire schema; composed of the other *_messages.py
viewers.py     viewers, and the number of instants that each has skipped
connection.py  connection to one viewer with short buffers, aborted when it stalls
no_video.py    the card shown without an image
mjpeg.py, live_socket.py, view_socket.py   the three outputs
"""
