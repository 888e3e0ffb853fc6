"""Objects of a plan lie in the patient to the micrometre, belong to the CT's study; others read them."""

import dataclasses
import logging
import subprocess
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import highdicom as hd
import numpy as np
import pytest
import trimesh
from pydicom.dataset import Dataset

from server.imaging.container import Entry
from server.imaging.dicom_objects import read_source
from server.imaging.dicom_objects.filling import filled
from server.imaging.dicom_objects.source import IDENTITY
from server.imaging.labels.segmentation import read_segmentation
from tests.dicom_tools import dicom_tool
from tests.server.imaging.made_ct import NAME, SERIES, SPACE
from tests.server.imaging.made_study import (
    STUDY,
    enhanced_study,
    frames_of_segmentation,
    labels_of,
    made_study,
    points_of,
    segmented_points,
    source_of,
    stl_corners,
    written,
)
from tests.tracker.plan.test_plan_document import document
from tests.tracker.plan.test_screw import shifted
from tracker.errors import InvalidInput
from tracker.geometry import Array
from tracker.plan import PlanDocument, Surface, channel_from_points

MICROMETRE = 1e-3
TURN = np.radians(20.0)
STACKS: dict[str, dict[str, Any]] = {
    "axial": {},
    "oblique": {"directions": (np.cos(TURN), np.sin(TURN), 0, -np.sin(TURN), np.cos(TURN), 0)},
    "sagittal": {"directions": (0, 1, 0, 0, 0, -1)},
    "coronal": {"directions": (1, 0, 0, 0, 0, -1)},
    "feet-first": {"directions": (-1, 0, 0, 0, 1, 0)},
    "reversed": {"step_lps": (0, 0, -2.0)},
}
TILTED: dict[str, Any] = {
    "directions": (1, 0, 0, 0, np.cos(TURN), -np.sin(TURN)),
    "step_lps": (0, 0, 2.0),
}


@pytest.mark.parametrize("stack", STACKS.values(), ids=STACKS.keys())
def test_each_labelled_voxel_is_at_its_place_and_names_its_slice(
    tmp_path: Path, stack: dict[str, Any]
) -> None:
    made = made_study(**stack)
    source = source_of(tmp_path, made)
    labels = labels_of(source)
    frames = frames_of_segmentation(written(tmp_path, source, PlanDocument(), labels=labels)["bone"])
    for level in ("L3", "L4"):
        truth = points_of(labels, level)
        assert len(truth) > 50
        assert segmented_points(frames, level) == pytest.approx(truth, abs=MICROMETRE)
    place = {one.SOPInstanceUID: np.array(one.ImagePositionPatient, float) for one in made.slices}
    for frame in frames:
        assert frame.position_mm == pytest.approx(place[frame.source_uid], abs=MICROMETRE)


def test_frames_of_one_file_are_named_by_their_number(tmp_path: Path) -> None:
    source = read_source(enhanced_study(tmp_path / "ct"))
    labels = labels_of(source)
    found = written(tmp_path, source, document(), labels=labels)
    frames = frames_of_segmentation(found["bone"])
    assert segmented_points(frames, "L3") == pytest.approx(points_of(labels, "L3"), abs=MICROMETRE)
    (image,) = source.images
    for group, frame in zip(found["bone"].PerFrameFunctionalGroupsSequence, frames, strict=True):
        reference = group.DerivationImageSequence[0].SourceImageSequence[0]
        own = image.PerFrameFunctionalGroupsSequence[int(reference.ReferencedFrameNumber) - 1]
        place = np.array(own.PlanePositionSequence[0].ImagePositionPatient, float)
        assert place == pytest.approx(frame.position_mm, abs=MICROMETRE)
    names = [item for item in items(found["report"]) if item.ValueType == "IMAGE"]
    assert {int(one.ReferencedSOPSequence[0].ReferencedFrameNumber) for one in names} == {12}


def test_other_readers_see_the_same_volume(tmp_path: Path) -> None:
    source = source_of(tmp_path, made_study(**STACKS["oblique"]))
    labels = labels_of(source)
    written(tmp_path, source, PlanDocument(), labels=labels)
    path = tmp_path / "bone.dcm"
    volume = hd.seg.segread(path).get_volume(combine_segments=True)
    for number, level in enumerate(("L3", "L4"), start=1):
        index = np.argwhere(volume.array == number)
        points = volume.map_indices_to_reference(index)
        assert len(points) == len(points_of(labels, level))
        assert points.mean(axis=0) == pytest.approx(points_of(labels, level).mean(axis=0), abs=MICROMETRE)
    own = read_segmentation(Entry(size=1, open=lambda: path.open("rb")), {})
    assert np.count_nonzero(own.labels) == np.count_nonzero(labels.labels)
    assert own.lps_from_ijk[:3, :3] == pytest.approx(source.stack.lps_from_ijk[:3, :3], abs=MICROMETRE)


def test_a_segmentation_on_tilted_slices_is_refused_but_not_the_models(tmp_path: Path) -> None:
    source = source_of(tmp_path, made_study(**TILTED))
    with pytest.raises(InvalidInput, match=r"tilted by 20\.0 deg") as raised:
        written(tmp_path, source, document(), labels=labels_of(source))
    assert raised.value.code == "DICOM_SEG_TILTED"
    assert len(written(tmp_path, source, document())) == 3


def test_labels_of_another_ct_are_refused(tmp_path: Path) -> None:
    source = source_of(tmp_path, made_study())
    other = source_of(tmp_path / "other", made_study(pixel_mm=(0.5, 0.5)))
    with pytest.raises(InvalidInput) as raised:
        written(tmp_path, source, document(), labels=labels_of(other))
    assert raised.value.code == "DICOM_LABELS_OFF_GRID"


def distances_mm(points: Array, start: Array, axis: Array) -> tuple[Array, Array]:
    """Places of points (n, 3) along an axis, and their distances from it."""
    along = (points - start) @ axis
    return along, np.linalg.norm(points - start - along[:, None] * axis, axis=1)


@pytest.mark.parametrize(
    ("name", "radius_mm", "length_mm"), [("L3 left channel", 2.0, 45.0), ("L3 left screw", 2.5, 40.0)]
)
def test_a_model_is_a_closed_cylinder_on_the_channel(
    tmp_path: Path, name: str, radius_mm: float, length_mm: float
) -> None:
    one = written(tmp_path, source_of(tmp_path, made_study()), document())[name]
    content = one.EncapsulatedDocument[: one.EncapsulatedDocumentLength]
    channel = shifted(0.0)
    points = stl_corners(content).reshape(-1, 3)
    along, away = distances_mm(points, channel.entry_in_vertebra_mm, channel.axis_in_vertebra)
    assert np.abs(np.minimum(along, length_mm - along)).max() < MICROMETRE
    on_axis = away < 0.5 * radius_mm
    assert away[on_axis].max() < MICROMETRE
    assert np.abs(away[~on_axis] - radius_mm).max() < MICROMETRE
    (tmp_path / "it.stl").write_bytes(content)
    mesh = trimesh.load_mesh(tmp_path / "it.stl")
    assert mesh.is_watertight
    assert mesh.is_winding_consistent
    # Positive for faces that are counter-clockwise from outside; a polygon of 96 corners lacks 0.07 %.
    assert mesh.volume == pytest.approx(np.pi * radius_mm**2 * length_mm, rel=1e-3)
    assert (one.Modality, one.MIMETypeOfEncapsulatedDocument) == ("M3D", "model/stl")
    assert one.MeasurementUnitsCodeSequence[0].CodeValue == "mm"


def test_a_bone_surface_is_a_model_too(tmp_path: Path) -> None:
    made = trimesh.creation.icosphere(radius=8.0)
    mesh = trimesh.Trimesh(made.vertices + np.array([1.0, 2.0, 303.123456]), made.faces, process=False)
    surface = Surface(vertices_mm=mesh.vertices, faces=mesh.faces)
    one = written(tmp_path, source_of(tmp_path, made_study()), document(), surfaces={"L3": surface})[
        "L3 bone"
    ]
    corners = stl_corners(one.EncapsulatedDocument)
    assert corners == pytest.approx(mesh.triangles, abs=MICROMETRE)


@pytest.mark.parametrize("stack", STACKS.values(), ids=STACKS.keys())
def test_a_closed_surface_is_segmented_where_it_is(tmp_path: Path, stack: dict[str, Any]) -> None:
    source = source_of(tmp_path, made_study(pixel_mm=(0.75, 0.75), **stack))
    affine = source.stack.lps_from_ijk
    middle = affine[:3, :3] @ [11.3, 9.6, 5.4] + affine[:3, 3]
    mesh = trimesh.creation.box(extents=(7.1, 6.3, 5.9))
    surface = Surface(vertices_mm=mesh.vertices + middle, faces=mesh.faces)
    found = written(tmp_path, source, PlanDocument(), surfaces={"L2": surface})
    points = segmented_points(frames_of_segmentation(found["bone"]), "L2")
    k, j, i = np.meshgrid(*(np.arange(size) for size in (12, 20, 24)), indexing="ij")
    every = np.stack([i, j, k], axis=-1).reshape(-1, 3) @ affine[:3, :3].T + affine[:3, 3]
    truth = every[(np.abs(every - middle) < [3.55, 3.15, 2.95]).all(axis=1)]
    assert len(truth) > 100
    assert sorted(points.round(3).tolist()) == sorted(truth.round(3).tolist())
    (segment,) = found["bone"].SegmentSequence
    assert segment.SegmentAlgorithmName == "surface, filled"
    path = tmp_path / "bone.dcm"
    own = read_segmentation(Entry(size=1, open=lambda: path.open("rb")), {})
    assert np.count_nonzero(own.labels) == len(truth)


def test_a_row_of_voxels_through_an_edge_is_filled_once(tmp_path: Path) -> None:
    source = source_of(tmp_path, made_study(pixel_mm=(1.0, 1.0), spacing_mm=1.0))
    # The diagonals of the two faces across the rows pass through centres of voxels.
    middle = source.stack.lps_from_ijk[:3] @ [11.5, 7.5, 5.5, 1.0]
    mesh = trimesh.creation.box(extents=(6.0, 4.0, 4.0))
    inside = filled(source, Surface(vertices_mm=mesh.vertices + middle, faces=mesh.faces))
    truth = np.zeros_like(inside)
    truth[4:8, 6:10, 9:15] = True
    assert np.array_equal(inside, truth)


def test_labels_take_precedence_and_an_open_surface_or_tilted_slices_give_a_model_only(
    tmp_path: Path,
) -> None:
    source = source_of(tmp_path, made_study())
    middle = source.stack.lps_from_ijk[:3] @ [11.0, 9.0, 5.0, 1.0]
    mesh = trimesh.creation.box(extents=(7.1, 6.3, 5.9))
    surface = Surface(vertices_mm=mesh.vertices + middle, faces=mesh.faces)
    labels = labels_of(source)
    both = written(tmp_path, source, PlanDocument(), labels=labels, surfaces={"L3": surface})
    frames = frames_of_segmentation(both["bone"])
    assert segmented_points(frames, "L3") == pytest.approx(points_of(labels, "L3"), abs=MICROMETRE)
    cut = Surface(vertices_mm=surface.vertices_mm, faces=surface.faces[1:])
    assert set(written(tmp_path, source, PlanDocument(), surfaces={"L3": cut})) == {"L3 bone"}
    tilted = source_of(tmp_path / "tilted", made_study(**TILTED))
    assert set(written(tmp_path, tilted, PlanDocument(), surfaces={"L3": surface})) == {"L3 bone"}


def items(one: Dataset) -> list[Dataset]:
    """All content items of a report."""
    found = []
    for item in one.get("ContentSequence") or []:
        found += [item, *items(item)]
    return found


def group_of(report: Dataset, name: str) -> Dataset:
    """The group of measurements with this tracking identifier."""
    return next(
        item
        for item in items(report)
        if any(inner.get("TextValue") == name for inner in item.get("ContentSequence") or [])
    )


def codes_of(found: Iterable[Dataset]) -> set[str]:
    """Values of the coded items among these."""
    return {one.ConceptCodeSequence[0].CodeValue for one in found if "ConceptCodeSequence" in one}


def code_of(item: Dataset) -> str:
    return str(item.ConceptNameCodeSequence[0].CodeValue)


def measurements(group: Dataset) -> dict[str, Dataset]:
    """The measurements of a group by their code."""
    return {code_of(item): item for item in group.ContentSequence if item.ValueType == "NUM"}


def number(item: Dataset) -> tuple[float, str]:
    """Value and unit of a measurement."""
    (measured,) = item.MeasuredValueSequence
    return float(measured.NumericValue), measured.MeasurementUnitsCodeSequence[0].CodeValue


def numbers(group: Dataset) -> dict[str, tuple[float, str]]:
    """Value and unit by the code of the measurement."""
    return {code: number(item) for code, item in measurements(group).items()}


def uncertainty_of(measurement: Dataset) -> tuple[float, str, str] | None:
    """Value, unit and kind of the range of uncertainty of a measurement; None if it states none."""
    for one in measurement.get("ContentSequence") or []:
        if code_of(one) == "371884006" and one.RelationshipType == "HAS PROPERTIES":
            (kind,) = one.ContentSequence
            assert (code_of(kind), kind.RelationshipType) == ("121401", "HAS CONCEPT MOD")
            return *number(one), str(kind.ConceptCodeSequence[0].CodeValue)
    return None


def test_the_report_states_what_the_plan_states(tmp_path: Path) -> None:
    report = written(tmp_path, source_of(tmp_path, made_study()), document())["report"]
    assert report.ContentTemplateSequence[0].TemplateIdentifier == "1500"
    used = document().vertebrae[0].pedicles[0].used
    of_pedicle = group_of(report, "L3 left pedicle")
    assert numbers(of_pedicle) == {
        "103355008": (7.5, "mm"),  # width, corrected
        "121207": (12.0, "mm"),
        "410668003": (50.0, "mm"),
        "transverse": (used.transverse_deg, "deg"),
        "sagittal": (used.sagittal_deg, "deg"),
    }
    (width,) = [one for one in items(of_pedicle) if "corrected" in codes_of(one.get("ContentSequence") or [])]
    assert width.ConceptNameCodeSequence[0].CodeValue == "103355008"
    # Each value of the CT has its standard deviation, in its unit; that of a person has none.
    sd = document().vertebrae[0].pedicles[0].measured.sd
    assert {code: uncertainty_of(item) for code, item in measurements(of_pedicle).items()} == {
        "103355008": None,
        "121207": (sd.height_mm, "mm", "386136009"),
        "410668003": (sd.length_mm, "mm", "386136009"),
        "transverse": (sd.transverse_deg, "deg", "386136009"),
        "sagittal": (sd.sagittal_deg, "deg", "386136009"),
    }
    (screw,) = document().vertebrae[0].channels[0].screws
    assert numbers(group_of(report, "L3 left screw")) == {
        "81827009": (5.0, "mm"),
        "410668003": (40.0, "mm"),
        **{
            f"wall-{wall}": (pytest.approx(getattr(screw.clearance, f"{wall}_mm"), abs=1e-9), "mm")
            for wall in ("medial", "lateral", "superior", "inferior", "anterior")
        },
        "breach": (screw.clearance.breach_mm, "mm"),
    }
    assert numbers(group_of(report, "L3 left channel")) == {
        "81827009": (4.0, "mm"),
        "410668003": (45.0, "mm"),
        "transverse": (0.0, "deg"),
        "sagittal": (0.0, "deg"),
    }


def test_an_oblique_channel_has_its_angles_and_its_screw_ends_at_its_tip(tmp_path: Path) -> None:
    vertebra = document().vertebrae[0]
    entry, target = np.array([10.0, 15.0, -3.0]), np.array([4.0, -30.0, 5.0])
    channel = channel_from_points("oblique", entry_lps_mm=entry, target_lps_mm=target, diameter_mm=4.0)
    planned = dataclasses.replace(vertebra.channels[0], channel=channel)
    plan = PlanDocument(vertebrae=(dataclasses.replace(vertebra, channels=(planned,)),))
    found = written(tmp_path, source_of(tmp_path, made_study()), plan)
    measured = numbers(group_of(found["report"], "L3 left channel"))
    # 6 mm to the middle and 8 mm to the head on 45 mm forwards.
    assert measured["transverse"] == (pytest.approx(7.594643, abs=1e-6), "deg")
    assert measured["sagittal"] == (pytest.approx(10.080598, abs=1e-6), "deg")
    (line,) = [
        one for one in items(group_of(found["report"], "L3 left screw")) if one.ValueType == "SCOORD3D"
    ]
    tip = entry + 40.0 * (target - entry) / np.linalg.norm(target - entry)
    assert np.array(line.GraphicData).reshape(2, 3) == pytest.approx(np.stack([entry, tip]), abs=MICROMETRE)
    corners = stl_corners(found["L3 left screw"].EncapsulatedDocument).reshape(-1, 3)
    assert np.linalg.norm(corners - tip, axis=1).min() < MICROMETRE


def test_level_side_and_places_are_coded(tmp_path: Path) -> None:
    report = written(tmp_path, source_of(tmp_path, made_study()), document())["report"]
    group = group_of(report, "L3 left channel")
    (site,) = [
        one for one in group.ContentSequence if one.ConceptNameCodeSequence[0].CodeValue == "363698007"
    ]
    assert site.ConceptCodeSequence[0].CodeValue == "36470004"  # L3 in SNOMED CT
    assert site.ContentSequence[0].ConceptCodeSequence[0].CodeValue == "7771000"  # left
    (line,) = [one for one in items(group) if one.ValueType == "SCOORD3D"]
    ends = np.array(line.GraphicData).reshape(2, 3)
    channel = shifted(0.0)
    truth = np.stack([channel.entry_in_vertebra_mm, channel.target_in_vertebra_mm])
    assert ends == pytest.approx(truth, abs=MICROMETRE)
    assert line.ReferencedFrameOfReferenceUID == SPACE


def test_all_objects_belong_to_the_study_and_patient_of_the_ct(tmp_path: Path) -> None:
    made = made_study()
    source = source_of(tmp_path, made)
    found = written(tmp_path, source, document(), labels=labels_of(source))
    assert set(found) == {"bone", "L3 left channel", "L3 left screw", "report"}
    for one in found.values():
        assert one.StudyInstanceUID == STUDY
        for keyword in IDENTITY:
            assert one.get(keyword) == made.slices[0].get(keyword), keyword
    assert {found[name].FrameOfReferenceUID for name in ("bone", "L3 left channel")} == {SPACE}
    assert found["bone"].ReferencedSeriesSequence[0].SeriesInstanceUID == SERIES
    assert len({one.SOPInstanceUID for one in found.values()}) == 4
    assert found["L3 left screw"].SeriesInstanceUID == found["L3 left channel"].SeriesInstanceUID
    again = written(tmp_path, source, document(), labels=labels_of(source))
    assert again["bone"].SOPInstanceUID != found["bone"].SOPInstanceUID
    tracked = [one["bone"].SegmentSequence[0].TrackingUID for one in (found, again)]
    assert tracked[0] == tracked[1]


@pytest.mark.parametrize("keyword", ["StudyInstanceUID", "FrameOfReferenceUID", "SOPInstanceUID"])
def test_a_ct_without_its_identifiers_is_refused(tmp_path: Path, keyword: str) -> None:
    made = made_study()
    del made.slices[3][keyword]
    with pytest.raises(InvalidInput, match=f"1 of 12 files .* {keyword}"):
        source_of(tmp_path, made)


def test_slices_of_two_studies_are_refused(tmp_path: Path) -> None:
    made = made_study()
    made.slices[3].StudyInstanceUID = SERIES
    with pytest.raises(InvalidInput, match="2 studies"):
        source_of(tmp_path, made)


def test_a_plan_without_anything_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InvalidInput, match="no pedicle and no channel"):
        written(tmp_path, source_of(tmp_path, made_study()), PlanDocument())


def test_the_patient_is_in_no_log_even_with_an_invalid_name(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    made = made_study()
    for one in made.slices:
        one.PatientName, one.PatientSex, one.StudyDate = NAME.replace("^", " "), "Q", "yesterday"
    with caplog.at_level(logging.DEBUG):
        source = source_of(tmp_path, made)
        found = written(tmp_path, source, document(), labels=labels_of(source))
    assert found["report"].PatientName == "Quibble Hortensia"
    assert "Quibble" not in caplog.text


def test_dcmtk_reads_all_of_them_without_a_complaint(tmp_path: Path) -> None:
    source = source_of(tmp_path, made_study())
    written(tmp_path, source, document(), labels=labels_of(source))
    for path in tmp_path.glob("*.dcm"):
        dumped = subprocess.run([dicom_tool("dcmdump"), "-q", path], check=True, capture_output=True)
        assert not dumped.stderr, path.name
    shown = subprocess.run(
        [dicom_tool("dsrdump"), "+Pn", tmp_path / "report.dcm"], check=True, capture_output=True
    )
    assert not shown.stderr
    assert b'"Width")="7.5" (mm,UCUM,"mm")' in shown.stdout
    assert b'"+/-, range of measurement uncertainty")="' in shown.stdout
    assert b'"Derivation")=(386136009,SCT,"Standard Deviation")' in shown.stdout
    assert b'"Grade of breach by Gertzbein and Robbins")=(grade-A,99COAXIAL,"Grade A")' in shown.stdout
