"""Code and data that two methods share, in one list for claims, reports and tests of planted faults.

Agreement of two methods says nothing about what both use. Whatever is listed here is planted wrong by one per cent in
`tests/planted/sharing.py`; the table of what then fails is `docs/shared.md`.
"""

from dataclasses import dataclass
from enum import StrEnum

FAST = ("mdr", "mdr_table")
GRIDS = ("bem", "mdr_table")
# Those that solve layered bodies, finite elements left out.
ON_STACKS = ("mdr", "integral_equation", "bem")
STACKS = ("two_layers", "film_on_substrate", "three_zone_cartilage")
# All but finite elements.
ON_THE_KERNEL = ("mdr", "mdr_table", "bem", "integral_equation")
EVERY = (*ON_THE_KERNEL, "fem")


class Sharing(StrEnum):
    """What kind of thing is shared."""

    CODE = "code"  # lines that compute numbers of the answer
    QUESTION = "question"  # the scene as the user gave it: without it there is nothing to compare
    RECORD = "record"  # how answers are kept and compared, whoever gave them


@dataclass(frozen=True, kw_only=True)
class Shared:
    """Something that several methods use.

    Attributes:
        name: as reports and records call it.
        place: module of the sources.
        guard: what notices a mistake that the sharing methods make together.
        kind: code counts against independence; the question and the records are common to every comparison.
        methods: names in the method table.
        quantities: the compared quantities it enters; empty for all.
        cases: the cases it enters; empty for all.
    """

    name: str
    place: str
    guard: str
    kind: Sharing = Sharing.CODE
    methods: tuple[str, ...] = EVERY
    quantities: tuple[str, ...] = ()
    cases: tuple[str, ...] = ()

    def enters(self, quantity: str, case: str) -> bool:
        """Whether a comparison of ``quantity`` in ``case`` rests on it."""
        return (not self.quantities or quantity in self.quantities) and (not self.cases or case in self.cases)


LAYER_KERNEL = "layer kernel"
NOT_SAID = "not said by its package"

SHARED: tuple[Shared, ...] = (
    Shared(
        name=LAYER_KERNEL,
        place="bem.kernels.stack",
        methods=ON_THE_KERNEL,
        guard="agreement with finite elements; values of the kernel in extended precision",
    ),
    Shared(
        name="kernel of stacks",
        place="bem.kernels.stack",
        methods=ON_STACKS,
        guard="agreement with finite elements; pressures put back on the body by a second kernel",
        cases=STACKS,
    ),
    Shared(
        name="kernel of graded layers",
        place="bem.kernels.graded",
        methods=ON_STACKS,
        guard="agreement with finite elements; pressures put back on the body by a second kernel",
        cases=("graded_layer",),
    ),
    Shared(
        name="moduli over depth",
        place="contact.scene.graded_layer",
        methods=ON_STACKS,
        guard="agreement with finite elements, which write them down themselves",
        cases=("graded_layer",),
    ),
    Shared(
        name="fields inside from the contact's density",
        place="mdr.inside",
        methods=("mdr",),
        guard="agreement with finite elements; laws of elastic bodies",
        cases=("inside_half_space", "inside_layer"),
    ),
    Shared(
        name="contact modulus",
        place="bem.kernels.moduli",
        methods=ON_THE_KERNEL,
        guard="agreement with finite elements; closed forms of the half-space",
    ),
    Shared(
        name="springs and profile of MDR",
        place="mdr.spring_bed",
        methods=FAST,
        guard="agreement with finite elements and with the integral equation",
    ),
    Shared(
        name="boundary elements on a grid",
        place="bem.grid",
        methods=GRIDS,
        guard="agreement with MDR on the integral equation",
    ),
    Shared(
        name="heights of profiles",
        place="contact.scene.profiles",
        methods=GRIDS,
        guard="agreement with MDR and with finite elements, which write profiles down themselves",
    ),
    Shared(
        name="interpolation of tabulated profiles",
        place="contact.scene.profiles",
        methods=ON_THE_KERNEL,
        guard="agreement with finite elements, which interpolate themselves",
        cases=("measured_profile",),
    ),
    Shared(
        name="relaxation functions",
        place="contact.scene.effects",
        methods=FAST,
        guard="agreement with finite elements, which write them down themselves",
        cases=("flat_punch_impact", "sphere_impact", "held_indentation"),
    ),
    Shared(
        name="restitution and duration of an impact",
        place="contact.answer.solution",
        guard="closed forms of the flat punch's impact",
        quantities=("coefficient_of_restitution", "contact_time"),
    ),
    Shared(
        name="von Mises stress",
        place="contact.answer.inside",
        guard="its largest value under a paraboloid on the half-space",
        quantities=("von_mises_inside",),
        cases=("inside_half_space", "inside_layer"),
    ),
    Shared(
        name="reduction of two coated bodies, Eqs. (23)-(25)",
        place="contact.scene.coated_pair",
        guard="mirror symmetry: half the approach on one body",
        cases=("coated_pair",),
    ),
    Shared(
        name="numbers of the scene",
        kind=Sharing.QUESTION,
        place="contact.scene",
        guard="closed forms and tabulated values, which start from constants of the case",
    ),
    Shared(
        name="record of an answer",
        kind=Sharing.RECORD,
        place="cases.recording",
        guard="closed forms and tabulated values",
    ),
    Shared(
        name="rings on which pressures are compared",
        kind=Sharing.RECORD,
        place="cases.norms",
        guard="the sampled pressure carries the force",
        quantities=("pressure",),
    ),
    Shared(
        name="laws and points of fields inside",
        kind=Sharing.RECORD,
        place="cases.inside_laws",
        guard="closed forms of Huber and Sneddon; each law fails for a wrong field",
        cases=("inside_half_space", "inside_layer"),
    ),
)
BY_NAME = {one.name: one for one in SHARED}


def used_by(method: str) -> tuple[str, ...]:
    """Names of what a built-in method may have in common with others; nothing is known of other methods."""
    return tuple(one.name for one in SHARED if method in one.methods) or (NOT_SAID,)


def in_common(first: tuple[str, ...], second: tuple[str, ...], *, quantity: str, case: str) -> tuple[str, ...]:
    """Names of the code and data that both answers use, which their agreement cannot check.

    Args:
        first: what one answer used (`used_by`, or the `shared_inputs` of a method of another package).
        second: what the other used.
        quantity: that is compared.
        case: name of the case.
    """
    both = [name for name in first if name in second]
    counted = [name for name in both if name not in BY_NAME or _counts(BY_NAME[name], quantity, case)]
    unknown = NOT_SAID in {*first, *second} and NOT_SAID not in both
    return (*counted, *((NOT_SAID,) if unknown else ()))


def _counts(one: Shared, quantity: str, case: str) -> bool:
    return one.kind is Sharing.CODE and one.enters(quantity, case)
