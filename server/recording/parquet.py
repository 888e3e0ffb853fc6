"""Export of the tables of a recording as Parquet, with typed columns and their units.

pyarrow is an optional dependency, because it is large and only this export needs it.
"""

import zipfile
from collections.abc import Iterator, Sequence
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING

from server.disk import named_when_complete
from server.errors import RecordingError
from server.recording.export import COLUMNS, Column, Row, Table, table_not_written, table_rows
from server.recording.timeline import Report

if TYPE_CHECKING:
    import pyarrow as pa

SUFFIX = ".parquet"
BATCH_ROWS = 10_000


def write_parquet(recording: Path, table: Table, target: Path) -> int:
    """Write a table of a recording as Parquet, up to the end of an incomplete file.

    The columns are `COLUMNS`: int64, float64 and UTF-8, null where unknown. The metadata of a column has its
    unit, that of the file the name of the recording.

    Args:
        recording: File of the recording.
        table: The table.
        target: File of the table; overwritten when it is complete.

    Returns:
        The number of rows.

    Raises:
        RecordingError: PARQUET_WRITER_MISSING, TABLE_NOT_WRITTEN, RECORDING_NOT_READABLE.
    """
    require_parquet()
    rows = table_rows(recording, table)
    try:
        with named_when_complete(target) as unfinished:
            return _write(rows, table, unfinished, recording.name)
    except OSError as error:
        raise table_not_written(target, error) from error


def write_parquet_archive(recording: Path, target: Path, report: Report) -> int:
    """Write all tables of a recording into one uncompressed zip archive, see `write_parquet`.

    Args:
        recording: File of the recording.
        target: The archive; its folder also has the tables until they are in it.
        report: Called with the completed share (0 to 1) and the present activity.

    Returns:
        The number of rows of all tables.

    Raises:
        RecordingError: See `write_parquet`.
    """
    rows = 0
    try:
        with zipfile.ZipFile(target, "w") as archive:
            for number, table in enumerate(Table):
                report(number / len(Table), "writing the tables")
                path = target.with_name(f"{table}{SUFFIX}")
                rows += write_parquet(recording, table, path)
                archive.write(path, path.name)
                path.unlink()
    except OSError as error:
        raise table_not_written(target, error) from error
    return rows


def require_parquet() -> None:
    """Reject an export without pyarrow.

    Raises:
        RecordingError: PARQUET_WRITER_MISSING.
    """
    try:
        import pyarrow.parquet  # noqa: F401, PLC0415  optional
    except ImportError:
        raise RecordingError(
            "PARQUET_WRITER_MISSING",
            "Parquet files are written with pyarrow, which is not installed",
            'Install it into the environment of Coaxial: pip install "coaxial[parquet]".',
        ) from None


def _write(rows: Iterator[Row], table: Table, target: Path, recording: str) -> int:
    import pyarrow as pa  # noqa: PLC0415  optional
    import pyarrow.parquet as pq  # noqa: PLC0415

    types = {"integer": pa.int64(), "number": pa.float64(), "text": pa.string()}
    columns = COLUMNS[table]
    fields = [
        pa.field(one.name, types[one.kind], metadata={"unit": one.unit} if one.unit else None)
        for one in columns
    ]
    schema = pa.schema(fields, metadata={"recording": recording, "table": table.value})
    count = 0
    with pq.ParquetWriter(target, schema) as writer:
        while batch := list(islice(rows, BATCH_ROWS)):
            count += len(batch)
            arrays = [_array(column, values, schema) for column, *values in zip(columns, *batch, strict=True)]
            writer.write_batch(pa.record_batch(arrays, schema=schema))
    return count


def _array(column: Column, values: Sequence[object], schema: "pa.Schema") -> "pa.Array":
    import pyarrow as pa  # noqa: PLC0415  optional

    return pa.array([_typed(column, value) for value in values], type=schema.field(column.name).type)


def _typed(column: Column, value: object) -> object:
    """Return a value of the type of its column; None for another one, as in a damaged recording."""
    if column.kind == "text":
        return None if value is None else str(value)
    if isinstance(value, bool) or not isinstance(value, int | float):
        return None
    return int(value) if column.kind == "integer" else float(value)
