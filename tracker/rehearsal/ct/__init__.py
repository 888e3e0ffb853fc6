"""CT phantoms with exactly known pedicles, and a simulated scanner."""

from tracker.rehearsal.ct.distance_fields import Block, ContrastTube, Drum, EllipticTube, Rod
from tracker.rehearsal.ct.phantom import PedicleTruth, VertebraPhantom, pedicle_tube, usual_bones
from tracker.rehearsal.ct.random_phantoms import random_grid, random_phantom
from tracker.rehearsal.ct.rehearsal_ct import rehearsal_ct
from tracker.rehearsal.ct.scanner import ScanGrid, scan

__all__ = [
    "Block",
    "ContrastTube",
    "Drum",
    "EllipticTube",
    "PedicleTruth",
    "Rod",
    "ScanGrid",
    "VertebraPhantom",
    "pedicle_tube",
    "random_grid",
    "random_phantom",
    "rehearsal_ct",
    "scan",
    "usual_bones",
]
