"""Indentation by a truncated cone.

Question: Do MDR and finite elements agree on a profile with a kink, from the half-space to the thin layer?
Source: Eq. (4); Eq. (8); Eq. (9); Eq. (35).

Section 4.1 of Forsbach (2023): a truncated cone indents bonded and unbonded layers of any thickness. A rigid cone with
a flat end of radius b, f(r) = (r - b) tan(theta) for r >= b, Eq. (35), presses on a layer of thickness h. The contact
radius a is prescribed with b/a = 0.5, for an unbonded layer and bonded layers with nu = 0.3, 0.45 and 0.5, from almost
a half-space (a/h = 0.1) to a thin layer (a/h = 20).

On the half-space the answer is known in closed form,
delta = a tan(theta) arccos(b/a),  F = E* a^2 tan(theta) [arccos(b/a) + (b/a) sqrt(1 - b^2/a^2)].

MDR, Eqs. (4) and (8), starts from flat-punch data of the layer kernel, Eqs. (29)-(31). The finite element model meshes
the section and does not use that kernel; the two share no input. Depth, force and contact stiffness must agree within
3e-6. The pressure has a logarithmic singularity at r = b, so it is compared in the 2 pi r weighted L2 norm and by the
loads of rings with an edge at r = b, never by its maximum.
"""

from dataclasses import replace

import numpy as np

from cases.case import CaseScene
from cases.claims import Norm
from cases.effects import Ablation
from cases.library import _common as c
from cases.library import _refinements as r
from contact import ContactRadii, TruncatedCone

WHY = c.reasons("truncated_cone")
SLOPE = 0.1
RATIOS = (0.1, 1.0, 2.0, 5.0, 20.0)


def on_layer(label: str, ratio: float) -> CaseScene:
    """Return the scene at a/h = ``ratio`` with b/a = 0.5."""
    a, cone = ratio * c.THICKNESS, TruncatedCone(flat_radius=0.5 * ratio * c.THICKNESS, slope=SLOPE)
    more: c.Words = {"steep": True, "sampling": c.rings(a, 0.0, 0.4, 0.5, 0.6, 0.8, 1.0)}
    place: c.Words = {"layer": label, "a_over_h": ratio, "b_over_a": 0.5}
    return c.scene(c.scene_name(label, ratio), c.layer(label), cone, ContactRadii([a]), **more, **place)


def on_half_space(flat: float) -> CaseScene:
    """Return the scene on the half-space with b/a = ``flat``."""
    cone, loading = TruncatedCone(flat_radius=flat * c.THICKNESS, slope=SLOPE), ContactRadii([c.THICKNESS])
    place: c.Words = {"layer": "half-space", "a_over_h": 0.0, "b_over_a": flat}
    return c.scene(f"half-space b/a={flat:g}", c.half_space(), cone, loading, **place)


def path(label: str, ratio: float) -> CaseScene:
    """Return a scene with 16 contact radii from 0.75 a to a, a/h = ``ratio``, away from the kink at 0.5 a."""
    base, radii = on_layer(label, ratio), ratio * c.THICKNESS * c.chebyshev_radii(0.75, 1.0, 16)
    methods = (c.MDR, c.EQUATION) if ratio == 1.0 else (c.MDR,)
    on_path = base.scene.replace(loading=ContactRadii(values=radii))
    return replace(base, name=f"{base.name}, path", scene=on_path, methods=methods)


LAYERED = tuple(on_layer(label, ratio) for label in c.LAYERS for ratio in RATIOS)
RESOLVED, THIN = (tuple(s for s in LAYERED if (float(s.parameters["a_over_h"]) > 2) is thin) for thin in (False, True))
PATHS = tuple(path(label, ratio) for label in c.LAYERS for ratio in (0.3, 1.0, 3.0, 10.0))
HALF_SPACE = tuple(on_half_space(flat) for flat in (0.25, 0.5, 0.75, 0.9))
AT_ONE, AT_FIVE = (c.having(LAYERED, a_over_h=ratio) for ratio in (1.0, 5.0))
ENDS = {ratio: tuple(on_layer(label, ratio) for label in ("unbonded", "bonded nu=0.5")) for ratio in (1.0, 5.0)}


def unit(scene: c.AnyScene) -> dict[str, float]:
    """Return a tan(theta) [m] and E* a^2 tan(theta) [N]."""
    a = c.radius(scene)
    return {"indentation_depth": a * SLOPE, "normal_force": c.contact_modulus(scene.layer) * a**2 * SLOPE}


def closed_form(scene: c.AnyScene) -> dict[str, float]:
    """Return delta = a tan(theta) arccos(b/a) and F = E* a^2 tan(theta) [arccos(b/a) + (b/a) sqrt(1 - b^2/a^2)]."""
    (depth, force), flat = unit(scene).values(), scene.indenter.flat_radius / c.radius(scene)
    angle = float(np.arccos(flat))
    return {"indentation_depth": depth * angle, "normal_force": force * (angle + flat * float(np.sqrt(1 - flat**2)))}


REFERENCE = c.reference_numbers("truncated_cone", LAYERED, unit)
CLOSED: c.Words = {"tolerance": 1e-10, "fem": 3e-6, "bem": 3e-3}
LAYER: c.Words = {"tolerance": 1e-9, "fem": 3e-6, "bem": 2e-3, "mdr_table": 1e-2}
COARSE_TABLE = "a requirement: depth 3e-2, force 1e-1, stiffness 1.5e-2 where a cell is a third of the thickness"
NORMS: dict[str, Norm] = {"pressure agrees": "weighted L2", "ring loads agree": "ring loads"}
SINGULAR = "the logarithmic singularity at r = b and the root at r = a limit"
SPRINGS = "dF/d(delta) is the stiffness of the flat punch", "contact_stiffness"
MESHED = (*LAYERED, *HALF_SPACE)
ENERGY = "energy stiffness equals reaction stiffness", "energy_defect", MESHED
NO_NU = "unbonded layers do not see nu", c.having((*AT_ONE, *AT_FIVE), layer="unbonded")
KERNELS = dict.fromkeys(("mdr", "bem", "integral_equation", "mdr_table"), "its kernel, Eq. (29), has no nu")
UNBONDED: c.Words = {"identities": KERNELS, "fem": 3e-6, "bem": 1e-7}
TO_EQUATION: c.Words = {"against": "integral_equation", "name": "finite elements: first order in the edge cell"}
TO_FINEST: c.Words = {"against": r.FINEST_MDR, "name": "MDR: exponential in the Gauss nodes"}
TIMED = c.scene_name("bonded nu=0.45", 2.0)
CLAIMS = (
    *c.equals(c.depth_and_force("half-space"), closed_form, HALF_SPACE, WHY["sneddon"], **CLOSED),
    *c.equals(c.depth_and_force("layer"), REFERENCE, (), WHY["reference"], **LAYER),
    *c.agreements(LAYERED, c.required("fem", "bem", "integral_equation")),
    *c.agreements(RESOLVED, c.required("mdr_table")),
    *c.agreements(THIN, c.WITHIN["a third"], derived_from=COARSE_TABLE, suffix=", thin layers"),
    *c.pressure_agreements(LAYERED, NORMS, SINGULAR),
    # One claim per method: the suite ci has MDR on all these scenes, finite elements on some.
    c.carried_force("the pressure carries the force", LAYERED, "mdr"),
    c.carried_force("the pressure of finite elements carries the force", LAYERED, "fem"),
    c.zero(*SPRINGS, PATHS, WHY["spring stiffness"], tolerance=1e-9, derive=c.incremental_stiffness),
    c.zero(*ENERGY, WHY["energy"], tolerance=1e-8, methods=("fem",)),
    c.zero("patch test", "patch_defect", MESHED, WHY["patch"], tolerance=1e-12, methods=("fem",)),
    c.scaling_law("doubling E doubles F", AT_ONE, c.doubled_modulus, (1.0, 2.0, 2.0), WHY["linearity"]),
    c.same_in_millimetres(AT_ONE),
    c.scaling_law(*NO_NU, c.other_poissons_ratio, (1.0, 1.0, 1.0), WHY["unbonded kernel"], **UNBONDED),
    *r.studies(ENDS[1.0], "halved edge cell", {"normal_force": 1.0}, **TO_EQUATION),
    *r.studies(ENDS[5.0], "nodes on panels", ("normal_force",), **TO_FINEST),
    Ablation(scene=TIMED, slow=("fem",)),
    *r.costs("elastic, in ci and as published", TIMED),
)
CASE = c.paper(__name__, __doc__, (*LAYERED, *PATHS, *HALF_SPACE), c.EVERY, CLAIMS)
