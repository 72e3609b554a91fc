"""A table as the text of a CSV file."""

import csv
import io
from collections.abc import Iterable


def csv_text(heads: Iterable[str], rows: Iterable[Iterable[object]]) -> str:
    """Return a table as CSV; floats keep all digits that tell them apart, None is an empty cell."""
    buffer = io.StringIO()
    writer = csv.writer(buffer, lineterminator="\n")
    writer.writerow(heads)
    writer.writerows(rows)
    return buffer.getvalue()
