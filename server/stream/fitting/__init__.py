"""What one viewer's line carries, and each picture and message made once for all who watch in it.

sizes.py     the steps of size, and what a viewer may choose
pace.py      which step a line carries, judged by how long sendings take and what was missed meanwhile
pictures.py  the picture of an instant in a size, encoded once and only when somebody watches it
texts.py     the message of an instant, written once; only its moment of sending differs between viewers
"""
