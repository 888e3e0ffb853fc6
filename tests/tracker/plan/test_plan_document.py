"""The plan document survives a round trip, and errors name their place."""

import dataclasses
import json
from typing import Any

import numpy as np
import pytest

from tests.tracker.plan.test_screw import pedicle, shifted
from tracker.errors import PlanError, Remark
from tracker.plan import (
    Landmark,
    PedicleRecord,
    PlanDocument,
    PlannedChannel,
    VertebraPlan,
    Volume,
    draw_reference,
    plan_from_mapping,
    plan_screw,
    plan_to_mapping,
    propose_middle,
    propose_slice,
)
from tracker.plan.document import FORMAT_VERSION, plain, validate_plan
from tracker.plan.document.changes import channel_name, recomputed, with_landmarks
from tracker.plan.document.validation import MAX_LANDMARKS
from tracker.plan.pedicle.remarks import canal_remarks


def volume() -> Volume:
    affine = np.diag([0.5, 0.5, 2.0, 1.0])
    affine[:3, 3] = [-30.0, -50.0, -21.0]
    return Volume(hu=np.full((20, 180, 120), 100, np.int16), lps_from_ijk=affine)


def document() -> PlanDocument:
    screw = plan_screw(volume(), shifted(0.0), pedicle(), diameter_mm=5.0, length_mm=40.0)
    reference = draw_reference(
        volume(), slice_index=10, middle_lps_mm=(-14.0, 0.0, 0.0), apart_mm=7.5, channels=[shifted(0.0)]
    )
    vertebra = VertebraPlan(
        name="L3",
        references=(reference,),
        pedicles=(PedicleRecord(measured=pedicle(), corrected={"width_mm": 7.5}),),
        channels=(PlannedChannel(side="left", channel=shifted(0.0), by_hand=True, screws=(screw,)),),
        landmarks=(Landmark(name="spinous process", point_lps_mm=np.array([-14.0, 30.0, -10.0])),),
    )
    return PlanDocument(vertebrae=(vertebra, VertebraPlan(name="L4")))


def test_a_plan_survives_json() -> None:
    written = plan_to_mapping(document())
    again = plan_from_mapping(json.loads(json.dumps(written)))
    assert plan_to_mapping(again) == written
    assert again.vertebrae[0].pedicles[0].corrected == {"width_mm": 7.5}


def changed(path: tuple[Any, ...], value: object) -> dict[str, Any]:
    mapped = json.loads(json.dumps(plan_to_mapping(document())))
    inner = mapped
    for key in path[:-1]:
        inner = inner[key]
    inner[path[-1]] = value
    return dict(mapped)


FIRST = ("vertebrae", 0)


@pytest.mark.parametrize(
    ("mapped", "said"),
    [
        pytest.param([], "is no mapping", id="a-list"),
        pytest.param(changed(("format_version",), 99), "format version 99", id="of-a-later-program"),
        pytest.param(changed((*FIRST, "nmae"), "L3"), "unknown keys nmae", id="a-slip-of-the-pen"),
        pytest.param(changed((*FIRST, "name"), 3), "vertebrae[0].name is 3", id="a-number-for-a-name"),
        pytest.param(changed((*FIRST, "name"), "L4"), "different ones", id="one-name-twice"),
        pytest.param(
            changed((*FIRST, "pedicles", 0, "measured", "width_mm"), float("nan")),
            "finite",
            id="not-a-number",
        ),
        pytest.param(
            changed((*FIRST, "pedicles", 0, "measured", "side"), "port"), "left, right", id="no-such-side"
        ),
        pytest.param(
            changed((*FIRST, "pedicles", 0, "corrected"), {"width_mm": 400.0}), "1 to 30", id="out-of-range"
        ),
        pytest.param(
            changed((*FIRST, "channels", 0, "channel", "radius_mm"), -1.0), "radius", id="no-cylinder"
        ),
        pytest.param(
            changed((*FIRST, "channels", 0, "channel", "entry_in_vertebra_mm"), [1.0, 2.0]),
            "cannot be read",
            id="2-d",
        ),
        pytest.param(changed((*FIRST, "landmarks", 0, "name"), " "), "needed a name", id="nameless-landmark"),
        pytest.param(
            changed((*FIRST, "landmarks", 0, "point_lps_mm"), [1.0, 2.0]), "shape (2,)", id="landmark-in-2-d"
        ),
        pytest.param(
            changed(
                (*FIRST, "landmarks"),
                [{"name": name, "point_lps_mm": [0.0, 0.0, 0.0]} for name in ("SAP left", "sap  Left ")],
            ),
            "'sap left' is there 2 times",
            id="one-landmark-twice",
        ),
    ],
)
def test_a_plan_that_cannot_be_read_is_rejected_with_the_place(mapped: object, said: str) -> None:
    with pytest.raises(PlanError) as caught:
        plan_from_mapping(mapped)
    assert said in caught.value.message


@pytest.mark.parametrize(
    "mapped",
    [
        pytest.param(changed(("format_version",), "9" * 100_000), id="version"),
        pytest.param(changed(("vertebrae",), [{"name": "L" * 99_000}] * 99), id="names"),
        pytest.param(changed((*FIRST, "name"), " " * 100_000), id="name"),
        pytest.param(
            changed((*FIRST, "pedicles", 0, "corrected"), {"w" * 100_000: "wide"}), id="name-of-a-correction"
        ),
    ],
)
def test_rejected_input_is_not_repeated_at_length(mapped: object) -> None:
    with pytest.raises(PlanError) as caught:
        plan_from_mapping(mapped)
    assert len(caught.value.message) < 2000
    assert len(str(caught.value.context)) < 500


def test_a_plan_of_the_first_version_is_read_as_one_without_landmarks() -> None:
    old = changed(("format_version",), 1)
    for vertebra in old["vertebrae"]:
        del vertebra["landmarks"]
    plan = plan_from_mapping(old)
    assert plan.vertebrae[0].landmarks == ()
    assert plan_to_mapping(plan)["format_version"] == FORMAT_VERSION
    assert [one.name for one in plan.vertebrae] == ["L3", "L4"]


def test_warnings_of_a_pedicle_are_read_with_their_values_and_those_of_older_plans_as_sentences() -> None:
    remark = canal_remarks(8.0, 7.0)[0]
    place = ("vertebrae", 0, "pedicles", 0, "measured", "warnings")
    (read,) = plan_from_mapping(changed(place, [plain(remark)])).vertebrae[0].pedicles[0].measured.warnings
    assert read == remark
    old = changed(place, ["its section is oblique"])
    old["format_version"] = 2
    (read,) = plan_from_mapping(old).vertebrae[0].pedicles[0].measured.warnings
    assert read == Remark(code="PEDICLE_WARNING", message="its section is oblique")


def test_landmarks_are_replaced_as_a_whole_and_leave_all_else_alone() -> None:
    points = {"tip of the spinous process": [-14.0, 30.0, -10.0], "left mammillary process": [9.0, 2.0, -4.0]}
    landmarks = [Landmark(name=name, point_lps_mm=np.array(at)) for name, at in points.items()]
    plan = with_landmarks(document(), "L3", landmarks, volume=volume())
    assert {one.name: one.point_lps_mm.tolist() for one in plan.vertebrae[0].landmarks} == points
    emptied = with_landmarks(plan, "L3", [], volume=volume())
    without = dataclasses.replace(document().vertebrae[0], landmarks=())
    assert (
        plan_to_mapping(emptied)["vertebrae"][0]
        == plan_to_mapping(PlanDocument(vertebrae=(without,)))["vertebrae"][0]
    )


def test_a_landmark_beside_the_ct_is_rejected_in_a_change_and_in_a_whole_plan() -> None:
    far = Landmark(name="tip", point_lps_mm=np.array([0.0, 0.0, 400.0]))
    with pytest.raises(PlanError, match=r"'tip' was set at \(0.0, 0.0, 400.0\) mm") as caught:
        with_landmarks(document(), "L3", [far], volume=volume())
    assert caught.value.code == "LANDMARK_OUTSIDE_CT"
    plan = PlanDocument(vertebrae=(VertebraPlan(name="L3", landmarks=(far,)),))
    with pytest.raises(PlanError, match="not within the CT"):
        recomputed(plan, volume=volume())


@pytest.mark.parametrize("count", [41, 40])
def test_more_landmarks_than_anybody_sets_are_rejected(count: int) -> None:
    landmarks = tuple(Landmark(name=f"{n}", point_lps_mm=np.zeros(3)) for n in range(count))
    plan = PlanDocument(vertebrae=(VertebraPlan(name="L3", landmarks=landmarks),))
    if count <= MAX_LANDMARKS:
        validate_plan(plan)
    else:
        with pytest.raises(PlanError, match="41 landmarks"):
            validate_plan(plan)


@pytest.mark.parametrize("name", ["L4/5", "..", ".", "L4\u202e", "L" * 41, ""])
def test_a_vertebra_that_no_address_could_name_is_rejected(name: str) -> None:
    with pytest.raises(PlanError):
        validate_plan(PlanDocument(vertebrae=(VertebraPlan(name=name),)))


def test_a_channel_is_called_after_the_longest_name_of_a_vertebra() -> None:
    name = "L" * 40
    channel = dataclasses.replace(shifted(0.0), name=channel_name(name, "right"))
    planned = PlannedChannel(side="right", channel=channel)
    plan = PlanDocument(vertebrae=(VertebraPlan(name=name, channels=(planned,)),))
    validate_plan(plan)
    back = plan_from_mapping(json.loads(json.dumps(plan_to_mapping(plan))))
    assert back.vertebrae[0].channels[0].channel.name == f"{'L' * 40} right"


@pytest.mark.parametrize("middle", [(9000.0, 0.0, 0.0), (-14.0, 60.0, 0.0)])
def test_lines_beside_the_slice_are_rejected_and_not_found_out_by_the_next_change(
    middle: tuple[float, float, float],
) -> None:
    with pytest.raises(PlanError, match="not on slice 10") as caught:
        draw_reference(volume(), slice_index=10, middle_lps_mm=middle, apart_mm=7.5)
    assert caught.value.code == "MIDDLE_OUTSIDE_CT"


def test_a_correction_keeps_what_was_measured_and_changes_what_is_used() -> None:
    record = PedicleRecord(
        measured=pedicle(), corrected={"width_mm": 6.0, "transverse_deg": 10.0, "length_mm": 45.0}
    )
    assert record.measured.width_mm == 8.0
    used = record.used
    assert (used.width_mm, used.height_mm, used.length_mm) == (6.0, 12.0, 45.0)
    assert np.linalg.norm(used.front_lps_mm - used.entry_lps_mm) == pytest.approx(45.0)
    # Ten degrees to the middle: on the left side to the patient's right.
    assert used.axis_lps[0] == pytest.approx(-np.sin(np.radians(10.0)))
    span = used.outline_lps_mm - used.isthmus_lps_mm
    assert np.abs(span @ used.axis_lps).max() < 1e-9
    assert np.linalg.norm(span, axis=1).min() == pytest.approx(3.0, abs=0.01)


def test_three_vertical_lines_at_the_measured_distance_in_mm_and_pixels() -> None:
    reference = document().vertebrae[0].references[0]
    middle, left, right = reference.lines
    assert [line.name for line in reference.lines] == ["middle", "left", "right"]
    assert left.ends_lps_mm[0, 0] - middle.ends_lps_mm[0, 0] == pytest.approx(7.5)
    assert middle.ends_lps_mm[0, 0] - right.ends_lps_mm[0, 0] == pytest.approx(7.5)
    assert np.ptp(middle.ends_px[:, 0]) == pytest.approx(0.0)
    assert left.ends_px[0, 0] - middle.ends_px[0, 0] == pytest.approx(15.0)
    assert reference.paths[0].ends_px == pytest.approx(np.array([[60.0, 130.0], [60.0, 40.0]]))


def test_the_slice_through_the_isthmus_is_proposed() -> None:
    assert propose_slice(volume(), [pedicle()]) in {10, 11}
    with pytest.raises(PlanError, match="0 pedicles"):
        propose_slice(volume(), [])
    with pytest.raises(PlanError, match="middle lies between 2"):
        propose_middle([pedicle()])
    with pytest.raises(PlanError, match="the CT has 20"):
        draw_reference(volume(), slice_index=20, middle_lps_mm=(0, 0, 0), apart_mm=5.0)
