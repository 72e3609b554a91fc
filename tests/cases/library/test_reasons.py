"""The table of reasons: each is used by a claim of its case, and an incomplete entry is refused by its name."""

import dataclasses

import pytest

from cases.claims import Claim
from cases.declare.registry import load_cases
from cases.library import _common
from contact import InvalidInput

# Tables that several cases read.
SHARED_TABLES = ("convergence", "stacks")
# Its verdicts are no claims: `tests/verification/test_fem_code_verification.py` sees their reasons.
AS_A_PROGRAM = "finite_element_verification"
OWN = [name for name in _common.REASONS if name not in ("shared", AS_A_PROGRAM, *SHARED_TABLES)]


def reasons_of(case):
    return {dataclasses.astuple(claim.why) for claim in case.claims if isinstance(claim, Claim)}


@pytest.mark.parametrize("case", OWN)
def test_every_reason_of_a_case_is_given_by_one_of_its_claims(case):
    given = reasons_of(load_cases()[case])
    unused = [name for name, reason in _common.reasons(case).items() if dataclasses.astuple(reason) not in given]
    assert unused == []


@pytest.mark.parametrize("table", SHARED_TABLES)
def test_every_reason_of_a_shared_table_is_given_by_a_claim_of_some_case(table):
    given = set().union(*map(reasons_of, load_cases().values()))
    unused = [name for name, why in _common.reasons(table).items() if dataclasses.astuple(why) not in given]
    assert unused == []


def test_an_entry_that_leaves_something_out_is_refused_by_its_name(monkeypatch):
    monkeypatch.setitem(
        _common.REASONS, "made_up", {"half": {"because": "so", "origin": "closed form", "source": "me"}}
    )
    with pytest.raises(InvalidInput, match=r"made_up\.half has no entry 'tolerance'"):
        _common.reasons("made_up")
