"""Images of a phone over `WS /ws/camera`.

page_clock.py  clock offset between page and server, by round-trip bounds
messages.py    messages of page and server
sender.py      protocol state of one page; without I/O
receiver.py    the one active sender, and the transfer of its images to the tracking process
socket.py      the WebSocket
"""
