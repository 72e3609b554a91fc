"""Side by side with an independent finite element program."""

from __future__ import annotations

import shutil

import pytest


@pytest.mark.slow
@pytest.mark.skipif(
    shutil.which("ccx") is None, reason="the program ccx is not installed (Debian package calculix-ccx)"
)
def test_flat_punch_to_1e_5_is_five_times_faster_than_calculix():
    from benchmarks.calculix_flat_punch import compare

    theirs, ours = compare()
    assert theirs.error < 1e-5
    assert ours.error < 1e-5
    assert ours.seconds < theirs.seconds / 5
    assert ours.megabytes < 500
