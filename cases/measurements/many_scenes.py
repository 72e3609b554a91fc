"""A campaign of any size: scenes in blocks on an executor, summed up where they are solved, kept in a file if asked."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from typing import TypeAlias

from cases.measurements.campaigns.campaign import campaign
from cases.measurements.campaigns.displacements import displacement_campaign
from cases.measurements.campaigns.inside.campaign import inside_campaign
from cases.measurements.campaigns.pressures import pressure_campaign
from cases.measurements.campaigns.random_scenes import FAMILIES
from cases.measurements.kept_scenes import KeptScenes, as_line
from cases.measurements.measurement import Measurement
from cases.measurements.tally import Tally
from cases.results.status import Status
from cases.run.executors import ExecutorFactory
from cases.run.keys import content_key, import_closure, plain
from cases.run.many.blocks import InBlocks
from contact import InvalidInput, Method

# Gives the rows of the scenes with these numbers: campaign(method, seed=.., count=.., numbers=..).
CampaignOf: TypeAlias = Callable[..., list[Measurement]]


def campaign_of(family: str) -> CampaignOf:
    """What draws and judges the scenes of a family.

    Raises:
        InvalidInput: If there is no such family.
    """
    of_fields = {"pressure": pressure_campaign, "displacement": displacement_campaign, "inside": inside_campaign}
    if family in FAMILIES:
        return partial(campaign, family=family)
    if family in of_fields:
        return of_fields[family]
    raise InvalidInput(f"family = {family!r}: must be one of {', '.join((*FAMILIES, *of_fields))}")


@dataclass(frozen=True, kw_only=True)
class SolvedScenes:
    """What a block of scenes came to, summed up where it was solved: little is sent, and nothing is left to be counted.

    Attributes:
        tally: Of its scenes.
        lines: Their rows as they are kept.
    """

    tally: Tally
    lines: str


def summed_up(scenes: Iterable[tuple[int, Sequence[Measurement]]]) -> SolvedScenes:
    """Count numbered scenes and write their rows down."""
    tally, lines = Tally(), []
    for number, rows in scenes:
        tally.add(rows)
        lines.append(as_line(number, rows))
    return SolvedScenes(tally=tally, lines="".join(lines))


@dataclass(frozen=True, kw_only=True)
class ManyScenes:
    """What is solved, with numbered scenes that can each be drawn alone.

    Attributes:
        campaign: Gives the rows of the scenes of given numbers; it can be pickled.
        family: Kind of scenes that it draws.
        method: Who answers.
        seed: Of the scenes.
        count: How many.
    """

    campaign: CampaignOf
    family: str
    method: Method
    seed: int
    count: int

    @property
    def key(self) -> str:
        """Of everything that the rows of a scene depend on; not of the number of scenes."""
        solver = type(self.method)
        closures = [import_closure(place) for place in (solver.__module__, __name__)]
        return content_key(
            {
                "family": self.family,
                "seed": self.seed,
                "method": f"{solver.__module__}.{solver.__qualname__}",
                "settings": plain(self.method),
                "source": [dict(closure.sources) for closure in closures],
                "versions": [dict(closure.versions) for closure in closures],
            }
        )

    def in_blocks(self, factory: ExecutorFactory, jobs: int) -> InBlocks[SolvedScenes]:
        """What solves blocks of these scenes."""
        return InBlocks(self.solved, factory, jobs, self._died)

    def solved(self, numbers: Sequence[int]) -> SolvedScenes:
        """Solve and judge the scenes of these numbers."""
        judge = partial(self.campaign, self.method, seed=self.seed, count=self.count)
        return summed_up((number, judge(numbers=[number])) for number in numbers)

    def tallies(self, blocks: InBlocks[SolvedScenes], kept: KeptScenes | None = None) -> Iterator[Tally]:
        """What the kept scenes came to, then each block as soon as it is finished.

        Raises:
            ClusterLost: If the scheduler of a cluster does not answer any more; what came before is kept.
        """
        found = {number: rows for number, rows in kept.read() if number < self.count} if kept is not None else {}
        yield summed_up(found.items()).tally
        left = [number for number in range(self.count) if number not in found] if found else range(self.count)
        for solved in blocks.results(left):
            if kept is not None:
                kept.add(solved.lines)
            yield solved.tally

    def _died(self, number: int, words: str) -> SolvedScenes:
        row = Measurement(
            method=self.method.name,
            scene=f"{number}",
            parameters={"family": self.family},
            seed=self.seed,
            status=Status.FAIL,
            reason=f"the process that solved it died: {words}",
        )
        return summed_up([(number, [row])])
