"""Impact of a sphere on a viscoelastic layer.

Question: Is MDR right in the rebound from a layer, where it was never proven?
Source: Eq. (51); Eq. (52); Eq. (53); Fig. 12.

Section 4.3 of Forsbach (2023): impact of a sphere on a standard-solid layer, Fig. 12. A rigid sphere of 20 g hits an
incompressible layer of a standard solid, G_inf/G_1 = 1/9 and tau = 1 ms, and rebounds. The contact radius grows and
shrinks, so there is no closed form; that MDR is right in the rebound from a layer was shown in the paper by explicit
finite elements only. The thinner the layer the stiffer the contact and, with these data, the livelier the rebound. R
and v0 enter only as a product. Kinetic, stored and dissipated energy must add up.
"""

from cases.case import CaseScene
from cases.claims import Law
from cases.effects import Ablation
from cases.library import _common as c
from cases.library import _refinements as r
from contact import Impact, Layer, Paraboloid, StandardSolid

WHY = c.reasons("sphere_impact")
MAXWELL_MODULUS = 7.5e6  # Pa, G_1
# The paper has G_inf/G_1 = 0.111..
LONG_TERM_MODULUS = MAXWELL_MODULUS / 9
RELAXATION_TIME = 1e-3  # s
SOLID = StandardSolid(
    long_term_shear_modulus=LONG_TERM_MODULUS,
    maxwell_shear_modulus=MAXWELL_MODULUS,
    viscosity=MAXWELL_MODULUS * RELAXATION_TIME,
)
MASS = 0.02  # kg
RADIUS_OF_CURVATURE = 1e-2  # m
# Velocity [m/s]; only R v0 matters.
VELOCITY = 1.27479e-3 / RADIUS_OF_CURVATURE
# chi_HS of these data, Eq. (53).
IMPACT_NUMBER = 2.65


def impact(thickness: float) -> CaseScene:
    """Return the impact on a layer of ``thickness`` [m]; zero for the half-space."""
    modulus = LONG_TERM_MODULUS + MAXWELL_MODULUS
    layer = Layer.half_space(youngs_modulus=3 * modulus, poissons_ratio=0.5)
    if thickness:
        layer = Layer.incompressible(thickness=thickness, shear_modulus=modulus)
    tip, falling = Paraboloid(radius_of_curvature=RADIUS_OF_CURVATURE), Impact(mass=MASS, velocity=VELOCITY)
    name, methods = f"bonded h={1e3 * thickness:g} mm" if thickness else "half-space", () if thickness else (c.MDR,)
    return c.scene(name, layer, tip, falling, effects=(SOLID,), methods=methods, thickness=thickness)


ON_LAYERS, HALF_SPACE = tuple(map(impact, (1e-3, 2e-3, 3e-3))), impact(0.0)
STRUCK = ON_LAYERS[1:2]
RESTITUTION, FORCE = "coefficient_of_restitution", "peak_force"
EVERY_IMPACT, UNITS = (HALF_SPACE, *ON_LAYERS), {RESTITUTION: 1.0, FORCE: 1.0}
KNOWN = c.reference_numbers("sphere_impact", EVERY_IMPACT, lambda _: UNITS, lambda name: name.removeprefix("bonded "))


def twice_the_radius_at_half_the_speed(scene: c.AnyScene) -> c.AnyScene:
    """Return the impact with the same R v0."""
    falling = Impact(mass=scene.loading.mass, velocity=scene.loading.velocity / 2)
    return scene.replace(indenter=Paraboloid(radius_of_curvature=2 * RADIUS_OF_CURVATURE), loading=falling)


# Agreement of MDR and finite elements: by quantities, the tolerance and where it comes from.
BY_FINITE_ELEMENTS = {
    (RESTITUTION, "peak_depth", "contact_time"): (2e-4, "2e-4 of what sums up an impact"),
    (FORCE,): (5e-4, "5e-4 of the largest force"),
    ("peak_contact_radius",): (4e-3, "4e-3 of the largest radius, half a cell"),
}
# The restitution that the text to Fig. 12 prints, and half a unit of its last digit.
PRINTED = (({HALF_SPACE.name: 0.45}, 1.2e-2), ({ON_LAYERS[0].name: 0.6}, 8.4e-2))
# chi_HS = 2.65 and G_1 = 7.5 MPa are printed to half a unit of their last digits. By Eq. (53) R v0 goes with
# chi^5 / G_1^2, so its standard uncertainty is the root of (0.94 %)^2 + (1.33 %)^2 over the root of three.
BY_INPUTS: c.Words = {"uncertain": "velocity=0.94%", "methods": ("mdr",)}
ON_LAYER: c.Words = {"tolerance": 1e-7, "fem": 1e-4, "mdr_table": 3e-3}
SIMILAR: c.Words = {"tolerance": 1e-7, "fem": 1e-3, "methods": ("mdr",)}
SIMILAR |= {"change": twice_the_radius_at_half_the_speed, "factors": {RESTITUTION: 1.0, "contact_time": 1.0}}
ON_TABLES: c.Words = {"derived_from": "a requirement on tables: 8e-3"}
IN_TIME = (RESTITUTION, FORCE, "contact_time", "peak_depth")
CLAIMS = (
    c.equal("restitution on layers", RESTITUTION, KNOWN, ON_LAYERS, WHY["reference"], **ON_LAYER),
    c.equal("restitution on the half-space", RESTITUTION, KNOWN, (HALF_SPACE,), WHY["reference"], tolerance=1e-7),
    c.equal("peak force", FORCE, KNOWN, (), WHY["reference"], **ON_LAYER | {"fem": 5e-4}),
    *(
        c.equal(
            f"restitution as printed, {name}", RESTITUTION, to, (), WHY["printed"], tolerance=tolerance, **BY_INPUTS
        )
        for to, tolerance in PRINTED
        for name in to
    ),
    c.energy_balance(ON_LAYERS, 400, fem=1e-4, mdr_table=1e-4),
    c.claim(Law, "only R v0 matters", RESTITUTION, ON_LAYERS, WHY["similarity"], **SIMILAR),
    *(
        claim
        for quantities, (tolerance, words) in BY_FINITE_ELEMENTS.items()
        for claim in c.agreements(ON_LAYERS, {"fem": tolerance}, quantities, derived_from=f"a requirement: {words}")
    ),
    *c.agreements(ON_LAYERS, {"mdr_table": 8e-3}, (RESTITUTION, FORCE, "peak_depth"), **ON_TABLES),
    *r.studies(STRUCK, "accuracy in time", (*IN_TIME, "energy_residual"), against=r.FINEST_MDR),
    *r.studies(STRUCK, "nodes", IN_TIME, against=r.FINEST_MDR),
    *r.studies(STRUCK, "cells and time steps", {"energy_residual": 2.0}, nightly=True),
    Ablation(scene=STRUCK[0].name, slow=("fem",)),
    *r.costs("impact", STRUCK[0].name),
)
CASE = c.paper(__name__, __doc__, EVERY_IMPACT, (c.MDR, c.PLAIN_FEM, c.BEM, c.EQUATION, c.TABLE), CLAIMS)
