"""A sink of Coaxial: writes number, age and headline of each message into the file that COAXIAL_CSV names."""

import csv
import json
import os
from pathlib import Path

COLUMNS = ("sequence", "image_number", "image_age_ms", "headline")


class CsvSink:
    """Appends a row for each message that it receives. Skipped instants are gaps in `sequence`."""

    def __init__(self) -> None:
        """Open the file."""
        path = Path(os.environ.get("COAXIAL_CSV", "coaxial.csv"))
        is_new = not path.exists()
        self._file = path.open("a", newline="", encoding="utf-8")
        self._rows = csv.writer(self._file)
        if is_new:
            self._rows.writerow(COLUMNS)

    def receive(self, text: str) -> None:
        """Write a row; `text` is the message of `WS /ws/live`."""
        message = json.loads(text)
        # Without a snapshot there is no image: the row says so, instead of repeating the last one.
        snapshot = message["snapshot"] or {"image_number": ""}
        headline = message["headline"]["title"]["en"]
        age_ms = message["image_age_ms"]
        self._rows.writerow([message["sequence"], snapshot["image_number"], age_ms, headline])
        self._file.flush()

    def close(self) -> None:
        """Close the file, when the server stops."""
        self._file.close()
