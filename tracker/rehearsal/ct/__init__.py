"""CT phantoms with exactly known pedicles, and the scanner that turns them into voxels."""

from tracker.rehearsal.ct.parts import Block, ContrastTube, Drum, EllipticTube, Rod
from tracker.rehearsal.ct.phantom import PedicleTruth, VertebraPhantom, pedicle_tube, usual_bones
from tracker.rehearsal.ct.rehearsal import rehearsal_ct
from tracker.rehearsal.ct.scanner import ScanGrid, scan
from tracker.rehearsal.ct.varied import random_grid, random_phantom

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
