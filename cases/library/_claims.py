"""Claims that most cases make: agreement of methods, closed forms, energy balances, independence of the unit system."""

from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import partial

import numpy as np
from numpy.polynomial import chebyshev

from cases.answers import Answer
from cases.case import CaseScene
from cases.claims import Agree, Equal, Expected, Law, Norm, Zero
from cases.library._layers import in_millimetres
from cases.library._reasons import SHARED, with_tolerance
from cases.library._requirements import REFERENCE
from cases.verdicts import Why
from contact import Scene
from contact.records.validation import FloatArray

PATH_QUANTITIES = ("indentation_depth", "normal_force", "contact_stiffness")


def names_of(scenes: Iterable[CaseScene]) -> tuple[str, ...]:
    """Return the names of scenes."""
    return tuple(scene.name for scene in scenes)


def agreements(
    scenes: Iterable[CaseScene],
    tolerances: Mapping[str, float | Mapping[str, float]],
    quantities: Iterable[str] = PATH_QUANTITIES,
    *,
    why: Why | None = None,
    derived_from: str = "",
    suffix: str = "",
) -> Iterator[Agree]:
    """Yield the agreement of MDR with each method of ``tolerances`` (or those of its quantities) in ``quantities``.

    Args:
        scenes: what they answer.
        tolerances: by label, or by label and quantity.
        quantities: what is compared.
        why: in place of the usual one of the method, which holds for ``PATH_QUANTITIES``.
        derived_from: how these tolerances were chosen, where that is not what the reason says.
        suffix: of the names of the claims.
    """
    names, quantities = names_of(scenes), tuple(quantities)
    for label, tolerance in tolerances.items():
        whole = why or SHARED[label]
        for quantity in quantities:
            yield Agree(
                name=f"{quantity.replace('_', ' ')}: MDR and {label}{suffix}",
                quantity=quantity,
                scenes=names,
                fast="mdr",
                reference=label,
                tolerance=tolerance[quantity] if isinstance(tolerance, Mapping) else tolerance,
                why=with_tolerance(whole, derived_from) if derived_from else whole,
            )


def pressure_agreements(scenes: Iterable[CaseScene], norms: Mapping[str, Norm], limit: str) -> Iterator[Agree]:
    """Yield the agreement of the pressures of MDR and finite elements, one claim for each name and norm of ``norms``.

    Args:
        scenes: what they answer.
        norms: how pressures are compared, by name of the claim.
        limit: what limits finite elements to about 2e-5, far inside the requirement.
    """
    for name, norm in norms.items():
        yield Agree(
            name=name,
            quantity="pressure",
            norm=norm,
            scenes=names_of(scenes),
            fast="mdr",
            reference="fem",
            refined=("mdr",),
            tolerance=REFERENCE["fem"]["pressure"],
            why=with_tolerance(SHARED["fem"], f"a requirement: 2e-4; {limit} finite elements to about 2e-5"),
        )


def carried_force(scenes: Iterable[CaseScene], methods: tuple[str, ...], tolerance: float) -> Zero:
    """Return the claim that sampled pressures add up to the force; the rings must reach the contact's edge."""
    return Zero(
        name="the pressure carries the force",
        quantity="pressure",
        scenes=names_of(scenes),
        methods=methods,
        tolerance=tolerance,
        why=SHARED["equilibrium"],
        derive=lacking_force,
    )


def lacking_force(scene: CaseScene, answer: Answer) -> list[float]:
    """Return what the loads of rings out to the contact's edge lack of the normal force of the last step."""
    load = float(np.sum(scene.sampling.rings.loads(np.array(answer.quantities["pressure"].values))))
    return [load / answer.quantities["normal_force"].values[-1] - 1]


def laws(
    scenes: Iterable[CaseScene],
    named: Mapping[str, tuple[str, float]],
    why: Why,
    *,
    tolerance: float,
    methods: tuple[str, ...] = (),
) -> Iterator[Zero]:
    """Yield the claim that each residual of a law vanishes: by name of the law, its residual and tolerance of fem."""
    for name, (quantity, of_mesh) in named.items():
        yield Zero(
            name=name,
            quantity=quantity,
            scenes=names_of(scenes),
            methods=methods,
            tolerance=tolerance,
            tolerances={"fem": of_mesh},
            why=why,
        )


def incremental_stiffness(scene: CaseScene, answer: Answer) -> FloatArray:
    """Return dF/(k_N d delta) - 1 along a loading path: one more step presses like a flat punch, whatever the profile.

    With F = int c (g(a) - g(x)) dx and k_N the stiffness of the flat punch of radius a, this vanishes exactly where the
    spring stiffness is the derivative c = dk_N/da, Eq. (10), which for the data of a layer reads
    c_bar = d(xi k_bar)/dxi. The radii of the path are `chebyshev_radii`.
    """
    names = ("contact_radius", "indentation_depth", "normal_force", "contact_stiffness")
    a, depth, force, stiffness = (np.array(answer.quantities[name].values) for name in names)
    fit = partial(chebyshev.Chebyshev.fit, a, deg=len(a) - 1)
    return np.asarray(fit(force).deriv()(a) / (stiffness * fit(depth).deriv()(a)) - 1)


def chebyshev_radii(lowest: float, highest: float, count: int) -> FloatArray:
    """Increasing Chebyshev-Lobatto points of [lowest, highest], where a polynomial through smooth values converges."""
    return lowest + (highest - lowest) * np.sin(np.linspace(0, np.pi / 2, count)) ** 2


def exact(
    why: Why,
    expected: Mapping[str, tuple[str, Expected]],
    *,
    tolerance: float,
    tolerances: Mapping[str, float] | None = None,
    scenes: Iterable[CaseScene] = (),
    methods: tuple[str, ...] = (),
    identities: Mapping[str, str] | None = None,
) -> Iterator[Equal]:
    """Yield a claim for each name of ``expected``: its quantity and the numbers that the scenes must give.

    Args:
        why: where the numbers come from.
        expected: by name of the claim.
        tolerance: relative.
        tolerances: of methods that need another one.
        scenes: what must give the numbers; empty for those that have a number.
        methods: labels; empty for every method of the case.
        identities: of methods for which it holds by construction: why.
    """
    for name, (quantity, values) in expected.items():
        yield Equal(
            name=name,
            quantity=quantity,
            to=values,
            scenes=names_of(scenes),
            methods=methods,
            tolerance=tolerance,
            tolerances=tolerances or {},
            identities=identities or {},
            why=why,
        )


def energy_balance(scenes: Iterable[CaseScene], tolerances: Mapping[str, float], time_steps: int) -> Zero:
    """Return the claim that the energies of an impact add up.

    Args:
        scenes: impacts.
        tolerances: of methods other than MDR.
        time_steps: of finite elements.
    """
    return Zero(
        name="energy balance",
        quantity="energy_residual",
        scenes=names_of(scenes),
        tolerance=1e-7,
        tolerances=tolerances,
        why=with_tolerance(
            SHARED["energy balance"],
            f"MDR: tolerance of its time integration; finite elements: 1e-5 by {time_steps} time steps, ten times",
        ),
    )


def scaling_law(
    name: str,
    scenes: Iterable[str],
    change: Callable[[Scene], Scene],
    factors: tuple[float, ...],
    why: Why,
    *,
    tolerance: float = 1e-12,
    tolerances: Mapping[str, float] | None = None,
    identities: Mapping[str, str] | None = None,
) -> Law:
    """Return the claim that a changed scene gives known multiples of depth, force and (if named) stiffness.

    Args:
        name: of the claim.
        scenes: their names.
        change: of the scene.
        factors: of ``PATH_QUANTITIES``, the last may be left out.
        why: why they are known.
        tolerance: relative.
        tolerances: of methods that need another one.
        identities: of methods for which it holds by construction: why.
    """
    return Law(
        name=name,
        quantity="normal_force",
        scenes=tuple(scenes),
        change=change,
        factors=dict(zip(PATH_QUANTITIES, factors, strict=False)),
        tolerance=tolerance,
        tolerances=tolerances or {},
        identities=identities or {},
        why=why,
    )


def same_in_millimetres(scenes: Iterable[str], factors: tuple[float, ...] = (1e3, 1.0, 1e-3)) -> Law:
    """Return the claim that the unit system does not matter; ``factors`` as of `scaling_law`."""
    name, tolerances = "the unit system does not matter", {"bem": 1e-7}
    return scaling_law(name, scenes, in_millimetres, factors, SHARED["units"], tolerance=1e-9, tolerances=tolerances)
