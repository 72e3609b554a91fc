"""What many scenes came to, counted scene by scene: no row stays."""

from __future__ import annotations

from array import array
from collections import Counter, defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

from cases.measurements.measurement import (
    ENDS,
    End,
    Measurement,
    by_quantity,
    covered,
    end_of,
    median,
    refusals,
    sharpness,
)


def _numbers() -> array[float]:
    return array("d")


@dataclass
class _Judged:
    """One quantity: how many rows, how many of them covered, and stated over true errors."""

    rows: int = 0
    covered: float = 0.0
    ratios: array[float] = field(default_factory=_numbers)


@dataclass
class Tally:
    """Counts of a campaign.

    Attributes:
        ends: How many scenes ended in each way.
        refusals: How often each reason was given.
        defects: Scenes with a wrong number without a word, or a crash: which, how it ended, and why.
    """

    ends: Counter[End] = field(default_factory=Counter)
    refusals: Counter[str] = field(default_factory=Counter)
    defects: list[tuple[str, End, str]] = field(default_factory=list)
    _quantities: defaultdict[str, _Judged] = field(default_factory=lambda: defaultdict(_Judged))

    @property
    def scenes(self) -> int:
        """How many were counted."""
        return self.ends.total()

    def add(self, rows: Sequence[Measurement]) -> None:
        """Count one scene by all its rows."""
        end, why = end_of(rows)
        self.ends[end] += 1
        self.refusals.update(refusals(rows))
        if end in ("beyond", "crashed"):
            self.defects.append((rows[0].scene, end, why))
        for quantity, found in by_quantity(rows).items():
            judged = self._quantities[quantity]
            judged.rows += len(found)
            judged.covered += len(found) * covered(found)
            judged.ratios.extend(sharpness(found))

    def join(self, other: Tally) -> None:
        """Add the counts of other scenes."""
        self.ends.update(other.ends)
        self.refusals.update(other.refusals)
        self.defects += other.defects
        for quantity, found in other._quantities.items():
            judged = self._quantities[quantity]
            judged.rows += found.rows
            judged.covered += found.covered
            judged.ratios.extend(found.ratios)

    def report(self) -> Iterator[str]:
        """One line for the ends of all scenes, for each reason of a refusal, and for each quantity that was judged."""
        yield ", ".join(f"{end}: {self.ends[end]}" for end in ENDS)
        yield from (f"refused {number} times: {reason}" for reason, number in self.refusals.most_common())
        for quantity, found in self._quantities.items():
            ratio = median(found.ratios)
            sharp = "" if ratio is None else f", stated over true error {ratio:.3g} in the median"
            yield f"{quantity}: {100 * found.covered / found.rows:.2f} % of {found.rows} covered{sharp}"
