"""Recordings of the tracked images and results, their exact replay, review and export.

comments.py  comments of people on instants of recordings
consent.py   consent of the patient
drilling_course.py  course of each drilling, for the report
cut.py       a part of a recording as a new recording
export.py    tables, and their export as CSV
exports.py   videos, tables, sequences and parts of recordings, made by jobs
messages.py  messages of a file other than images and live messages
parquet.py   export of the tables as Parquet
process.py   the recording process: reads the ring and writes the file
recorder.py  one recording in the web process
review.py    timeline, images and results of a finished recording
sequence_metafile.py  export of images with poses for 3D Slicer and Plus
service.py   starts, stops and lists recordings of the open case
timeline.py  index of a recording: positions of images, figures as columns, events
recorded_results.py  records of the results of an image, for drawing
replay.py    tracks a recording again and compares the results
video.py     export as a video with the overlay
"""
