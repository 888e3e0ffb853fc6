"""Recordings: what is written while images arrive, and their exact replay.

comments.py  what people wrote on instants of recordings
consent.py   whether the patient consented
cut.py       a piece of a recording as a recording of its own
export.py    as CSV
exports.py   videos and pieces, made by jobs
messages.py  what is in a file beside images and live messages
process.py   reads the ring in a process of its own and writes the file
recorder.py  one recording, as the web process sees it
review.py    timeline, images and results of one that has ended
service.py   starts and stops recordings of the open case, and lists them
timeline.py  its index: where images lie, figures as columns, what happened
recorded_results.py  the results of an image as records again, to draw them
replay.py    tracks a recording again, and compares
video.py     as a video, with the overlay
"""
