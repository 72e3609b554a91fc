"""A paraboloid is pressed into a relaxing layer at constant speed and held: a prescribed history of the depth.

On an incompressible half-space the contact grows and then rests, so that the theory of Lee and Radok gives the force,
F = (16/3) sqrt(R) int G(t - s) d(delta^(3/2)). On a bonded layer MDR, in which every spring relaxes by itself, is
compared with finite elements, which solve a contact problem at every step; compared is the force at the end. The solid
is that of the impacts of Section 4.3. The same paraboloid under a force that rises and is held creeps: compared is its
depth at the end. Where half of that force is taken away again MDR steps in time, and its depths converge. The same
history on an elastic layer has no error in time: it shows that of the cells alone.
"""

from dataclasses import replace

import numpy as np

from cases.declare.case import Case, CaseScene, text_of
from cases.library._claims import agreements, exact
from cases.library._convergence import CELLS_AND_STEPS, FINEST_MDR, RECEDING_ACCURACY, studies
from cases.library._methods import MDR
from cases.library._reasons import reasons
from cases.library.in_time.sphere_impact import (
    FEM,
    LONG_TERM_MODULUS,
    MAXWELL_MODULUS,
    RADIUS_OF_CURVATURE,
    RELAXATION_TIME,
)
from contact import DepthHistory, ForceHistory, Layer, Paraboloid, Scene, StandardSolid

WHY = reasons("held_indentation")

DEPTH = 5e-5  # m
FORCE = 2.0  # N
# Pressing [s] takes as long as the solid takes to relax.
RAMP = 1e-3
END = 2 * RAMP
THICKNESS = 1e-3  # m
INSTANTANEOUS = LONG_TERM_MODULUS + MAXWELL_MODULUS
SOLID = StandardSolid(
    long_term_shear_modulus=LONG_TERM_MODULUS,
    maxwell_shear_modulus=MAXWELL_MODULUS,
    viscosity=MAXWELL_MODULUS * RELAXATION_TIME,
)


TIME = np.array([0.0, RAMP, END])
PRESSED = DepthHistory(time=TIME, depth=np.array([0.0, DEPTH, DEPTH]))
LOADED = ForceHistory(time=TIME, force=np.array([0.0, FORCE, FORCE]))
EASED = ForceHistory(time=TIME, force=np.array([0.0, FORCE, FORCE / 2]))


def case_scene(
    name: str, layer: Layer, *effects: StandardSolid, loading: DepthHistory | ForceHistory = PRESSED
) -> CaseScene:
    """Return the history on a layer."""
    scene = Scene(
        layer=layer,
        indenter=Paraboloid(radius_of_curvature=RADIUS_OF_CURVATURE),
        loading=loading,
        effects=effects,
    )
    # Finite elements search the depth of every force, MDR that of forces that fall, which takes seconds.
    by_force = isinstance(loading, ForceHistory)
    return CaseScene(name=name, parameters={"layer": name}, scene=scene, nightly=("mdr", "fem") if by_force else ())


BONDED = Layer.incompressible(thickness=THICKNESS, shear_modulus=INSTANTANEOUS)
INFINITE = Layer.half_space(youngs_modulus=3 * INSTANTANEOUS, poissons_ratio=0.5)
HALF_SPACE = case_scene("relaxing half-space", INFINITE, SOLID)
CREEPING_HALF_SPACE = case_scene("creeping half-space", INFINITE, SOLID, loading=LOADED)
CREEPING = case_scene("creeping bonded layer", BONDED, SOLID, loading=LOADED)
EASED_SCENES = tuple(
    replace(case_scene(f"eased {name}", layer, SOLID, loading=EASED), methods=(MDR,), nightly=("mdr",))
    for name, layer in (("half-space", INFINITE), ("bonded layer", BONDED))
)
RELAXING = case_scene("relaxing bonded layer", BONDED, SOLID)
ELASTIC = case_scene("elastic bonded layer", BONDED)


def lee_and_radok(scene: Scene) -> list[float]:
    """F [N] at the end; with s = S u^2 and ramp S the integrand is smooth up to the start."""
    del scene
    nodes, weights = np.polynomial.legendre.leggauss(40)
    u, weights = (nodes + 1) / 2, weights / 2
    relaxed = LONG_TERM_MODULUS + MAXWELL_MODULUS * np.exp(-(END - RAMP * u**2) / RELAXATION_TIME)
    # d(delta^(3/2)) = (3/2) D^(3/2) S^(-3/2) s^(1/2) ds with the depth D, and ds = 2 S u du.
    growth = 3 * DEPTH**1.5 * u**2
    return [float(16 / 3 * np.sqrt(RADIUS_OF_CURVATURE) * (relaxed * growth) @ weights)]


def creep(scene: Scene) -> list[float]:
    """delta [m] at the end: delta^(3/2) = 3/(16 sqrt(R)) int J(t - s) dF, J the compliance that belongs to G."""
    del scene
    # J relaxes more slowly than G, by the ratio of the moduli.
    slower = RELAXATION_TIME * INSTANTANEOUS / LONG_TERM_MODULUS
    fading = slower / RAMP * (np.exp(-(END - RAMP) / slower) - np.exp(-END / slower))
    compliance = 1 / LONG_TERM_MODULUS - (1 / LONG_TERM_MODULUS - 1 / INSTANTANEOUS) * fading
    return [float((3 / 16 * FORCE * compliance / np.sqrt(RADIUS_OF_CURVATURE)) ** (2 / 3))]


ORDERS = (
    *studies(EASED_SCENES, RECEDING_ACCURACY, ("indentation_depth",), against=FINEST_MDR, nightly=True),
    *studies((ELASTIC,), CELLS_AND_STEPS, {"normal_force": 2.0}, against=FINEST_MDR, nightly=True),
)

CASE = Case(
    name="held_indentation",
    title="Pressing and holding on a relaxing layer",
    question="Do MDR and finite elements follow a prescribed history, and with which orders?",
    equations=("Eq. (51)", "Eq. (52)"),
    text=text_of(__doc__),
    scenes=(HALF_SPACE, RELAXING, ELASTIC, CREEPING_HALF_SPACE, CREEPING, *EASED_SCENES),
    methods=(MDR, FEM),
    claims=(
        *exact(
            WHY["lee and radok"],
            {"force on the half-space": ("normal_force", lee_and_radok)},
            scenes=(HALF_SPACE,),
            tolerance=1e-8,
            tolerances={"fem": 2e-3},
        ),
        *exact(
            WHY["creep"],
            {"depth on the half-space": ("indentation_depth", creep)},
            scenes=(CREEPING_HALF_SPACE,),
            tolerance=1e-8,
            tolerances={"fem": 2e-3},
        ),
        *agreements(
            (CREEPING,),
            {"fem": 2e-3},
            ("indentation_depth",),
            derived_from="three times what finite elements state for 120 cells and 400 steps, 6.5e-4",
            suffix=", creep",
        ),
        *agreements(
            (RELAXING, ELASTIC),
            {"fem": 2e-3},
            ("normal_force",),
            derived_from="three times what finite elements state for 120 cells and 400 steps, 6.5e-4",
        ),
        *ORDERS,
    ),
)
