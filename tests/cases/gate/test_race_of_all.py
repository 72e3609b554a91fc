from __future__ import annotations

from benchmarks.__main__ import losing_first


def test_peers_ahead_of_mdr_are_printed_first():
    rows = [
        "| s | mdr | 1 | 0 | 1 (1 to 1) | 0 |",
        "| s | slow | 9 | 0 | 9 (8 to 10) | 0 |",
        "| s | fast | 1 | 0 | 0.5 (0.4 to 0.6) | 1 |",
    ]
    found = losing_first("\n".join(["| scene |", "|---|", *rows])).splitlines()
    assert [row.split("|")[2].strip() for row in found[2:]] == ["fast", "mdr", "slow"]
