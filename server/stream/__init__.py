"""Out to those who watch: MJPEG, image and pose in one WebSocket message, pose alone as JSON.

messages.py    what goes over the wire (the schema); made of the other *_messages.py
viewers.py     who watches, and how many instants each one skipped
connection.py  the line to one viewer: short buffers, and cut when it is stalled
no_video.py    what is shown when there is no image
mjpeg.py, live_socket.py, view_socket.py   the three ways out
"""
