"""`coaxial register points` as a person types it."""

import json
from pathlib import Path

import numpy as np
import pytest

from server.cli.landmark_rows import read_landmarks
from tests.server.cli.register_words import typed, written
from tests.tracker.registration.constellations import VERTEBRA, touched
from tracker.errors import InvalidInput


def test_the_motion_and_its_errors_come_out_as_json(tmp_path: Path) -> None:
    truth = touched(VERTEBRA, np.random.default_rng(1), 0.3)
    fixed = written(tmp_path / "f.csv", truth.fixed_mm, "x,y,z")
    moving = written(tmp_path / "m.csv", truth.moving_mm)
    status, text = typed("points", "--fixed", fixed, "--moving", moving, "--target-mm", "-12,-30,4", "--json")
    document = json.loads(text)
    assert status == 0
    motion = np.array(document["fixed_from_moving"])
    off = truth.moving_mm @ motion[:3, :3].T + motion[:3, 3] - truth.fixed_mm
    assert np.allclose(motion, truth.fixed_from_moving.matrix, atol=1.5)
    assert document["residuals_mm"] == pytest.approx(np.linalg.norm(off, axis=1).tolist(), abs=1e-6)
    assert document["fre_rms_mm"] == pytest.approx(np.sqrt((off**2).sum(axis=1).mean()), abs=1e-6)
    assert 0.2 < document["tre_expected_mm"] < 0.8
    assert document["targets"][0]["tre_stated_mm"] > document["tre_expected_mm"]
    assert document["gate"] == {"passed": True, "failures": []}


def test_several_targets_give_a_list_and_none_gives_nothing(tmp_path: Path) -> None:
    fixed = written(tmp_path / "f.csv", VERTEBRA)
    both = ("--target-mm", "0,0,0", "--target-mm=1 2 3")
    assert (
        len(json.loads(typed("points", "--fixed", fixed, "--moving", fixed, *both, "--json")[1])["targets"])
        == 2
    )
    alone = json.loads(typed("points", "--fixed", fixed, "--moving", fixed, "--json")[1])
    assert alone["tre_expected_mm"] is None


def test_without_json_there_is_a_table_with_each_point(tmp_path: Path) -> None:
    truth = touched(VERTEBRA, np.random.default_rng(2), 0.3)
    fixed = written(tmp_path / "f.csv", truth.fixed_mm, "name,x,y,z", "abcdef")
    moving = written(tmp_path / "m.csv", truth.moving_mm)
    words = ("points", "--fixed", fixed, "--moving", moving, "--exclude", "c", "--target-mm", "0,0,0")
    status, text = typed(*words)
    assert status == 0
    assert [line[0] for line in text.splitlines()[1:7]] == list("abcdef")
    assert "not used" in text.splitlines()[3]
    assert "At the target 0, 0, 0 mm" in text


def test_names_bring_rows_into_order(tmp_path: Path) -> None:
    fixed = written(tmp_path / "f.csv", VERTEBRA, "name,x,y,z", "abcdef")
    moving = written(tmp_path / "m.csv", VERTEBRA[::-1], "", "fedcba")
    status, text = typed("points", "--fixed", fixed, "--moving", moving, "--json")
    assert status == 0
    assert json.loads(text)["fre_rms_mm"] < 1e-6
    other = written(tmp_path / "n.csv", VERTEBRA, "", "abcdeg")
    assert typed("points", "--fixed", fixed, "--moving", other)[1].startswith(
        "POINTS_NAMES_DIFFER: the points f, g"
    )


@pytest.mark.parametrize(
    ("points", "code"),
    [
        pytest.param(VERTEBRA[:2], "POINTS_TOO_FEW", id="too-few"),
        pytest.param(np.outer(range(5), [9.0, 4.0, 1.0]), "POINTS_COLLINEAR", id="a-line"),
        pytest.param(VERTEBRA[[0, 2, 1, 3, 4, 5]], "POINTS_SWAPPED", id="swapped"),
        pytest.param(VERTEBRA * [1.0, 1.0, -1.0], "POINTS_", id="mirrored"),
    ],
)
def test_data_that_determine_no_motion_end_with_status_2(
    tmp_path: Path, points: np.ndarray, code: str
) -> None:
    fixed = written(tmp_path / "f.csv", VERTEBRA[: len(points)] if "LINEAR" not in code else points)
    status, text = typed(
        "points", "--fixed", fixed, "--moving", written(tmp_path / "m.csv", points), "--json"
    )
    assert status == 2
    assert text.startswith(code)


def test_a_limit_that_was_asked_for_ends_with_status_1(tmp_path: Path) -> None:
    truth = touched(VERTEBRA, np.random.default_rng(3), 0.8)
    fixed = written(tmp_path / "f.csv", truth.fixed_mm)
    moving = written(tmp_path / "m.csv", truth.moving_mm)
    words = ("points", "--fixed", fixed, "--moving", moving, "--json", "--target-mm", "0,-40,0")
    assert typed(*words)[0] == 0
    status, text = typed(*words, "--max-fre-mm", "0.2", "--max-tre-mm", "0.2")
    assert status == 1
    assert [one["code"] for one in json.loads(text)["gate"]["failures"]] == [
        "POINTS_FIT_TOO_LARGE",
        "POINTS_TARGET_UNCERTAIN",
    ]


def test_a_mistaken_landmark_ends_with_status_1_and_is_marked(tmp_path: Path) -> None:
    truth = touched(VERTEBRA, np.random.default_rng(4), 0.3)
    moving = truth.moving_mm.copy()
    moving[3] += [0.0, 6.0, 0.0]
    words = (
        "points",
        "--fixed",
        written(tmp_path / "f.csv", truth.fixed_mm, "name,x,y,z", "abcdef"),
        "--moving",
        written(tmp_path / "m.csv", moving, "name,x,y,z", "abcdef"),
    )
    status, text = typed(*words)
    assert status == 1
    assert [line[0] for line in text.splitlines() if line.endswith("outlier")] == ["d"]
    status, text = typed(*words, "--json")
    document = json.loads(text)
    assert status == 1
    assert [one["name"] for one in document["points"] if one["outlier"]] == ["d"]
    assert [one["code"] for one in document["gate"]["failures"]] == ["POINTS_FIT_TOO_LARGE", "POINT_STRAYS"]
    assert typed(*words, "--max-fre-mm", "9", "--max-left-out-mm", "9")[0] == 0
    assert typed(*words, "--exclude", "d")[0] == 0


def test_the_limits_are_those_of_the_settings_unless_others_are_given(tmp_path: Path) -> None:
    config = tmp_path / "config.yaml"
    config.write_text("registration: {max_fre_mm: 0.1, max_left_out_mm: 0.2}\n")
    truth = touched(VERTEBRA, np.random.default_rng(5), 0.3)
    words = (
        "points",
        "--fixed",
        written(tmp_path / "f.csv", truth.fixed_mm),
        "--moving",
        written(tmp_path / "m.csv", truth.moving_mm),
        "--json",
    )
    assert typed(*words)[0] == 0
    status, text = typed(*words, "--config", config)
    assert status == 1
    assert json.loads(text)["limits"] == {"max_fre_mm": 0.1, "max_left_out_mm": 0.2, "max_tre_mm": None}
    assert typed(*words, "--config", config, "--max-fre-mm", "2", "--max-left-out-mm", "5")[0] == 0


def test_what_four_landmarks_do_not_exclude_is_noted_and_stated(tmp_path: Path) -> None:
    four = VERTEBRA[[0, 1, 2, 4]]
    truth = touched(four, np.random.default_rng(3), 0.3)
    fixed, moving = written(tmp_path / "f.csv", four), written(tmp_path / "m.csv", truth.moving_mm)
    words = ("points", "--fixed", fixed, "--moving", moving, "--target-mm", "10,-44,4")
    status, text = typed(*words)
    assert status == 0
    assert "gross error of one landmark that the others do not exclude" in text
    document = json.loads(typed(*words, "--json")[1])
    assert "POINTS_OUTLIER_NOT_EXCLUDED" in [one["code"] for one in document["warnings"]]
    (target,) = document["targets"]
    assert target["tre_stated_mm"] > 2.0 * target["tre_without_outlier_mm"]


@pytest.mark.parametrize("words", ["1,2", "1,2,x", "1,2,nan", "1,2,3,4", ""])
def test_a_target_that_is_none_is_reported(tmp_path: Path, words: str) -> None:
    fixed = written(tmp_path / "f.csv", VERTEBRA)
    status, text = typed("points", "--fixed", fixed, "--moving", fixed, f"--target-mm={words}")
    assert (status, text.split(":")[0]) == (2, "TARGET_INVALID")


@pytest.mark.parametrize(
    ("text", "labels"),
    [
        pytest.param("1,2,3\n4,5,6.5\n", "", id="bare"),
        pytest.param("\ufeffx,y,z\r\n1,2,3\r\n4,5,6.5\r\n", "", id="windows"),
        pytest.param("# made by hand\nX_mm;Y_mm;Z_mm\n1;2;3\n\n4,0;5;6,5\n", "", id="decimal-commas"),
        pytest.param("1 2 3\n4  5\t6.5\n".replace("\t", " "), "", id="blanks"),
        pytest.param("x\ty\tz\n1\t2\t3\n4\t5\t6.5\n", "", id="tabs"),
        pytest.param("a,1,2,3\nb,4,5,6.5\n", "ab", id="names-first"),
        pytest.param("1,2,3,a\n4,5,6.5,b\n", "ab", id="names-last"),
        pytest.param("1,1,2,3\n2,4,5,6.5\n", "12", id="counted"),
        pytest.param("label,z,y,x,note\na,3,2,1,ok\nb,6.5,5,4,\n", "ab", id="other-order"),
        pytest.param("first,second,third\n1,2,3\n4,5,6.5\n", "", id="a-header-of-no-use"),
        pytest.param('"a","1.0","2.0","3.0"\n"b","4","5","6.5"\n', "ab", id="quoted"),
        pytest.param("1,2,3,\n4,5,6.5,\n", "", id="comma-at-the-end"),
    ],
)
def test_points_are_read_in_any_usual_form(tmp_path: Path, text: str, labels: str) -> None:
    path = tmp_path / "p.csv"
    path.write_bytes(text.encode())
    found = read_landmarks(path)
    assert found.points_mm.tolist() == [[1.0, 2.0, 3.0], [4.0, 5.0, 6.5]]
    assert "".join(found.labels) == labels


@pytest.mark.parametrize(
    ("content", "code"),
    [
        pytest.param(b"", "POINTS_INCOMPLETE", id="empty"),
        pytest.param(b"x,y,z\n", "POINTS_INCOMPLETE", id="only-a-header"),
        pytest.param(b"1,2,3\n4,5\n", "POINTS_INVALID", id="a-short-line"),
        pytest.param(b"1,2,3\n4,nan,6\n", "POINTS_INVALID", id="not-a-number"),
        pytest.param(b"1,2,3\n4,inf,6\n", "POINTS_INVALID", id="infinite"),
        pytest.param(b"1,2\n4,5\n", "POINTS_INVALID", id="flat"),
        pytest.param(b"1,2,3,4,5\n4,5,6,7,8\n", "POINTS_INVALID", id="five-numbers"),
        pytest.param(b"a,1,2,3\na,4,5,6\n", "POINTS_INVALID", id="a-name-twice"),
        pytest.param(b"\x89PNG\0\xff\xfe\0", "POINTS_UNREADABLE", id="a-picture"),
    ],
)
def test_what_is_no_list_of_points_is_reported(tmp_path: Path, content: bytes, code: str) -> None:
    path = tmp_path / "p.csv"
    path.write_bytes(content)
    with pytest.raises(InvalidInput) as caught:
        read_landmarks(path)
    assert caught.value.code == code


def test_a_missing_file_is_reported(tmp_path: Path) -> None:
    assert typed("points", "--fixed", tmp_path / "no.csv", "--moving", tmp_path / "no.csv")[0] == 2


CHANNEL = ("--channel-mm", "18,-2,12,8,-40,10")


def test_a_screw_that_fills_the_pedicle_is_reported_with_what_helps(tmp_path: Path) -> None:
    truth = touched(VERTEBRA, np.random.default_rng(2), 0.3)
    fixed = written(tmp_path / "f.csv", truth.fixed_mm)
    moving = written(tmp_path / "m.csv", truth.moving_mm)
    words = ("points", "--fixed", fixed, "--moving", moving, *CHANNEL)
    status, text = typed(*words, "--tolerance", "0.1,0.4")
    assert status == 0
    assert "cannot be navigated with this registration" in text
    check = json.loads(typed(*words, "--tolerance", "0.1,0.4", "--json")[1])["channel"]
    error = max(check["entry_95_mm"], check["isthmus_95_mm"])
    errors = [error, *check["with_more_landmarks_95_mm"].values()]
    assert errors == sorted(errors, reverse=True)
    assert check["diameter_excess_mm"] == pytest.approx(2.0 * (error - 0.1), abs=0.1)
    assert "cannot" not in typed(*words, "--tolerance", "6,15")[1]


@pytest.mark.parametrize("more", [(), ("--tolerance", "wide"), ("--tolerance", "1,95")])
def test_a_channel_without_a_usable_tolerance_is_reported(tmp_path: Path, more: tuple[str, ...]) -> None:
    truth = touched(VERTEBRA, np.random.default_rng(2), 0.3)
    fixed = written(tmp_path / "f.csv", truth.fixed_mm)
    moving = written(tmp_path / "m.csv", truth.moving_mm)
    assert typed("points", "--fixed", fixed, "--moving", moving, *CHANNEL, *more)[0] == 2
