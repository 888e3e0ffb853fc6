"""The tables of a recording: Parquet has the values of the CSV, and no cell is a formula."""

import csv
import json
import re
import sys
import zipfile
from pathlib import Path

import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from server.errors import RecordingError
from server.recording.export import COLUMNS, Table, csv_lines
from server.recording.parquet import write_parquet, write_parquet_archive
from tests.server.recording.reviewed import DRILLED, write_drilling

TYPES = {"integer": pa.int64(), "number": pa.float64(), "text": pa.string()}


@pytest.fixture(scope="module")
def drilling(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_drilling(tmp_path_factory.mktemp("drilling") / "case.mcap")


@pytest.mark.parametrize("table", list(Table))
def test_parquet_has_the_columns_and_values_of_the_csv(
    drilling: Path, tmp_path: Path, table: Table, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("server.recording.parquet.BATCH_ROWS", 3)
    path = tmp_path / f"{table}.parquet"
    assert write_parquet(drilling, table, path) > 3
    found = pq.read_table(path)
    columns = COLUMNS[table]
    assert found.schema.names == [one.name for one in columns]
    assert found.schema.types == [TYPES[one.kind] for one in columns]
    rows = list(csv.DictReader(csv_lines(drilling, table)))
    assert len(rows) == found.num_rows
    for expected, row in zip(rows, found.to_pylist(), strict=True):
        for column in columns:
            text, value = expected[column.name], row[column.name]
            if column.kind == "text":
                assert (value or "") == text
            elif text == "":
                assert value is None
            else:
                assert value == float(text)


def test_units_are_in_the_metadata(drilling: Path, tmp_path: Path) -> None:
    write_parquet(drilling, Table.DEVIATIONS, tmp_path / "a.parquet")
    schema = pq.read_schema(tmp_path / "a.parquet")
    units = {field.name: (field.metadata or {}).get(b"unit") for field in schema}
    assert (units["entry_offset_mm"], units["angle_deg"], units["time_s"]) == (b"mm", b"deg", b"s")
    assert units["tool"] is units["image"] is None
    assert schema.metadata[b"recording"] == b"case.mcap"


def test_all_tables_are_in_one_archive(drilling: Path, tmp_path: Path) -> None:
    target = tmp_path / "tables.zip"
    assert write_parquet_archive(drilling, target, lambda _ratio, _doing: None) > 2 * len(DRILLED)
    with zipfile.ZipFile(target) as archive:
        assert archive.namelist() == ["poses.parquet", "deviations.parquet", "alarms.parquet"]
        with archive.open("deviations.parquet") as file:
            assert pq.read_table(file).num_rows == len(DRILLED)
    assert list(tmp_path.iterdir()) == [target]


def test_a_value_of_another_type_is_null(drilling: Path, tmp_path: Path) -> None:
    damaged = tmp_path / "case.mcap"
    # Of equal length, so that no position in the file changes.
    content = re.sub(
        rb'(?<="angle_deg":)[^,]+',
        lambda found: b'"' + b"x" * (len(found[0]) - 2) + b'"',
        drilling.read_bytes(),
    )
    damaged.write_bytes(content)
    write_parquet(damaged, Table.DEVIATIONS, tmp_path / "a.parquet")
    assert pq.read_table(tmp_path / "a.parquet")["angle_deg"].null_count == len(DRILLED)


def test_a_missing_pyarrow_is_named(drilling: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pyarrow.parquet", None)
    with pytest.raises(RecordingError) as found:
        write_parquet(drilling, Table.POSES, tmp_path / "a.parquet")
    assert found.value.code == "PARQUET_WRITER_MISSING"
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("name", ["=1+1", "+1", "-1", "@a", "\ta"])
def test_a_name_that_looks_like_a_formula_is_text_in_the_csv(
    drilling: Path, tmp_path: Path, name: str
) -> None:
    recording = tmp_path / "case.mcap"
    # Of equal length, so that no position in the file changes.
    encoded = json.dumps(name)[1:-1].ljust(4).encode()
    recording.write_bytes(drilling.read_bytes().replace(b'"by":"Anna"', b'"by":"' + encoded + b'"'))
    cells = {row["by"] for row in csv.DictReader(csv_lines(recording, Table.ALARMS))}
    assert f"'{name}" in {cell.rstrip(" ") for cell in cells}
    numbers = next(csv.DictReader(csv_lines(recording, Table.POSES)))
    assert any(value.startswith("-") for value in numbers.values())
