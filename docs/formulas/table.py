"""The formulas, where each comes from, and what its authors (or those who pass it on) claim for it."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Literal, TypeAlias

from contact.records.validation import FloatArray
from docs.formulas import cone, paraboloid, punch

Factor: TypeAlias = Callable[[FloatArray, float], FloatArray]
ANY_NU = (0.0, 0.3, 0.45, 0.49, 0.5)
COMPRESSIBLE = (0.0, 0.3, 0.45, 0.49)


@dataclass(frozen=True, kw_only=True)
class PublishedFormula:
    """One formula.

    Attributes:
        name: with the year.
        shape: of the indenter.
        factor: of the force on the half-space, over the variable of the shape and nu.
        source: publication and equation.
        checked: what its numbers were compared with, or why they could not be.
        claim: the range that it is given for.
        support: of the layer.
        poissons_ratios: at which it is judged: those that it claims.
        thin: whether it is a limit of thin layers, right beyond an a/h, not up to one.
    """

    name: str
    shape: Literal["paraboloid", "cone", "flat punch"]
    factor: Factor
    source: str
    checked: str
    claim: str
    support: Literal["bonded", "unbonded"] = "bonded"
    poissons_ratios: tuple[float, ...] = (0.5,)
    thin: bool = False


_paraboloid = partial(PublishedFormula, shape="paraboloid")
_cone = partial(PublishedFormula, shape="cone")
_punch = partial(PublishedFormula, shape="flat punch")


DIMITRIADIS = "Dimitriadis et al., Biophys. J. 82 (2002) 2798"
GARCIA = "Garcia, Garcia, Biophys. J. 114 (2018) 2923; numbers of"
HERMANOWICZ = "Hermanowicz, Int. J. Mech. Sci. 193 (2021) 106138; numbers as the program AtomicJ has them"
HAYES = "Hayes et al., J. Biomech. 5 (1972) 541; table of an R package that cites it"
PROGRAMS = "two public programs, digit by digit"
AUTHORS_PROGRAM = "the author's own program AtomicJ, digit by digit; the abstract has the range"
OUR_LIMIT = "our own solver: its error falls with growing a/h (test)"
NANITE = "nanite 4.2.3, digit by digit"
THICK = "layers that are thick compared with the contact radius"

PARABOLOIDS = (
    _paraboloid(
        name="Hertz 1882",
        factor=paraboloid.hertz,
        poissons_ratios=ANY_NU,
        source="Hertz, J. reine angew. Math. 92 (1882) 156",
        checked=NANITE,
        claim="half-space",
    ),
    _paraboloid(
        name="Dimitriadis 2002, bonded",
        factor=paraboloid.dimitriadis_bonded,
        source=f"{DIMITRIADIS}; numbers of two Python programs, of which one cites Eq. (12)",
        checked=PROGRAMS,
        claim="sqrt(R delta)/h up to 1",
    ),
    _paraboloid(
        name="Dimitriadis 2002, bonded, any nu",
        factor=paraboloid.dimitriadis_bonded_any_nu,
        poissons_ratios=ANY_NU,
        source=f"{DIMITRIADIS}; constants as AtomicJ has them",
        checked="AtomicJ, digit by digit; range from memory",
        claim="sqrt(R delta)/h up to 1",
    ),
    _paraboloid(
        name="Dimitriadis 2002, not bonded",
        support="unbonded",
        factor=paraboloid.dimitriadis_not_bonded,
        source=f"{DIMITRIADIS}; numbers of a Python program that cites Eq. (11)",
        checked="a public program, digit by digit",
        claim="sqrt(R delta)/h up to 1",
    ),
    _paraboloid(
        name="Dimitriadis 2002, not bonded, any nu",
        support="unbonded",
        factor=paraboloid.dimitriadis_not_bonded_any_nu,
        poissons_ratios=ANY_NU,
        source=f"{DIMITRIADIS}; constants as AtomicJ has them",
        checked="AtomicJ, digit by digit; range from memory",
        claim="sqrt(R delta)/h up to 1",
    ),
    _paraboloid(
        name="Hayes 1972, quadratics",
        factor=paraboloid.hayes_quadratics,
        poissons_ratios=(0.3, 0.45, 0.49, 0.5),
        source="Hayes et al., J. Biomech. 5 (1972) 541; quadratics of two Python programs that cite its data",
        checked=PROGRAMS,
        claim="a/h up to 2, nu = 0.3 to 0.5 as tabulated",
    ),
    _paraboloid(
        name="Garcia 2018, paraboloid",
        factor=paraboloid.garcia,
        source=f"{GARCIA} two Python programs",
        checked=PROGRAMS,
        claim=THICK,
    ),
    _paraboloid(
        name="Long 2011",
        factor=paraboloid.long,
        source="Long, Hall, Wu, Hui, Biophys. J. 101 (2011) 643; constants and range of a public script",
        checked="a public script, with its range",
        claim="R/h from 2 to 12.7, also large strains",
    ),
    _paraboloid(
        name="Hermanowicz 2021, paraboloid, bonded",
        factor=paraboloid.hermanowicz_bonded,
        source=HERMANOWICZ,
        checked=AUTHORS_PROGRAM,
        claim="all thicknesses",
    ),
    _paraboloid(
        name="Hermanowicz 2021, paraboloid, loose",
        support="unbonded",
        factor=paraboloid.hermanowicz_loose,
        poissons_ratios=(0.3, 0.5),
        source=HERMANOWICZ,
        checked=AUTHORS_PROGRAM,
        claim="all thicknesses",
    ),
    _paraboloid(
        name="Clifford 2009, rigid base",
        factor=paraboloid.clifford,
        poissons_ratios=COMPRESSIBLE,
        source="Clifford, Seah, Nanotechnology 20 (2009) 145708; constants of nanite, limit of a rigid base",
        checked=f"{NANITE}, which names Eqs. (9) and (10), and the range",
        claim="films on substrates of about 100 GPa; not made for rigid bases",
    ),
    _paraboloid(
        name="thin layer, bed of springs (Johnson 1985)",
        factor=paraboloid.johnson_thin,
        poissons_ratios=COMPRESSIBLE,
        source="Johnson, Contact Mechanics (1985), section 5.8",
        checked=OUR_LIMIT,
        claim="thin compressible layers",
        thin=True,
    ),
    _paraboloid(
        name="thin loose layer",
        support="unbonded",
        factor=paraboloid.loose_thin,
        poissons_ratios=(0.3, 0.5),
        source="Johnson, Contact Mechanics (1985), section 5.8",
        checked=OUR_LIMIT,
        claim="thin layers",
        thin=True,
    ),
    _paraboloid(
        name="thin incompressible layer (Chadwick 2002)",
        factor=paraboloid.chadwick_thin,
        source="Chadwick, SIAM J. Appl. Math. 62 (2002) 1520",
        checked=OUR_LIMIT,
        claim="thin layers",
        thin=True,
    ),
)
CONES = (
    _cone(
        name="Sneddon 1965, cone",
        factor=cone.sneddon,
        poissons_ratios=ANY_NU,
        source="Sneddon, Int. J. Eng. Sci. 3 (1965) 47",
        checked=NANITE,
        claim="half-space",
    ),
    _cone(
        name="Gavara and Chadwick 2012, as programmed",
        factor=cone.gavara_as_programmed,
        source="Gavara, Chadwick, Nature Nanotech. 7 (2012) 733; form of AtomicJ and of two Python programs",
        checked="three public programs; abstract without numbers",
        claim=THICK,
    ),
    _cone(
        name="Managuli 2018",
        factor=cone.managuli,
        source="Managuli, Roy, Exp. Tech. 42 (2018), Eq. (1), as a Python program has it",
        checked="one public program; no abstract was found",
        claim=THICK,
    ),
    _cone(
        name="Garcia 2018, cone",
        factor=cone.garcia,
        source=f"{GARCIA} two Python programs",
        checked=PROGRAMS,
        claim=THICK,
    ),
    _cone(
        name="Hermanowicz 2021, cone, loose",
        support="unbonded",
        factor=cone.hermanowicz_loose,
        poissons_ratios=(0.3, 0.5),
        source=HERMANOWICZ,
        checked=AUTHORS_PROGRAM,
        claim="all thicknesses",
    ),
)
PUNCHES = (
    _punch(
        name="Boussinesq 1885, punch",
        factor=punch.boussinesq,
        poissons_ratios=ANY_NU,
        source="Sneddon, Int. J. Eng. Sci. 3 (1965) 47",
        checked="our own solver on the half-space",
        claim="half-space",
    ),
    _punch(
        name="Hayes 1972, spline of the table",
        factor=punch.hayes,
        source=HAYES,
        checked="an R package and a Python program, digit by digit",
        claim="a/h up to 8",
    ),
    _punch(
        name="Hayes, column in circulation as nu = 0.5",
        factor=punch.hayes_mislabelled,
        poissons_ratios=(0.48, 0.5),
        source="public scripts that cite Hayes et al. (1972), by an earlier reading; not found again",
        checked="not found again",
        claim="a/h up to 2, nu = 0.5",
    ),
    _punch(
        name="Garcia 2018, punch",
        factor=punch.garcia,
        source=f"{GARCIA} a Python program",
        checked="a public program, digit by digit",
        claim=THICK,
    ),
    _punch(
        name="Lin, Hui, Conway 2000; Shull 2002",
        factor=punch.lin_hui_conway,
        source="from memory of Webber et al., Phys. Rev. E 68 (2003) 021805; its abstract: fit to finite elements",
        checked="nothing: no program and no readable text has its numbers; abstract without numbers",
        claim="moderate confinement",
    ),
    _punch(
        name="Hermanowicz 2021, punch, bonded",
        factor=punch.hermanowicz_bonded,
        source=HERMANOWICZ,
        checked=AUTHORS_PROGRAM,
        claim="all thicknesses",
    ),
    _punch(
        name="Hermanowicz 2021, punch, nu = 0",
        factor=punch.hermanowicz_compressible,
        poissons_ratios=(0.0,),
        source=HERMANOWICZ,
        checked=AUTHORS_PROGRAM,
        claim="all thicknesses",
    ),
    _punch(
        name="Hermanowicz 2021, punch, loose",
        support="unbonded",
        factor=punch.hermanowicz_loose,
        poissons_ratios=(0.3, 0.5),
        source=HERMANOWICZ,
        checked=AUTHORS_PROGRAM,
        claim="all thicknesses",
    ),
    _punch(
        name="thin layer, bed of springs (Barber 1990)",
        factor=punch.thin_compressible,
        poissons_ratios=COMPRESSIBLE,
        source="Forsbach (2023), Eq. (16), after Barber 1990",
        checked=f"{OUR_LIMIT}; Barber's paper was not found",
        claim="thin compressible layers",
        thin=True,
    ),
    _punch(
        name="thin incompressible layer, punch",
        factor=punch.thin_incompressible,
        source="squeezed film with the fluid's velocity read as displacement; Hermanowicz's cubic term",
        checked=OUR_LIMIT,
        claim="thin layers",
        thin=True,
    ),
)
FORMULAS = (*PARABOLOIDS, *CONES, *PUNCHES)
