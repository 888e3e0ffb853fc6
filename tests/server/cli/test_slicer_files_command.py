"""Files of 3D Slicer on the command line: landmarks, sweeps and a start in, a registration and a plan out."""

import json
from pathlib import Path

import numpy as np
import pytest
import SimpleITK as sitk  # noqa: N813  its documentation names it so
from typer.testing import CliRunner

from server.cli import app
from server.cli.landmark_rows import read_landmarks
from server.slicer_file import Markup, MarkupKind, markups_from_bytes, markups_to_bytes
from tests.server.cli.register_words import typed, written
from tests.tracker.registration.constellations import VERTEBRA, touched
from tracker.errors import InvalidInput, NavigationError
from tracker.geometry import Array
from tracker.plan import Channel, Landmark, PlanDocument, PlannedChannel, VertebraPlan, plan_to_mapping


def marked(
    path: Path, points_mm: Array, names: str = "", kind: MarkupKind = MarkupKind.POINTS, system: str = "LPS"
) -> Path:
    labels = tuple(names) or ("",) * len(points_mm)
    flipped = points_mm * ([1, 1, 1] if system == "LPS" else [-1, -1, 1])
    content = markups_to_bytes([Markup(kind=kind, name="", points_lps_mm=flipped, labels=labels)])
    path.write_bytes(content.replace(b'"LPS"', f'"{system}"'.encode()))
    return path


@pytest.mark.parametrize("system", ["LPS", "RAS"])
def test_landmarks_of_slicer_give_the_registration_of_their_numbers(system: str, tmp_path: Path) -> None:
    truth = touched(VERTEBRA, np.random.default_rng(3))
    fixed = marked(tmp_path / "ct.mrk.json", truth.fixed_mm, "abcdef", system=system)
    moving = written(tmp_path / "tip.csv", truth.moving_mm[::-1], names="fedcba")
    transform = tmp_path / "out" / "registration.tfm"
    status, text = typed("points", "--fixed", fixed, "--moving", moving, "--transform", transform, "--json")
    assert status == 0
    assert np.array(json.loads(text)["fixed_from_moving"]) == pytest.approx(
        truth.fixed_from_moving.matrix, abs=1e-6
    )
    moving_from_fixed = sitk.ReadTransform(str(transform))
    assert moving_from_fixed.TransformPoint(truth.fixed_mm[2].tolist()) == pytest.approx(
        truth.moving_mm[2], abs=1e-6
    )


def test_no_transform_is_written_of_a_registration_over_its_limit(tmp_path: Path) -> None:
    truth = touched(VERTEBRA, np.random.default_rng(4), 0.5)
    fixed, moving = (
        written(tmp_path / f"{name}.csv", points)
        for name, points in (("f", truth.fixed_mm), ("m", truth.moving_mm))
    )
    transform = tmp_path / "registration.tfm"
    status, _ = typed(
        "points", "--fixed", fixed, "--moving", moving, "--transform", transform, "--max-fre-mm", "0.01"
    )
    assert status == 1
    assert not transform.exists()


def test_a_curve_is_a_sweep_without_names(tmp_path: Path) -> None:
    rows = read_landmarks(marked(tmp_path / "c.mrk.json", VERTEBRA, "aabbcc", MarkupKind.CURVE))
    assert np.array_equal(rows.points_mm, VERTEBRA)
    assert rows.labels == ()


def test_two_points_of_one_name_and_two_lists_are_rejected(tmp_path: Path) -> None:
    with pytest.raises(InvalidInput, match="two points named 'a'"):
        read_landmarks(marked(tmp_path / "twice.mrk.json", VERTEBRA, "abcdea"))
    both = tmp_path / "both.mrk.json"
    one = markups_from_bytes(marked(both, VERTEBRA).read_bytes(), name="it")
    both.write_bytes(markups_to_bytes([*one, *one]))
    with pytest.raises(InvalidInput, match="has 2 point lists"):
        read_landmarks(both)


def planned(path: Path) -> Path:
    channel = Channel(
        name="L3 left",
        entry_in_vertebra_mm=np.array([15, 30, 5]),
        target_in_vertebra_mm=np.array([3, -10, 5]),
        radius_mm=3.0,
    )
    vertebra = VertebraPlan(
        name="L3",
        channels=(PlannedChannel(side="left", channel=channel),),
        landmarks=(Landmark(name="facet", point_lps_mm=np.array([18.0, 2.0, 12.0])),),
    )
    plan = plan_to_mapping(PlanDocument(vertebrae=(vertebra,)))
    path.write_text(json.dumps({"format": "coaxial plan", "plan": plan}), encoding="utf-8")
    return path


def in_plan(plan: Path, output: Path) -> tuple[int, str]:
    result = CliRunner().invoke(app, ["plan", "markups", str(plan), "--output", str(output)])
    if isinstance(result.exception, NavigationError):
        return 2, result.exception.code
    return result.exit_code, result.output


def test_an_exported_plan_becomes_markups(tmp_path: Path) -> None:
    output = tmp_path / "plan.mrk.json"
    status, text = in_plan(planned(tmp_path / "plan.json"), output)
    assert status == 0, text
    assert "L3 landmarks, L3 left channel" in text
    points, line = markups_from_bytes(output.read_bytes(), name="it")
    assert points.points_lps_mm.tolist() == [[18.0, 2.0, 12.0]]
    assert line.points_lps_mm.tolist() == [[15.0, 30.0, 5.0], [3.0, -10.0, 5.0]]


def test_what_is_no_plan_or_has_another_name_is_rejected(tmp_path: Path) -> None:
    plan, output = planned(tmp_path / "plan.json"), tmp_path / "plan.mrk.json"
    assert in_plan(plan, tmp_path / "plan.json2") == (2, "MARKUPS_NAME_INVALID")
    assert in_plan(tmp_path / "missing.json", output) == (2, "PLAN_FILE_INVALID")
    empty = tmp_path / "empty.json"
    for content in ("{", "[]", '{"plan": {"format_version": 2, "vertebrae": []}}'):
        empty.write_text(content, encoding="utf-8")
        assert in_plan(empty, output) == (2, "PLAN_FILE_INVALID"), content
    assert not output.exists()


def test_hdf5_is_neither_written_nor_read_and_named_as_the_reason(tmp_path: Path) -> None:
    points = written(tmp_path / "p.csv", VERTEBRA)
    out = tmp_path / "out.h5"
    assert typed("points", "--fixed", points, "--moving", points, "--transform", out) == (2, "")
    assert not out.exists()
    start, mesh = tmp_path / "start.h5", tmp_path / "bone.ply"
    sitk.WriteTransform(sitk.Euler3DTransform(), str(start))
    mesh.write_bytes(b"unread")
    status, text = typed("surface", "--surface", mesh, "--points", points, "--start", start)
    assert status == 2
    assert "it is an HDF5 file (.h5)" in text
