"""Section 4.3: impacts of a flat punch and of a sphere."""

from collections.abc import Iterator
from functools import cache, partial

from cases.library.flat_punch_impact import restitution
from cases.library.sphere_impact import impact, twice_the_radius_at_half_the_speed
from contact import ImpactHistory, Layer
from docs.gallery._parts import SOURCE, UNBONDED, layer, name_of
from docs.gallery.figure_12 import elastic_half_space
from mdr.impact.solver import solve_impact
from tests.verification.paper.flat_punch import stiffness
from tests.verification.paper.statement import (
    FORMULA,
    GOOD,
    SAME,
    Measured,
    Statement,
    above,
    below,
    deviation,
    reads,
    within,
)

DAMPING = 0.3
KINDS = {True: "elastic", False: "viscoelastic"}


@cache
def hit(thickness: float, *, elastic: bool = False) -> ImpactHistory:
    """The sphere of Fig. 12 on a layer [m]; zero for the half-space."""
    scene = impact(thickness).scene
    return solve_impact(scene.replace(effects=()) if elastic else scene, SOURCE, {})


def bounce(thickness: float) -> Measured:
    """Coefficient of restitution."""
    run = hit(thickness)
    return Measured(run.coefficient_of_restitution, float(run.uncertainty("coefficient_of_restitution").max()))


def at_damping(damping: float) -> Measured:
    """Restitution of a flat punch, Eq. (49)."""
    return Measured(restitution(damping), 1e-15)


def on_layer(one: Layer, ratio: float) -> Measured:
    """Restitution of a flat punch, Eqs. (49) and (50), over that of the half-space."""
    value, error = stiffness(one, ratio)
    return deviation(restitution(DAMPING * value**0.5), restitution(DAMPING), error)


def support_matters(ratio: float) -> Measured:
    """Restitution on the bonded over that on the unbonded incompressible layer."""
    bonded, loose = (stiffness(one, ratio) for one in (layer(0.5), UNBONDED))
    values = [restitution(DAMPING * value**0.5) for value, _ in (bonded, loose)]
    return deviation(values[0], values[1], bonded[1] + loose[1])


def duration(thickness: float, *, elastic: bool) -> Measured:
    """Contact time over that of the elastic half-space."""
    return Measured(hit(thickness, elastic=elastic).contact_time / elastic_half_space().contact_time, 1e-7)


def similar() -> Measured:
    """Restitution with twice the radius at half the speed, over the original one."""
    other = solve_impact(twice_the_radius_at_half_the_speed(impact(2e-3).scene), SOURCE, {})
    return deviation(other.coefficient_of_restitution, hit(2e-3).coefficient_of_restitution, 1e-9)


def by_finite_elements() -> Measured:
    """Largest force on 2 mm by finite elements over that by MDR."""
    from fem_reference import Fem

    run = Fem().solve(impact(2e-3).scene)
    if not isinstance(run, ImpactHistory):
        raise TypeError("finite elements answer an impact with another history")
    error = float(run.uncertainty("peak_force").max()) / run.peak_force
    return deviation(run.peak_force, hit(2e-3).peak_force, error)


def statements() -> Iterator[Statement]:
    """The statements of this section."""
    yield from restitution_on_layers()
    yield from on_layers()
    yield from similarity_and_agreement()


def restitution_on_layers() -> Iterator[Statement]:
    """Restitution against damping and confinement."""
    for less, damping in ((0.05, 0.1), (0.1, 0.5), (0.5, 1.0), (1.0, 2.0)):
        yield Statement(
            "Eq. (49)",
            f"the restitution falls with the damping ratio, from D = {less:g} to {damping:g}",
            "decreasing",
            "restitution",
            partial(at_damping, damping),
            below(partial(at_damping, less)),
            FORMULA,
        )
    for one in (UNBONDED, layer(0.5)):
        yield Statement(
            "Section 4.3, Fig. 11",
            f"{name_of(one)}: for a/h <= 0.1 the half-space is a good approximation, D_HS = 0.3",
            "a/h <= 0.1",
            "restitution at a/h = 0.1 over the half-space",
            partial(on_layer, one, 0.1),
            within(GOOD),
        )
    for ratio in (1.0, 2.0, 5.0):
        yield Statement(
            "Section 4.3, Fig. 11",
            f"a/h = {ratio:g}: the support matters much for a/h > 1",
            "significant",
            "restitution, bonded over unbonded, D_HS = 0.3",
            partial(support_matters, ratio),
            lambda value: abs(value) > GOOD,
        )
    for thickness, printed, half in ((0.0, 0.45, 0.005), (1e-3, 0.6, 0.05)):
        yield Statement(
            "Section 4.3, Fig. 12C",
            f"restitution, {f'h = {1e3 * thickness:g} mm' if thickness else 'half-space'}",
            f"{printed:g}",
            "restitution",
            partial(bounce, thickness),
            reads(printed, half),
        )


def on_layers() -> Iterator[Statement]:
    """Impacts on layers of several thicknesses."""
    for thin, thick in ((3e-3, 0.0), (2e-3, 3e-3), (1e-3, 2e-3)):
        yield Statement(
            "Section 4.3, Fig. 12C",
            f"the restitution grows with decreasing thickness, to h = {1e3 * thin:g} mm",
            "increases",
            "restitution",
            partial(bounce, thin),
            above(partial(bounce, thick)),
        )
    yield Statement(
        "Section 4.3, Fig. 12B",
        "the largest confinement on the 1 mm layer",
        "1",
        "largest a/h",
        lambda: Measured(hit(1e-3).peak_contact_radius / 1e-3, 1e-6),
        reads(1.0, 0.05),
    )
    yield Statement(
        "Section 4.3, Fig. 12A",
        "its largest force is twice that of the viscoelastic half-space",
        "2",
        "largest force, 1 mm over half-space",
        lambda: Measured(hit(1e-3).peak_force / hit(0.0).peak_force, 1e-7),
        reads(2.0, 0.05),
    )
    for thin, thick in ((2e-3, 3e-3), (1e-3, 2e-3)):
        for elastic in (True, False):
            yield Statement(
                "Section 4.3, Fig. 12C",
                f"{KINDS[elastic]}: a {1e3 * thin:g} mm layer has a shorter impact than a thicker one",
                "decreases",
                "duration over that of the elastic half-space",
                partial(duration, thin, elastic=elastic),
                below(partial(duration, thick, elastic=elastic)),
            )


def similarity_and_agreement() -> Iterator[Statement]:
    """One R v0, and two methods."""
    yield Statement(
        "Section 4.3",
        "R and v0 are free parameters at one R v0",
        "free",
        "restitution with twice R at half v0 over the original",
        similar,
        within(1e-7),
    )
    yield Statement(
        "Section 4.3, Fig. 12",
        "finite elements and MDR agree almost exactly, h = 2 mm",
        "almost exactly",
        "largest force, finite elements over MDR",
        by_finite_elements,
        within(SAME),
        "finite elements against MDR",
    )
