"""The proposed threshold is between soft tissue and bone, whatever their proportions."""

import numpy as np
import numpy.typing as npt
import pytest

from tracker.plan.bone import proposed_threshold


def tissue(*, bone_ratio: float, soft_hu: float = 45.0, noise_hu: float = 20.0) -> npt.NDArray[np.int16]:
    """Fat, muscle, spongy and dense bone; air around."""
    rng = np.random.default_rng(3)
    count = 64**3
    bone = int(bone_ratio * count)
    values = np.concatenate(
        [
            rng.normal(-1000.0, 10.0, count // 5),
            rng.normal(-100.0, noise_hu, count // 5),
            rng.normal(200.0, 60.0, bone // 2),
            rng.normal(700.0, 200.0, bone - bone // 2),
        ]
    )
    muscle = rng.normal(soft_hu, noise_hu, count - values.size)
    return np.asarray(np.rint(np.concatenate([values, muscle])), dtype=np.int16).reshape(64, 64, 64)


@pytest.mark.parametrize("bone_ratio", [0.01, 0.05, 0.3])
@pytest.mark.parametrize("noise_hu", [5.0, 20.0, 40.0])
def test_it_lies_between_soft_tissue_and_dense_bone(bone_ratio: float, noise_hu: float) -> None:
    proposal = proposed_threshold(tissue(bone_ratio=bone_ratio, noise_hu=noise_hu))
    assert proposal.surroundings_hu == pytest.approx(45.0, abs=8.0)
    assert 105.0 <= proposal.threshold_hu <= 400.0
    assert 0.3 * bone_ratio < proposal.bone_ratio < 1.3 * bone_ratio


def test_metal_does_not_move_it() -> None:
    hu = tissue(bone_ratio=0.2)
    with_metal = hu.copy()
    with_metal.reshape(-1)[::400] = 20_000
    assert proposed_threshold(with_metal).threshold_hu == pytest.approx(
        proposed_threshold(hu).threshold_hu, abs=40.0
    )


def test_a_dry_bone_in_air_has_no_soft_tissue() -> None:
    hu = np.full((40, 40, 40), -1000, np.int16)
    hu[10:30, 10:30, 10:30] = 600
    proposal = proposed_threshold(hu)
    assert proposal.surroundings_hu == pytest.approx(-1000.0)
    assert proposal.threshold_hu == pytest.approx(-200.0, abs=2.0)
    assert proposal.bone_ratio == pytest.approx(0.125)


def test_a_large_scan_is_read_in_steps_with_the_same_answer() -> None:
    hu = tissue(bone_ratio=0.1)
    rng = np.random.default_rng(0)
    shuffled = rng.permutation(hu.reshape(-1)).reshape(hu.shape)
    large = np.tile(shuffled, (3, 3, 3))
    assert proposed_threshold(large).threshold_hu == pytest.approx(
        proposed_threshold(shuffled).threshold_hu, abs=20.0
    )
