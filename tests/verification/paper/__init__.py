"""What the paper says: each row of `docs/paper.md` with the computation that checks its verdict.

- ``statement``: what a statement is, and its verdict
- ``flat_punch``, ``profiles``, ``detachment``, ``impacts``, ``slips``: the statements by section of the paper
- ``equations``: single equations that these leave out
"""

from collections.abc import Iterator

from tests.verification.paper.statement import Statement


def statements() -> Iterator[Statement]:
    """Every statement in the order of the paper."""
    # These imports load MDR, so they wait until the page is written.
    from tests.verification.paper import detachment, equations, flat_punch, impacts, profiles, slips

    for section in (slips, flat_punch, profiles, detachment, impacts, equations):
        yield from section.statements()
