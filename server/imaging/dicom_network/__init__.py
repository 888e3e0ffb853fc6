"""DICOM over the network: objects of a plan to an archive, and a CT from one.

pynetdicom logs what it sends and receives. Its loggers are silent, because that may be the patient's name.
"""

import logging

for _name in ("pynetdicom", "pydicom"):
    logging.getLogger(_name).setLevel(logging.CRITICAL + 1)
