"""Random phantoms and scan grids over the range of real pedicles and scanners."""

import numpy as np

from tracker.geometry import rotation_from_vector
from tracker.rehearsal.ct.distance_fields import ContrastTube, Drum, Part, Rod
from tracker.rehearsal.ct.phantom import VertebraPhantom, pedicle_tube, usual_bones
from tracker.rehearsal.ct.scanner import ScanGrid


def random_phantom(seed: int) -> VertebraPhantom:
    """Return a vertebra with two different pedicles, tilted, with neighbours; reproducible by seed."""
    random = np.random.default_rng(seed)
    width = random.uniform(5.5, 12.0)
    pedicles = {
        side: pedicle_tube(
            side,
            width_mm=width * random.uniform(0.92, 1.08),
            height_mm=width * random.uniform(1.15, 1.7),
            transverse_deg=random.uniform(-5.0, 28.0),
            sagittal_deg=random.uniform(-15.0, 15.0),
            waist_mm=(random.uniform(13.0, 17.0), random.uniform(-3.0, 2.0), random.uniform(2.0, 5.0)),
            roll_deg=random.uniform(-15.0, 15.0),
            widening_per_mm2=random.uniform(0.0, 0.004),
            bend_per_mm=random.uniform(-0.012, 0.012),
        )
        for side in ("left", "right")
    }
    turn = np.radians(random.uniform(-8.0, 8.0, 3) * [1.5, 1.0, 1.0])
    return VertebraPhantom(
        pedicles=pedicles,
        bones=usual_bones(),
        neighbours=_neighbours(random),
        beside=_beside(random),
        cortex_mm=random.uniform(0.8, 2.0),
        cortex_hu=random.uniform(700.0, 1200.0),
        marrow_hu=random.choice([50.0, random.uniform(100.0, 250.0)]),
        tissue_hu=random.uniform(-20.0, 60.0),
        rotation=rotation_from_vector(turn),
        place_mm=np.array([random.uniform(-60, 60), random.uniform(-200, 200), random.uniform(-900, 900)]),
    )


def random_grid(phantom: VertebraPhantom, seed: int) -> ScanGrid:
    """Return a scan grid: 0.35 to 0.9 mm in the slice, 0.6 to 3 mm between slices, perhaps tilted."""
    random = np.random.default_rng(seed + 10_000)
    inside = random.uniform(0.35, 0.9)
    slices = random.choice([random.uniform(0.6, 1.5), random.uniform(1.5, 3.0)])
    oblique = random.choice([0.0, 1.0]) * np.radians(random.uniform(-20.0, 20.0, 3))
    return ScanGrid.around(
        phantom.rotation @ np.array([0.0, -8.0, 0.0]) + phantom.place_mm,
        size_mm=(72.0, 104.0, 54.0),
        spacing_mm=(inside, inside, slices),
        rotation=rotation_from_vector(oblique),
        gantry_tilt_deg=random.choice([0.0, random.uniform(-15.0, 15.0)]),
        blur_mm=random.uniform(0.0, 0.4),
        noise_hu=random.uniform(10.0, 60.0),
        seed=seed,
    )


def _neighbours(random: np.random.Generator) -> tuple[Part, ...]:
    """Return adjacent vertebral bodies, and sometimes ribs."""
    gap = random.uniform(4.0, 8.0)
    bodies: list[Part] = [
        Drum(centre_mm=np.array([0.0, -27.0, way * (28.0 + gap)]), half_mm=(23.0, 17.0, 14.0))
        for way in (-1.0, 1.0)
    ]
    if random.random() < 0.4:
        for side in (-1.0, 1.0):
            start = np.array([side * 26.0, -4.0, 3.0])
            bodies.append(
                Rod(start_mm=start, end_mm=start + np.array([side * 18.0, 22.0, -4.0]), radius_mm=3.5)
            )
    return tuple(bodies)


def _beside(random: np.random.Generator) -> tuple[ContrastTube, ...]:
    """Return the cord in the canal, an aorta that may contain contrast, and sometimes lung."""
    up = np.array([0.0, 0.0, 60.0])
    aorta = np.array([10.0, -58.0, 0.0])
    things = [
        ContrastTube(part=Rod(start_mm=-up, end_mm=up, radius_mm=5.0), hu=35.0),
        ContrastTube(
            part=Rod(start_mm=aorta - up, end_mm=aorta + up, radius_mm=10.0), hu=random.choice([45.0, 300.0])
        ),
    ]
    if random.random() < 0.3:
        lung = np.array([60.0, -10.0, 0.0])
        things.append(ContrastTube(part=Rod(start_mm=lung - up, end_mm=lung + up, radius_mm=22.0), hu=-850.0))
    return tuple(things)
