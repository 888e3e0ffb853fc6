"""Coverage of the stated 95 % ellipsoid of a tip at the end of short and long tools, with exact intervals.

python -m tests.benchmarks.levers [--draws 40000] [--images 300]: pose errors drawn at random, propagated by
navigation, and rendered images of a small marker that nearly faces the camera.
"""

import argparse
import sys

import numpy as np
import scipy.stats

from tests.benchmarks.tables import Table
from tests.tracker.navigation.levers import CHI2_95, LEVERS_MM, TILTS_SD_DEG, entries_inside, tips_inside
from tests.tracker.scenes import Print, camera_of, code_image, code_model, facing_at_px, rendered
from tracker import Seen, Tracker
from tracker.pose import marker_point_covariance_mm2

DRAWS, IMAGES = 40_000, 300
MAX_TILT_DEG, SIDES_PX = 8.0, (30.0, 60.0)


def main(arguments: list[str] | None = None) -> None:
    """Print both tables."""
    parser = argparse.ArgumentParser(prog="python -m tests.benchmarks.levers", description=__doc__)
    parser.add_argument("--draws", type=int, default=DRAWS, help="pose errors of each row")
    parser.add_argument("--images", type=int, default=IMAGES, help="rendered images")
    given = parser.parse_args(arguments)
    for table in (drawn_table(given.draws), rendered_table(given.images)):
        sys.stdout.write(table.markdown + "\n")


def drawn_table(draws: int) -> Table:
    """Return the coverage of tip and planned entry for pose errors drawn from their covariance."""
    rows = [
        [
            f"{lever_mm:.0f} mm, {tilt_sd_deg:g} deg",
            coverage(tips_inside(lever_mm, tilt_sd_deg, draws=draws, seed=1), draws),
            coverage(entries_inside(lever_mm, tilt_sd_deg, draws=draws, seed=2), draws),
        ]
        for lever_mm in LEVERS_MM
        for tilt_sd_deg in TILTS_SD_DEG
    ]
    return Table(
        title=f"Drawn pose errors, {draws} of each row: inside the stated 95 %",
        columns=["lever, sd of the tilt", "tip of the tool", "entry, by the reference"],
        rows=rows,
    )


def rendered_table(images: int) -> Table:
    """Return the coverage of tips in rendered images of a marker that nearly faces the camera."""
    camera, tracker = camera_of(), Tracker(camera=camera_of(), models=[code_model()])
    inside, found = dict.fromkeys(LEVERS_MM, 0), 0
    for seed in range(images):
        random = np.random.default_rng([seed, 5])
        truth = facing_at_px(
            camera,
            random.uniform([150, 150], [490, 330]).tolist(),
            random.uniform(*SIDES_PX),
            tilt_deg=random.uniform(0.0, MAX_TILT_DEG),
            about_deg=random.uniform(0.0, 360.0),
            roll_deg=random.uniform(0.0, 360.0),
        )
        image = rendered(camera, [Print(picture=code_image(), pose=truth)], noise_grey=4.0, seed=seed)
        sighting = tracker.search(image)["code"]
        if not isinstance(sighting, Seen):
            continue
        found += 1
        pose = sighting.camera_from_marker
        for lever_mm in LEVERS_MM:
            tip = np.array([0.0, -lever_mm, 0.0])
            off = truth.move_points(tip) - pose.move_points(tip)
            stated = marker_point_covariance_mm2(pose, sighting.pose_covariance, tip)
            inside[lever_mm] += bool(off @ np.linalg.solve(stated, off) < CHI2_95)
    return Table(
        title=f"Rendered markers of {SIDES_PX[0]:.0f} to {SIDES_PX[1]:.0f} px, tilted by up to "
        f"{MAX_TILT_DEG:g} deg, found in {found} of {images} images: inside the stated 95 %",
        columns=["lever", "tip of the tool"],
        rows=[[f"{lever_mm:.0f} mm", coverage(count, found)] for lever_mm, count in inside.items()],
    )


def coverage(count: int, of: int) -> str:
    """Return a proportion with its 95 % Clopper-Pearson interval."""
    low, high = scipy.stats.binomtest(count, of).proportion_ci(0.95, method="exact")
    return f"{count / of:.4f} ({low:.4f}-{high:.4f})"


if __name__ == "__main__":
    main()
