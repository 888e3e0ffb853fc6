"""Labels of vertebrae: counting of levels, start points for pedicles, and contradictions to a measurement."""

import dataclasses
import functools
import tracemalloc
from collections.abc import Callable

import numpy as np
import numpy.typing as npt
import pytest

from tests.tracker.plan.label_phantoms import labelled_spine, three_levels
from tracker.errors import PlanError
from tracker.geometry import Array, rotation_from_vector
from tracker.plan import Channel, Volume, measure_pedicle
from tracker.plan.labels import (
    CLASS_OF_LEVEL,
    LabelVolume,
    VertebraLabel,
    check_channel,
    check_levels,
    check_measure,
    label_outlines,
    level_from_name,
    measure_labels,
    pedicle_start_points,
)

PEDICLE_MM, AHEAD = np.array([16.0, 0.0, 4.5]), np.array([-0.165, -0.985, -0.04])


def column(**heights_mm: float) -> tuple[VertebraLabel, ...]:
    """Vertebrae at these heights, from the head down by name."""
    return tuple(
        VertebraLabel(
            level=level,
            volume_ml=50.0,
            centroid_lps_mm=np.array([0.0, 0.1 * height, height]),
            low_lps_mm=np.zeros(3),
            high_lps_mm=np.zeros(3),
            is_cut=False,
        )
        for level, height in sorted(heights_mm.items(), key=lambda one: -CLASS_OF_LEVEL[one[0]])
    )


@pytest.mark.parametrize(
    ("name", "level"),
    [
        ("L3", "L3"),
        ("vertebrae_T12", "T12"),
        ("L3 vertebra", "L3"),
        ("lwk 4", "L4"),
        ("Th7", "T7"),
        ("S1", "S1"),
        ("S2", None),
        ("L6", None),
        ("level 3", None),
        ("", None),
        ("L" + "3" * 500, None),
    ],
)
def test_names_of_levels(name: str, level: str | None) -> None:
    assert level_from_name(name) == level


@pytest.mark.parametrize(
    "vertebrae",
    [
        pytest.param(column(T12=38.0, L1=0.0, L2=-36.0, L3=-73.0), id="neighbours"),
        pytest.param(column(L2=0.0, L4=-76.0), id="a-level-not-segmented"),
        pytest.param(column(C6=0.0, C7=-17.0, T1=-36.0), id="neck"),
        pytest.param(column(L3=0.0), id="one"),
    ],
)
def test_plausible_columns_are_accepted(vertebrae: tuple[VertebraLabel, ...]) -> None:
    check_levels(vertebrae)


@pytest.mark.parametrize(
    ("vertebrae", "words"),
    [
        (column(L3=0.0, L4=-76.0, L5=-38.0), "they are L3, L4, L5 by name, but L3, L5, L4 by position"),
        (column(L3=-76.0, L4=-38.0, L5=0.0), "but L5, L4, L3 by position"),
        (column(L2=0.0, L4=-37.0), "L2 and L4 are 2 levels apart by name, but their labels lie 37 mm apart"),
        (
            column(L3=0.0, L4=-74.0),
            "1 levels apart by name, but their labels lie 74 mm apart, about 2 levels",
        ),
    ],
)
def test_two_counts_that_disagree_are_both_stated(vertebrae: tuple[VertebraLabel, ...], words: str) -> None:
    with pytest.raises(PlanError, match=words) as reported:
        check_levels(vertebrae)
    assert reported.value.code == "LEVEL_DOUBTFUL"


def channel(down_mm: float) -> Channel:
    """The channel of the rehearsal's left pedicle, moved towards the feet."""
    middle = PEDICLE_MM - [0.0, 0.0, down_mm]
    return Channel(
        name="L3 left",
        entry_in_vertebra_mm=middle - 12.0 * AHEAD,
        target_in_vertebra_mm=middle + 28.0 * AHEAD,
        radius_mm=3.0,
    )


def test_a_channel_lies_in_the_label_of_its_level_or_is_refused() -> None:
    labels = three_levels()[1]
    assert check_channel(labels, "L3", channel(0.0)) == "L3"
    assert check_channel(labels, "LWK 4", channel(38.0)) == "L4"
    assert check_channel(labels, "upper one", channel(38.0)) == ""
    assert check_channel(labels, "L3", channel(500.0)) == ""
    with pytest.raises(
        PlanError, match=r"planned for L3, but .* in the label L4, 1 levels away, and 0 %"
    ) as said:
        check_channel(labels, "L3", channel(38.0))
    assert said.value.code == "LEVEL_DOUBTFUL"


TURNED = rotation_from_vector(np.array([0.2, 0.12, -0.25]))


@functools.cache
def scanned() -> tuple[Volume, LabelVolume]:
    return labelled_spine(("L3",))


@functools.cache
def turned() -> tuple[Volume, LabelVolume]:
    return labelled_spine(("L3",), rotation=TURNED)


@pytest.mark.parametrize(
    ("scan", "rotation", "mirror", "measured"),
    [
        pytest.param(scanned, np.eye(3), 1.0, ("left", "right"), id="as-scanned"),
        pytest.param(
            lambda: labelled_spine(("L3",), spacing_mm=(0.8, 0.8, 2.5)),
            *(np.eye(3), 1.0, ("left",)),
            id="thick-slices",
        ),
        pytest.param(turned, TURNED, 1.0, ("right",), id="turned-and-tilted"),
        pytest.param(turned, TURNED, -1.0, ("left",), id="mirrored"),
    ],
)
def test_both_pedicles_are_measured_from_the_label_without_a_click(
    scan: Callable[[], tuple[Volume, LabelVolume]], rotation: Array, mirror: float, measured: tuple[str, ...]
) -> None:
    volume, labels = scan()
    if mirror < 0.0:
        # The rows run the other way, and so does the patient.
        flip = np.diag([-1.0, 1.0, 1.0, 1.0])
        volume = dataclasses.replace(volume, lps_from_ijk=flip @ volume.lps_from_ijk)
        labels = dataclasses.replace(labels, lps_from_ijk=flip @ labels.lps_from_ijk)
        rotation = flip[:3, :3] @ rotation @ flip[:3, :3]
    starts = pedicle_start_points(labels, "L3")
    assert [one.side for one in starts] == ["left", "right"]
    for start, sign in zip(starts, (1.0, -1.0), strict=True):
        off = rotation.T @ start.point_lps_mm - PEDICLE_MM * [sign, 1.0, 1.0]
        assert np.abs(off).max() < 6.0
        if start.side not in measured:
            continue
        measure = measure_pedicle(volume, start.point_lps_mm, start.side)
        assert measure.width_mm == pytest.approx(9.3, abs=0.4)
        check_measure(labels, "L3", measure)


def test_a_label_without_canal_or_pedicle_gives_no_start() -> None:
    _, labels = labelled_spine(("L3",), spacing_mm=(1.5, 1.5, 1.5))
    points = np.argwhere(np.ones(labels.labels.shape, dtype=bool))[:, ::-1]
    lps = labels.lps_from_index(points).reshape(*labels.labels.shape, 3)

    def code(visible: npt.NDArray[np.bool_]) -> str:
        changed = dataclasses.replace(labels, labels=labels.labels * visible.astype(np.uint8))
        with pytest.raises(PlanError) as reported:
            pedicle_start_points(changed, "L3")
        return reported.value.code

    assert code(lps[..., 1] < -8.0) == "LABEL_WITHOUT_PEDICLES", "only the body"
    assert code((np.abs(lps[..., 1]) > 5.0) | (lps[..., 0] < 0.0)) == "LABEL_WITHOUT_PEDICLES", "left one cut"
    with pytest.raises(PlanError) as reported:
        pedicle_start_points(labels, "L4")
    assert reported.value.code == "LEVEL_WITHOUT_LABEL"


def test_a_label_that_contradicts_the_measurement_makes_it_doubtful() -> None:
    volume, labels = scanned()
    start = pedicle_start_points(labels, "L3")[0]
    measure = measure_pedicle(volume, start.point_lps_mm, "left")

    def code(changed: LabelVolume, name: str = "L3") -> str:
        try:
            check_measure(changed, name, measure)
        except PlanError as error:
            return error.code
        return ""

    def shifted(*by_mm: float) -> LabelVolume:
        affine = labels.lps_from_ijk.copy()
        affine[:3, 3] += by_mm
        return dataclasses.replace(labels, lps_from_ijk=affine)

    assert code(labels) == ""
    assert code(labels, "L4") == "", "nothing to compare with"
    assert code(shifted(0.0, 8.0, 0.0)) == "PEDICLE_DOUBTFUL", "the front wall"
    assert code(shifted(0.0, -8.0, 0.0)) == "PEDICLE_DOUBTFUL"
    lower = labels.labels.copy()
    lower[lower > 0] = CLASS_OF_LEVEL["L4"]
    both = dataclasses.replace(shifted(0.0, 0.0, 0.0), labels=lower)
    both.labels[0, 0, 0] = CLASS_OF_LEVEL["L3"]
    assert code(both) == "LEVEL_DOUBTFUL"


def test_measured_labels_and_outlines_have_the_size_of_the_bone() -> None:
    volume, labels = three_levels()
    measured = measure_labels(labels, shape_ijk=volume.shape_ijk)
    assert [one.level for one in measured] == ["L3", "L4", "L5"]
    sagittal = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, -50.0], [0.0, -1.0, 30.0]])
    outlines = label_outlines(labels, sagittal, (110, 150))
    assert [one.level for one in outlines] == ["L3", "L4", "L5"]
    for one, expected in zip(outlines, measured, strict=True):
        points = np.vstack(one.rings_lps_mm)
        assert np.abs(points[:, 0]).max() < 1e-9
        assert labels.level_at(one.name_lps_mm) == [one.level]
        assert points[:, 1].min() == pytest.approx(expected.low_lps_mm[1], abs=1.5)
    beside = sagittal + np.array([[0.0, 0.0, 500.0], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]])
    assert label_outlines(labels, beside, (110, 150)) == ()


def test_outlines_of_the_largest_slice_take_little_memory() -> None:
    _, labels = three_levels()
    fine = np.array([[0.0, 0.0, 0.0], [0.05, 0.0, -50.0], [0.0, -0.05, 30.0]])
    tracemalloc.start()
    try:
        outlines = label_outlines(labels, fine, (2048, 2048))
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert len(outlines) == 3
    assert peak < 2**27


def test_distances_to_the_surface_of_a_label_are_signed() -> None:
    labels = np.zeros((20, 20, 20), dtype=np.uint8)
    labels[5:15, 5:15, 5:15] = CLASS_OF_LEVEL["L3"]
    volume = LabelVolume(labels=labels, lps_from_ijk=np.eye(4), voxel_mm=1.0)
    # The cube reaches from 4.5 to 14.5 mm.
    points = [[9.5, 9.5, 4.5], [9.5, 9.5, 2.5], [9.5, 9.5, 7.5], [9.5, 9.5, -10.5]]
    assert volume.distance_mm("L3", points) == pytest.approx([0.0, 2.0, -3.0, 15.0], abs=0.6)
