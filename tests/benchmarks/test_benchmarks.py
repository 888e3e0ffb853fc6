"""The benchmark measures rightly, and on a handful of images the poses are as good as they have been."""

import dataclasses

import numpy as np
import pytest

from server.live import Instant, ProcessState, ProcessStatus, SourceState, SourceStatus
from server.stream.messages import live_message
from tests.benchmarks.accuracy import errors_of, false_claims, found_table, groups_by_phase, missed, withheld
from tests.benchmarks.claims import Claim, CorrectClaim, FalseClaim, NoClaim, judge
from tests.benchmarks.live import claim_of_message
from tests.benchmarks.offline import OfflineRun, claim_of, measure_offline, setup_of
from tests.benchmarks.readme import README, with_section
from tests.benchmarks.sections import SECTIONS
from tests.benchmarks.tables import Table, median, pair
from tests.tracker.scenes import perfectly_seen
from tracker.geometry import Rigid
from tracker.navigation import navigate
from tracker.pipeline import Tracker
from tracker.rehearsal import Phase, Theatre, TheatreSettings

WORKING_S = tuple(13.0 + number / 30.0 for number in range(8))
AWAY_S = (33.0, 33.1)


@pytest.fixture(scope="module")
def theatre() -> Theatre:
    return Theatre(TheatreSettings(seed=1))


@pytest.fixture(scope="module")
def measured(theatre: Theatre) -> OfflineRun:
    return measure_offline(theatre, (*WORKING_S, *AWAY_S))


def true_claim(theatre: Theatre, at_s: float) -> Claim:
    truth = theatre.truth_at(at_s)
    seen = perfectly_seen(truth.camera_from_marker, corners_px=truth.corners_px)
    claim = claim_of(setup_of(theatre), np.zeros((720, 1280, 3), np.uint8), seen)
    assert isinstance(claim, Claim)
    return claim


def test_the_drill_is_found_in_every_working_image_and_claimed_in_none_without_it(
    measured: OfflineRun,
) -> None:
    for judgements in (measured.stepped, measured.searched):
        assert missed(judgements) == []
        assert false_claims(judgements) == []
        assert len(errors_of(judgements)) == len(WORKING_S)
        assert all(isinstance(one.outcome, NoClaim) for one in judgements if one.phase is Phase.AWAY)
    ways = [one.outcome.found_by for one in measured.stepped if isinstance(one.outcome, CorrectClaim)]
    assert ways == ["search", *["track"] * (len(WORKING_S) - 1)]


def test_poses_are_as_near_to_the_truth_as_they_have_been(measured: OfflineRun) -> None:
    for errors in (errors_of(measured.stepped), errors_of(measured.searched)):
        assert median(error.corner_px for error in errors) < 0.05
        assert median(error.tip_mm for error in errors) < 0.1
        assert max(error.tip_mm for error in errors) < 0.4
        assert max(error.rotation_deg for error in errors) < 0.2
        assert max(error.entry_offset_mm for error in errors) < 0.3
        assert max(error.tip_mahalanobis_squared for error in errors) < 16.0


def test_every_stage_of_both_ways_is_timed(measured: OfflineRun) -> None:
    assert set(measured.timed[1].step_stage_ms) == {"grey", "gradient", "fit", "score", "judgement"}
    assert set(measured.timed[0].search_stage_ms) >= {
        "grey",
        "gradient",
        "candidates",
        "fit",
        "score",
        "judgement",
    }


def test_the_truth_itself_has_no_error(theatre: Theatre) -> None:
    judged = judge(theatre, 13.0, true_claim(theatre, 13.0))
    assert isinstance(judged.outcome, CorrectClaim)
    np.testing.assert_allclose(dataclasses.astuple(judged.outcome.error), 0.0, atol=1e-6)


def test_a_marker_a_millimetre_too_far_away_is_reported_with_its_sign(theatre: Theatre) -> None:
    claim = true_claim(theatre, 13.0)
    pose = claim.camera_from_marker
    sight = pose.translation_mm / np.linalg.norm(pose.translation_mm)
    moved = dataclasses.replace(
        claim,
        camera_from_marker=Rigid(rotation=pose.rotation, translation_mm=pose.translation_mm + sight),
        tip_in_camera_mm=claim.tip_in_camera_mm + sight,
        angle_deg=claim.angle_deg + 2.0,
        tip_covariance_mm2=np.eye(3) * 0.25,
    )
    judged = judge(theatre, 13.0, moved)
    assert isinstance(judged.outcome, CorrectClaim)
    error = judged.outcome.error
    found = (error.along_mm, error.across_mm, error.tip_mm, error.angle_deg, error.tip_mahalanobis_squared)
    np.testing.assert_allclose(found, (1.0, 0.0, 1.0, 2.0, 4.0), atol=1e-6)


def test_a_claim_beside_the_marker_is_false_and_one_of_its_parts_in_view_is_right(theatre: Theatre) -> None:
    claim = true_claim(theatre, 13.0)
    beside = dataclasses.replace(claim, corners_px=claim.corners_px + 40.0)
    assert isinstance(judge(theatre, 13.0, beside).outcome, FalseClaim)
    out = judge(theatre, 33.0, true_claim(theatre, 33.0))
    assert not out.in_view
    assert isinstance(out.outcome, CorrectClaim)
    assert isinstance(judge(theatre, 33.0, claim).outcome, FalseClaim)


def test_a_pose_too_unsure_to_place_the_tip_counts_as_withheld(theatre: Theatre) -> None:
    truth = theatre.truth_at(13.0)
    unsure = perfectly_seen(
        truth.camera_from_marker, covariance=np.eye(6) * 100.0, corners_px=truth.corners_px
    )
    said = claim_of(setup_of(theatre), np.zeros((720, 1280, 3), np.uint8), unsure)
    judged = judge(theatre, 13.0, said)
    assert withheld([judged]) == [judged]
    assert missed([judged]) == [judged]


def test_a_message_makes_the_same_claim_as_the_snapshot_that_it_was_made_from(theatre: Theatre) -> None:
    image = theatre.renderer().image_at(13.0)
    sightings = Tracker(camera=theatre.camera, models=[theatre.marker]).search(image)
    snapshot = navigate(
        setup=setup_of(theatre),
        sightings=sightings,
        image_number=390,
        captured_at_s=5.0,
        size_wh_px=(1280, 720),
        stage_ms={},
        skipped_images=0,
    )
    instant = Instant(
        sequence=1,
        source=SourceStatus(name="rehearsal", state=SourceState.RUNNING),
        process=ProcessStatus(state=ProcessState.RUNNING),
        snapshot=snapshot,
    )
    message = live_message(instant, now_s=5.1).snapshot
    assert message is not None
    reported, own = claim_of_message(message), claim_of(snapshot.setup, image, sightings["drill"])
    assert isinstance(reported, Claim)
    assert isinstance(own, Claim)
    np.testing.assert_allclose(reported.camera_from_marker.matrix, own.camera_from_marker.matrix)
    np.testing.assert_allclose(reported.tip_in_camera_mm, own.tip_in_camera_mm)
    np.testing.assert_allclose(reported.corners_px, own.corners_px)
    assert (reported.entry_offset_mm, reported.angle_deg, reported.depth_mm) == pytest.approx(
        (own.entry_offset_mm, own.angle_deg, own.depth_mm)
    )


def test_a_phase_without_claims_has_dashes_for_numbers(measured: OfflineRun) -> None:
    rows = found_table("", groups_by_phase(measured.stepped)).rows
    assert [row[:4] for row in rows] == [
        ["drill", "8", "8", "100.00 %"],
        ["away", "2", "0", "–"],
        ["**all**", "10", "8", "100.00 %"],
    ]


def test_a_table_is_markdown() -> None:
    table = Table(title="T", columns=["", "ms"], rows=[["all", pair([1.0, 2.0, 3.0], 100.0)]], note="N")
    assert table.markdown == "**T**\n\n|  | ms |\n|---|---:|\n| all | 2.00 / 3.00 |\n\nN\n"


def test_the_readme_keeps_everything_around_a_section_and_has_them_all() -> None:
    text = "a\n<!-- x -->\nold\n<!-- end of x -->\nb\n"
    assert with_section(text, "x", "new\n") == "a\n<!-- x -->\n\nnew\n\n<!-- end of x -->\nb\n"
    with pytest.raises(ValueError, match="no section"):
        with_section(text, "y", "new")
    for name in SECTIONS:
        with_section(README.read_text(encoding="utf-8"), name, "")
