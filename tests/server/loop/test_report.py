from server.live import Problem
from server.loop.report import Report, ReportPacker, ReportUnpacker
from tests.server.loop.fake_workers import made_setup, made_snapshot, made_source


def test_a_report_comes_out_as_it_went_in() -> None:
    problem = Problem(code="C", message="m", remedy="r", context={"n": 1})
    report = Report(source=made_source(3), problem=problem, tracked_images=2)
    assert ReportUnpacker().unpack(ReportPacker().pack(report)) == report


def test_the_setup_is_one_object_as_long_as_it_does_not_change() -> None:
    packer, unpacker, setup = ReportPacker(), ReportUnpacker(), made_setup()
    packed = [
        packer.pack(Report(source=made_source(), snapshot=made_snapshot(number, setup)))
        for number in range(3)
    ]
    got = [unpacker.unpack(content).snapshot for content in (packed[0], packed[2])]
    other = packer.pack(Report(source=made_source(), snapshot=made_snapshot(9, made_setup())))
    assert [snapshot.image_number for snapshot in got if snapshot] == [0, 2]
    assert got[0] is not None
    assert got[1] is not None
    assert got[0].setup is got[1].setup
    assert got[0].sightings == made_snapshot(0).sightings
    assert unpacker.unpack(other).snapshot is not None


def test_a_reader_that_missed_the_first_reports_still_gets_the_setup() -> None:
    packer, setup = ReportPacker(), made_setup()
    packer.pack(Report(source=made_source(), snapshot=made_snapshot(0, setup)))
    later = packer.pack(Report(source=made_source(), snapshot=made_snapshot(1, setup)))
    snapshot = ReportUnpacker().unpack(later).snapshot
    assert snapshot is not None
    assert snapshot.setup.camera.size_wh_px == setup.camera.size_wh_px
