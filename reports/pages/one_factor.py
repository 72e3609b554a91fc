"""One sentence for one mistake: a quantity that a method has wrong by the same factor wherever it is compared."""

from collections import defaultdict
from collections.abc import Iterator

from cases.results.records.claim import Claim, Kind
from cases.results.records.run import RunResult
from cases.results.status import Status

# Failures whose errors differ by less than this share of their mean have one cause, a factor. Chosen: a hundred times
# narrower than the factors 2, 1 - nu^2 or pi/4 that are forgotten differ from one another.
ALIKE = 1e-3
FEWEST = 2


def one_factor(run: RunResult) -> tuple[str, ...]:
    """Return a sentence for each method and quantity whose exact checks all fail by one factor."""
    found: dict[str, dict[str, list[Claim]]] = defaultdict(lambda: defaultdict(list))
    for case in run.cases:
        for claim in case.claims:
            if claim.kind is Kind.EXACT and claim.observed is not None and claim.unit == "1":
                found[claim.methods[0]][claim.quantity].append(claim)
    return tuple(sentence for method, by_quantity in found.items() for sentence in _sentences(method, by_quantity))


def _sentences(method: str, by_quantity: dict[str, list[Claim]]) -> Iterator[str]:
    right = [name for name, claims in by_quantity.items() if all(claim.status is Status.PASS for claim in claims)]
    for quantity, claims in by_quantity.items():
        errors = [claim.observed for claim in claims if claim.status is Status.FAIL and claim.observed is not None]
        mean = sum(errors) / len(errors) if errors else 0.0
        if len(errors) < max(FEWEST, len(claims)) or max(abs(error - mean) for error in errors) > ALIKE * abs(mean):
            continue
        beside = f", while {' and '.join(map(_words, right))} pass" if right else ""
        yield (
            f"{method}: {_words(quantity)} is {100 * mean:+.4g} % off in all {len(errors)} exact checks{beside}: "
            f"one factor {1 + mean:.5g}, such as a modulus or a unit."
        )


def _words(quantity: str) -> str:
    return quantity.replace("_", " ")
