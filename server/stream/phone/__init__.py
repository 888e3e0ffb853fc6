"""A phone's images over `WS /ws/camera`.

page_clock.py  the page's clock against this machine's, by bounds
messages.py    what page and server say
sender.py      what one page sends, in order; without I/O
receiver.py    the one sender of now, and the way of its images to the tracking process
socket.py      the WebSocket
"""
