"""The committed page of accuracy figures is what the accepted numbers say."""

from __future__ import annotations

import dataclasses
from pathlib import Path

import pytest

from cases.gate.accuracy_figures import accuracy_figures
from cases.gate.baseline import AcceptedQuantity, Baseline
from contact import InvalidInput
from reports.commands.accuracy_page import current_page, write_page

ROOT = Path(__file__).resolve().parents[2]


def accepted(quantity, values, uncertainty):
    return AcceptedQuantity(
        scene="a",
        settings={},
        specification="0",
        quantity=quantity,
        unit="N",
        scale=1.0,
        values=values,
        uncertainty=uncertainty,
        spread=0.0,
        tolerance=1e-12,
        reason="made up",
    )


def baseline(method, *records):
    return Baseline(case="made_up", method=method, suites=("ci",), records=records, counters=())


def test_the_committed_page_is_what_the_command_writes():
    committed = (ROOT / "docs" / "accuracy.md").read_text(encoding="utf-8")
    assert committed == current_page(ROOT / "baselines"), "renew it with: contact-verify accuracy-page"


def test_a_changed_error_changes_the_page(tmp_path):
    fem = baseline("fem", accepted("normal_force", (2.0, 4.0), (0.01, 0.04)))
    mdr = baseline("mdr", accepted("normal_force", (2.02, 4.02), (0.002, 0.002)))
    first, second = accuracy_figures([fem, mdr])
    assert first.stated == pytest.approx((0.005, 0.01), rel=1e-12, abs=0)
    assert first.differences == pytest.approx((0.01, 0.005), rel=1e-9, abs=0)
    assert (first.partner, first.within) == ("mdr", 1)
    assert (second.partner, second.within) == ("fem", 1)


def test_what_cannot_be_compared_is_not():
    pulled = baseline("fem", accepted("normal_force", (2.0,), (0.1,)), accepted("pull_off_force", (1.0,), (0.1,)))
    other = dataclasses.replace(pulled, method="mdr")
    force, pull_off = list(accuracy_figures([pulled, other]))[:2]
    assert force.differences == ()
    assert pull_off.differences == (0.0,)
    shorter = baseline("mdr", accepted("normal_force", (2.0, 3.0), (0.1, 0.1)))
    assert (
        next(iter(accuracy_figures([baseline("fem", accepted("normal_force", (2.0,), (0.1,))), shorter]))).within == 0
    )


def test_prescribed_quantities_and_checks_have_no_row():
    prescribed = accepted("contact_radius", (1.0,), (0.0,))
    check = accepted("energy_residual", (1.0,), (0.5,))
    assert list(accuracy_figures([baseline("fem", prescribed, check)])) == []


def test_a_folder_without_accepted_numbers_is_refused(tmp_path):
    with pytest.raises(InvalidInput, match="name the folder with --baseline"):
        write_page(tmp_path, tmp_path / "page.md")
    assert not (tmp_path / "page.md").exists()
