"""Every coefficient of the error models with the stated errors it shapes, and what a coverage study achieved there."""

import dataclasses
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from importlib import import_module
from typing import Any, Final

from cases.measurements.campaigns.random_scenes import FAMILIES
from cases.results.records.reliability import CoverageRecord

_IN_TIME: Final = ("history", "creep")
_PRESSURE: Final = ("pressure",)
_STIFFNESS: Final = ("contact_stiffness",)
_CONTACT_TIME: Final = ("contact_time",)


@dataclass(frozen=True, kw_only=True)
class Group:
    """Coefficients of one error model that shape errors of the same methods and scenes.

    Attributes:
        place: Module, and the record in it that holds them; of a module without records the module alone.
        names: Which constants of the module; of a record all its fields count.
        methods: Whose errors they shape.
        families: Kinds of scenes on which they do; empty where no coverage study draws such scenes.
        quantities: What single ones of them shape, by name; the others shape all quantities.
    """

    place: str
    names: tuple[str, ...] = ()
    methods: tuple[str, ...]
    families: tuple[str, ...] = ()
    quantities: Mapping[str, tuple[str, ...]] = field(default_factory=dict)


_SPRINGS: Final = "mdr.springs.error_model"
_MDR: Final = ("mdr",)
_BOTH_MDR: Final = ("mdr", "mdr_table")
GROUPS: Final = (
    Group(place="bem.layer_equation.error_model:FACTOR", methods=_MDR, families=FAMILIES),
    # The coverage study draws plain layers; tests/verification/test_stack_error_bars.py measures stacks.
    Group(place="bem.layer_equation.error_model:STACK_FACTOR", methods=_MDR),
    Group(place="bem.layer_equation.error_model:WIDE_FACTOR", methods=_MDR),
    Group(place="bem.layer_equation.error_model:ONE_RADIUS", methods=("integral_equation",), families=("elastic",)),
    Group(place=_SPRINGS, names=("SPRING_ROUNDING", "POSITION_ROUNDINGS"), methods=_BOTH_MDR, families=FAMILIES),
    Group(
        place=_SPRINGS,
        names=("PRESSURE_ROUNDING", "SAMPLED_ROUNDING"),
        methods=_BOTH_MDR,
        families=("elastic",),
        quantities={"PRESSURE_ROUNDING": _PRESSURE, "SAMPLED_ROUNDING": _PRESSURE},
    ),
    Group(place=_SPRINGS, names=("SPRINGS_TO_MOTION",), methods=_MDR, families=("impact", *_IN_TIME)),
    Group(
        place=_SPRINGS,
        names=("SPRING_SHARES", "EXCESS_ERRORS", "HISTORY_SAFETY", "LARGEST_HISTORY_ERROR"),
        methods=_MDR,
        families=_IN_TIME,
    ),
    Group(
        place=_SPRINGS,
        names=(
            "PROFILE_ROUNDING",
            "IMPACT_ROUNDING",
            "AGREEMENT_SHARES",
            "DEFAULT_ACCURACY",
            "COARSER_POWER",
            "LEAVING_SHARE",
        ),
        methods=_MDR,
        families=("impact",),
        quantities={"LEAVING_SHARE": _CONTACT_TIME},
    ),
    Group(place="bem.grid.error_model:TABLES", methods=("mdr_table",), families=("elastic",)),
    Group(
        place="fem_reference.error_model:FIXED_RADIUS",
        methods=("fem",),
        families=("elastic", "adhesive"),
        quantities={"pressure_per_fall": _PRESSURE, "pressure_bounds": _PRESSURE},
    ),
    # The coverage study solves finite elements at prescribed radii only.
    Group(place="fem_reference.error_model:AT_LOAD", methods=("fem",)),
    Group(place="fem_reference.error_model:ON_BRANCH", methods=("fem",), families=("adhesive",)),
    Group(place="fem_reference.error_model:IN_TIME", methods=("fem",), families=("impact",)),
    # The coverage study asks for no fields inside.
    Group(place="fem_reference.error_model:INSIDE", methods=("fem",)),
)


@dataclass(frozen=True, kw_only=True)
class Coefficient:
    """One coefficient beside what was achieved.

    Attributes:
        name: Package, and the coefficient's name in the error model.
        value: What it is now.
        quantities: What it shapes; empty for all quantities.
        achieved: Measured coverage of what it shapes; empty where the study did not measure that.
    """

    name: str
    value: Any
    quantities: tuple[str, ...]
    achieved: tuple[CoverageRecord, ...]


def coefficients(records: Sequence[CoverageRecord], groups: Iterable[Group] = GROUPS) -> Iterator[Coefficient]:
    """The coefficients of all methods that a study measured, each with the study's records of what it shapes."""
    measured = {record.method for record in records}
    for group in groups:
        own = [r for r in records if r.method in group.methods and r.family in group.families]
        for name, value in values_of(group) if measured.intersection(group.methods) else ():
            shaped = group.quantities.get(name.rpartition(".")[2], ())
            yield Coefficient(
                name=name,
                value=value,
                quantities=shaped,
                achieved=tuple(record for record in own if not shaped or record.quantity in shaped),
            )


def values_of(group: Group) -> Iterator[tuple[str, Any]]:
    """Name and present value of each coefficient of a group."""
    module, _, record = group.place.partition(":")
    found = import_module(module)
    holder: Any = getattr(found, record) if record else found
    names = tuple(entry.name for entry in dataclasses.fields(holder)) if record else group.names
    package = module.removesuffix(".error_model")
    for name in names:
        yield ".".join(part for part in (package, record, name) if part), getattr(holder, name)
