"""Mean time of each stage of an image, from the running server's metrics."""

from collections.abc import Mapping
from urllib.request import urlopen

from prometheus_client.parser import text_string_to_metric_families

FAMILY = "coaxial_stage_seconds"


def stage_sums(port: int) -> dict[str, tuple[float, float]]:
    """Return total seconds and number of images, by stage."""
    with urlopen(f"http://127.0.0.1:{port}/metrics", timeout=10.0) as answer:
        text = answer.read().decode()
    sums: dict[str, list[float]] = {}
    for family in text_string_to_metric_families(text):
        for sample in family.samples:
            place = {f"{FAMILY}_sum": 0, f"{FAMILY}_count": 1}.get(sample.name)
            if place is not None:
                sums.setdefault(sample.labels["stage"], [0.0, 0.0])[place] = sample.value
    return {stage: (seconds, images) for stage, (seconds, images) in sums.items()}


def mean_stage_ms(
    before: Mapping[str, tuple[float, float]], after: Mapping[str, tuple[float, float]]
) -> dict[str, float]:
    """Return the mean ms of each stage between two readings; unused stages are left out."""
    means = {}
    for stage, (seconds, images) in after.items():
        seconds_before, images_before = before.get(stage, (0.0, 0.0))
        if images > images_before:
            means[stage] = 1000.0 * (seconds - seconds_before) / (images - images_before)
    return means
