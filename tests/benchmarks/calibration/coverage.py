"""Coverage of the 95 % intervals of a camera calibration."""

from collections import Counter

import numpy as np

from tests.benchmarks.calibration.cameras import BOARD, known_camera, seen_view
from tests.benchmarks.options import BenchmarkOptions
from tests.benchmarks.section_result import SectionResult
from tests.benchmarks.tables import Table
from tracker.camera.calibration import calibrate

RUNS, VIEWS, NOISE_PX = 400, 12, 0.2
# Errors that neighbouring points share: too weak to be detected, and detected in most calibrations.
COMMON_RUNS, COMMON_PX = 60, (0.04, 0.08)


def measure_calibration(options: BenchmarkOptions) -> SectionResult:
    """Calibrate cameras with known parameters from views with known noise."""
    inside: dict[str, list[bool]] = {}
    off_sds: dict[str, list[float]] = {}
    models: Counter[int] = Counter()
    for run in range(RUNS):
        rng = np.random.default_rng(options.seed + run)
        camera = known_camera(rng)
        views = [seen_view(camera.model, BOARD, rng, noise_px=NOISE_PX) for _ in range(VIEWS)]
        report = calibrate(views, size_wh_px=camera.model.size_wh_px)
        models[report.choice.coefficients] += 1
        true_value = camera.true_value_from_name
        for one in report.parameters:
            inside.setdefault(one.name, []).append(one.low_95 <= true_value[one.name] <= one.high_95)
            off_sds.setdefault(one.name, []).append((one.value - true_value[one.name]) / one.sd)
    taken = ", ".join(f"{count} times {model}" for model, count in sorted(models.items()))
    rows = [
        (name, f"{100 * np.mean(hits):.1f} %", f"{np.std(off_sds[name]):.2f}", f"{len(hits)}")
        for name, hits in inside.items()
    ]
    return SectionResult(
        tables=[
            Table(
                title=f"Calibration: {RUNS} cameras, {VIEWS} views each, {NOISE_PX:g} px of noise",
                columns=("number", "inside its 95 % interval", "spread in stated sd", "cameras"),
                rows=rows,
                note=f"Aim: 92 to 98 %. Lens coefficients taken: {taken}.",
            ),
            _common_table(options),
        ]
    )


def _common_table(options: BenchmarkOptions) -> Table:
    """Return the coverage where neighbouring points share a part of their error."""
    rows = []
    for common_px in COMMON_PX:
        inside: list[bool] = []
        ratios: list[float] = []
        detected = 0
        for run in range(COMMON_RUNS):
            rng = np.random.default_rng(options.seed + 10_000 + run)
            camera = known_camera(rng)
            views = [
                seen_view(camera.model, BOARD, rng, noise_px=NOISE_PX, common_px=common_px)
                for _ in range(VIEWS)
            ]
            report = calibrate(views, size_wh_px=camera.model.size_wh_px)
            detected += report.is_noise_correlated
            for one in report.parameters:
                true_value = camera.true_value_from_name[one.name]
                inside.append(one.low_95 <= true_value <= one.high_95)
                ratios.append((one.value - true_value) / one.sd)
        share = f"{100 * np.mean(inside):.1f} % of {len(inside)}"
        rows.append((f"{common_px:g}", f"{detected} of {COMMON_RUNS}", share, f"{np.std(ratios):.2f}"))
    return Table(
        title=f"The same with an error in common over two pitches of the board, {COMMON_RUNS} cameras each",
        columns=("in common px", "detected", "numbers inside their 95 % interval", "spread in stated sd"),
        rows=rows,
        note="The numbers of one calibration are not independent.",
    )
