"""Claims that most cases make: agreement of methods, closed forms, energy balances, independence of the unit system."""

from collections.abc import Callable, Iterable, Iterator, Mapping

from cases.declare.case import CaseScene
from cases.judgement.claims.agreement import Agreement
from cases.judgement.claims.changed_scenes import ScalingLaw
from cases.judgement.claims.declared import Reason
from cases.judgement.claims.exact import Exact, Expected
from cases.judgement.claims.field_agreement import FieldAgreement, Norm
from cases.judgement.claims.own_laws import CarriedForce, Residual
from cases.library._layers import in_millimetres
from cases.library._reasons import SHARED, with_tolerance
from cases.library._requirements import REFERENCE
from contact import Scene

PATH_QUANTITIES = ("indentation_depth", "normal_force", "contact_stiffness")


def names_of(scenes: Iterable[CaseScene]) -> tuple[str, ...]:
    """Return the names of scenes."""
    return tuple(scene.name for scene in scenes)


def agreements(
    scenes: Iterable[CaseScene],
    tolerances: Mapping[str, float | Mapping[str, float]],
    quantities: Iterable[str] = PATH_QUANTITIES,
    *,
    reason: Reason | None = None,
    derived_from: str = "",
    suffix: str = "",
) -> Iterator[Agreement]:
    """Yield the agreement of MDR with each method of ``tolerances`` (or those of its quantities) in ``quantities``.

    Args:
        scenes: what they answer.
        tolerances: by label, or by label and quantity.
        quantities: what is compared.
        reason: in place of the usual one of the method, which holds for ``PATH_QUANTITIES``.
        derived_from: how these tolerances were chosen, where that is not what the reason says.
        suffix: of the names of the claims.
    """
    names, quantities = names_of(scenes), tuple(quantities)
    for label, tolerance in tolerances.items():
        why = reason or SHARED[label]
        for quantity in quantities:
            yield Agreement(
                name=f"{quantity.replace('_', ' ')}: MDR and {label}{suffix}",
                quantity=quantity,
                scenes=names,
                fast="mdr",
                reference=label,
                tolerance=tolerance[quantity] if isinstance(tolerance, Mapping) else tolerance,
                reason=with_tolerance(why, derived_from) if derived_from else why,
            )


def pressure_agreements(scenes: Iterable[CaseScene], norms: Mapping[str, Norm], limit: str) -> Iterator[FieldAgreement]:
    """Yield the agreement of the pressures of MDR and finite elements, one claim for each name and norm of ``norms``.

    Args:
        scenes: what they answer.
        norms: how pressures are compared, by name of the claim.
        limit: what limits finite elements to about 2e-5, far inside the requirement.
    """
    for name, norm in norms.items():
        yield FieldAgreement(
            name=name,
            quantity="pressure",
            norm=norm,
            scenes=names_of(scenes),
            fast="mdr",
            reference="fem",
            refined=("mdr",),
            tolerance=REFERENCE["fem"]["pressure"],
            reason=with_tolerance(SHARED["fem"], f"a requirement: 2e-4; {limit} finite elements to about 2e-5"),
        )


def carried_force(scenes: Iterable[CaseScene], methods: tuple[str, ...], tolerance: float) -> CarriedForce:
    """Return the claim that sampled pressures add up to the force; the rings must reach the contact's edge."""
    return CarriedForce(
        name="the pressure carries the force",
        quantity="pressure",
        scenes=names_of(scenes),
        methods=methods,
        tolerance=tolerance,
        reason=SHARED["equilibrium"],
    )


def exact(
    reason: Reason,
    expected: Mapping[str, tuple[str, Expected]],
    *,
    tolerance: float,
    tolerances: Mapping[str, float] | None = None,
    scenes: Iterable[CaseScene] = (),
    methods: tuple[str, ...] = (),
    identities: Mapping[str, str] | None = None,
) -> Iterator[Exact]:
    """Yield a claim for each name of ``expected``: its quantity and the numbers that the scenes must give.

    Args:
        reason: where the numbers come from.
        expected: by name of the claim.
        tolerance: relative.
        tolerances: of methods that need another one.
        scenes: what must give the numbers; empty for those that have a number.
        methods: labels; empty for every method of the case.
        identities: of methods for which it holds by construction: why.
    """
    for name, (quantity, values) in expected.items():
        yield Exact(
            name=name,
            quantity=quantity,
            expected=values,
            scenes=names_of(scenes),
            methods=methods,
            tolerance=tolerance,
            tolerances=tolerances or {},
            identities=identities or {},
            reason=reason,
        )


def energy_balance(scenes: Iterable[CaseScene], tolerances: Mapping[str, float], time_steps: int) -> Residual:
    """Return the claim that the energies of an impact add up.

    Args:
        scenes: impacts.
        tolerances: of methods other than MDR.
        time_steps: of finite elements.
    """
    return Residual(
        name="energy balance",
        quantity="energy_residual",
        scenes=names_of(scenes),
        tolerance=1e-7,
        tolerances=tolerances,
        reason=with_tolerance(
            SHARED["energy balance"],
            f"MDR: tolerance of its time integration; finite elements: 1e-5 by {time_steps} time steps, ten times",
        ),
    )


def scaling_law(
    name: str,
    scenes: Iterable[str],
    change: Callable[[Scene], Scene],
    factors: tuple[float, ...],
    reason: Reason,
    *,
    tolerance: float = 1e-12,
    tolerances: Mapping[str, float] | None = None,
    identities: Mapping[str, str] | None = None,
) -> ScalingLaw:
    """Return the claim that a changed scene gives known multiples of depth, force and (if named) stiffness.

    Args:
        name: of the claim.
        scenes: their names.
        change: of the scene.
        factors: of ``PATH_QUANTITIES``, the last may be left out.
        reason: why they are known.
        tolerance: relative.
        tolerances: of methods that need another one.
        identities: of methods for which it holds by construction: why.
    """
    return ScalingLaw(
        name=name,
        quantity="normal_force",
        scenes=tuple(scenes),
        change=change,
        factors=dict(zip(PATH_QUANTITIES, factors, strict=False)),
        tolerance=tolerance,
        tolerances=tolerances or {},
        identities=identities or {},
        reason=reason,
    )


def same_in_millimetres(scenes: Iterable[str], factors: tuple[float, ...] = (1e3, 1.0, 1e-3)) -> ScalingLaw:
    """Return the claim that the unit system does not matter; ``factors`` as of `scaling_law`."""
    name, tolerances = "the unit system does not matter", {"bem": 1e-7}
    return scaling_law(name, scenes, in_millimetres, factors, SHARED["units"], tolerance=1e-9, tolerances=tolerances)
