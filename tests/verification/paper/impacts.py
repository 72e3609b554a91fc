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
    GOOD,
    SAME,
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


def bounce(thickness: float) -> float:
    """Coefficient of restitution."""
    return hit(thickness).coefficient_of_restitution


def on_layer(one: Layer, ratio: float) -> float:
    """Restitution of a flat punch, Eqs. (49) and (50), over that of the half-space."""
    return deviation(restitution(DAMPING * stiffness(one, ratio) ** 0.5), restitution(DAMPING))


def support_matters(ratio: float) -> float:
    """Restitution on the bonded over that on the unbonded incompressible layer."""
    bonded, loose = (restitution(DAMPING * stiffness(one, ratio) ** 0.5) for one in (layer(0.5), UNBONDED))
    return deviation(bonded, loose)


def duration(thickness: float, *, elastic: bool) -> float:
    """Contact time over that of the elastic half-space."""
    return hit(thickness, elastic=elastic).contact_time / elastic_half_space().contact_time


def similar() -> float:
    """Restitution with twice the radius at half the speed, over the original one."""
    other = solve_impact(twice_the_radius_at_half_the_speed(impact(2e-3).scene), SOURCE, {})
    return deviation(other.coefficient_of_restitution, hit(2e-3).coefficient_of_restitution)


def by_finite_elements() -> float:
    """Largest force on 2 mm by finite elements over that by MDR."""
    from fem_reference import Fem

    run = Fem().solve(impact(2e-3).scene)
    if not isinstance(run, ImpactHistory):
        raise TypeError("finite elements answer an impact with another history")
    return deviation(run.peak_force, hit(2e-3).peak_force)


def statements() -> Iterator[Statement]:
    """The statements of this section."""
    yield from restitution_on_layers()
    yield from on_layers()
    yield from similarity_and_agreement()


def restitution_on_layers() -> Iterator[Statement]:
    """Restitution against damping and confinement."""
    for less, damping in ((0.05, 0.1), (0.1, 0.5), (0.5, 1.0), (1.0, 2.0)):
        yield Statement(
            f"the restitution falls with the damping ratio, from D = {less:g} to {damping:g}",
            partial(restitution, damping),
            below(partial(restitution, less)),
        )
    for one in (UNBONDED, layer(0.5)):
        yield Statement(
            f"{name_of(one)}: for a/h <= 0.1 the half-space is a good approximation, D_HS = 0.3",
            partial(on_layer, one, 0.1),
            within(GOOD),
        )
    for ratio in (1.0, 2.0, 5.0):
        yield Statement(
            f"a/h = {ratio:g}: the support matters much for a/h > 1",
            partial(support_matters, ratio),
            lambda value: abs(value) > GOOD,
        )
    for thickness, printed, half in ((0.0, 0.45, 0.005), (1e-3, 0.6, 0.05)):
        yield Statement(
            f"restitution, {f'h = {1e3 * thickness:g} mm' if thickness else 'half-space'}",
            partial(bounce, thickness),
            reads(printed, half),
        )


def on_layers() -> Iterator[Statement]:
    """Impacts on layers of several thicknesses."""
    for thin, thick in ((3e-3, 0.0), (2e-3, 3e-3), (1e-3, 2e-3)):
        yield Statement(
            f"the restitution grows with decreasing thickness, to h = {1e3 * thin:g} mm",
            partial(bounce, thin),
            above(partial(bounce, thick)),
        )
    yield Statement(
        "the largest confinement on the 1 mm layer", lambda: hit(1e-3).peak_contact_radius / 1e-3, reads(1.0, 0.05)
    )
    yield Statement(
        "its largest force is twice that of the viscoelastic half-space",
        lambda: hit(1e-3).peak_force / hit(0.0).peak_force,
        reads(2.0, 0.05),
    )
    for thin, thick in ((2e-3, 3e-3), (1e-3, 2e-3)):
        for elastic in (True, False):
            yield Statement(
                f"{KINDS[elastic]}: a {1e3 * thin:g} mm layer has a shorter impact than a thicker one",
                partial(duration, thin, elastic=elastic),
                below(partial(duration, thick, elastic=elastic)),
            )


def similarity_and_agreement() -> Iterator[Statement]:
    """One R v0, and two methods."""
    yield Statement("R and v0 are free parameters at one R v0", similar, within(1e-7))
    yield Statement("finite elements and MDR agree almost exactly, h = 2 mm", by_finite_elements, within(SAME))
