"""Errors that MDR states on layer stacks: they cover the true ones, and are not much larger."""

from __future__ import annotations

import numpy as np
import pytest

from bem.flat_punch import IntegralEquation
from contact import (
    Adhesion,
    Cone,
    ContactRadii,
    Detachment,
    ElasticBase,
    FlatPunch,
    IndentationDepths,
    LayerStack,
    NormalForces,
    Paraboloid,
    PowerLaw,
    Scene,
    Sublayer,
    TruncatedCone,
    UnsupportedSceneError,
)
from mdr import Mdr

PARABOLOID = Paraboloid(radius_of_curvature=10.0)
AT_LOSS = ("pull_off_force", "pull_off_depth", "pull_off_contact_radius", "force_at_loss")
QUANTITIES = ("contact_radius", "indentation_depth", "normal_force", "contact_stiffness")
# Scenes of seed 3 that are refused because the contact would pull.
PULLING = (1, 7, 9, 16)


def random_stack(rng):
    """One to four sublayers of moduli e^-4 to e^4 and total thickness 1."""
    count = int(rng.integers(1, 5))
    share = np.exp(rng.uniform(np.log(0.05), 0.0, count))
    sublayers = tuple(
        Sublayer(
            thickness=float(h),
            youngs_modulus=float(np.exp(rng.uniform(-4, 4))),
            poissons_ratio=float(rng.choice([0.0, 0.3, 0.45, 0.499, 0.5])),
        )
        for h in share / share.sum()
    )
    base = ElasticBase(youngs_modulus=float(np.exp(rng.uniform(-4, 4))), poissons_ratio=0.3)
    supports = (base,) if count == 1 else (base, "bonded", "unbonded")
    faces = tuple(str(face) for face in rng.choice(["bonded", "unbonded"], count - 1, p=[0.8, 0.2]))
    return LayerStack(sublayers=sublayers, interfaces=faces, support=supports[int(rng.integers(len(supports)))])


def random_scene(rng):
    layer = random_stack(rng)
    a = min(float(np.exp(rng.uniform(np.log(0.1), np.log(3.0)))), 15 * layer.surface.thickness)
    indenter = (
        PARABOLOID,
        Cone(slope=0.1),
        TruncatedCone(flat_radius=a * rng.uniform(0.2, 0.8), slope=0.1),
        FlatPunch(radius=a),
        PowerLaw(exponent=4.0, reference_radius=1.0, reference_height=0.1),
    )[int(rng.integers(5))]
    punch = isinstance(indenter, FlatPunch)
    return Scene(layer=layer, indenter=indenter, loading=IndentationDepths([0.01]) if punch else ContactRadii([a]))


def stated_and_true(scenes, seed):
    """Stated errors on 8 to 12 nodes and the differences to twenty-four, those with a relative size above 2e-14."""
    rng, rows = np.random.default_rng(seed), []
    for _ in range(scenes):
        scene, nodes, kind = random_scene(rng), int(rng.integers(8, 13)), int(rng.integers(3))
        try:
            fine = Mdr().solve(scene)
            if kind and isinstance(scene.loading, ContactRadii):
                loading = IndentationDepths(fine.indentation_depth) if kind == 1 else NormalForces(fine.normal_force)
                scene = scene.replace(loading=loading)
            coarse = Mdr(flat_punch=IntegralEquation(nodes=nodes)).solve(scene)
        except UnsupportedSceneError:
            continue
        for name in QUANTITIES:
            stated = float(coarse.error_estimate[name][0])
            true = abs(float(getattr(coarse, name)[0] / getattr(fine, name)[0]) - 1)
            if stated > 0.0:
                rows.append((stated, true, float(fine.error_estimate[name][0])))
    return np.array(rows).T


@pytest.mark.slow
def test_they_cover_and_are_sharp():
    stated, true, own = stated_and_true(500, 1902)
    assert np.mean(true <= stated + own) >= 0.95
    ratio = (stated / np.maximum(true, 1e-300))[true > 2e-14]
    assert ratio.size > 1000
    assert np.median(ratio) < 10.0
    assert np.quantile(ratio, 0.9) < 100.0


def test_errors_of_adhering_contacts_tell_what_cancels_as_well():
    """A wrong kernel counted against the whole density, though most cancels in g: 90 % below 107 true ones, now 19."""
    rng, stated, true = np.random.default_rng(5), [], []
    for _ in range(6):
        layer = random_stack(rng)
        radii = ContactRadii(np.linspace(6.0, 9.6, 6) * layer.surface.thickness)
        scene = Scene(layer=layer, indenter=Cone(slope=0.1), loading=radii, effects=(Adhesion(work_of_adhesion=1e-3),))
        fine, coarse = (Mdr(flat_punch=IntegralEquation(nodes=nodes)).solve(scene) for nodes in (24, 12))
        stated.append(coarse.error_estimate["indentation_depth"])
        true.append(np.abs(coarse.indentation_depth - fine.indentation_depth) / np.abs(fine.indentation_depth).max())
    stated, true = np.concatenate(stated), np.concatenate(true)
    ratio = (stated / np.maximum(true, 1e-300))[true > 2e-14]
    assert np.mean(ratio >= 1) >= 0.95
    assert np.quantile(ratio, 0.9) < 40.0


def test_forces_of_adhering_cones_at_given_radii_are_covered():
    """Errors of g counted in F as in int k_N dg, but they oscillate and count in k_N g: twice as much under a cone."""
    rng, stated, true = np.random.default_rng(5), [], []
    for _ in range(10):
        layer = random_stack(rng)
        radii = ContactRadii(np.linspace(0.7, 1.4, 15) * min(1.0, 5.0 * layer.surface.thickness))
        weak = Adhesion(work_of_adhesion=1e-5 * layer.contact_modulus)
        scene = Scene(layer=layer, indenter=Cone(slope=0.1), loading=radii, effects=(weak,))
        fine, coarse = (Mdr(flat_punch=IntegralEquation(nodes=nodes)).solve(scene) for nodes in (24, 12))
        stated.append(coarse.error_estimate["normal_force"] + fine.error_estimate["normal_force"])
        true.append(np.abs(coarse.normal_force - fine.normal_force) / np.abs(fine.normal_force).max())
    stated, true = np.concatenate(stated), np.concatenate(true)
    assert np.mean(true <= stated) >= 0.95
    assert np.median(stated[true > 2e-14] / true[true > 2e-14]) < 10.0


def test_pressures_count_the_panel_that_the_edge_lies_on():
    """Seen to fail: ten million times the true error in the median, as if narrow panels were as wide as the widest."""
    ratio = []
    for number in range(16):
        scene = random_scene(np.random.default_rng([3, number]))
        a = 0.4 * scene.layer.surface.thickness
        scene = scene.replace(indenter=PARABOLOID, loading=ContactRadii([a]))
        coarse, fine = (Mdr(flat_punch=IntegralEquation(nodes=nodes)).solve(scene) for nodes in (12, 24))
        r = a * np.array([0.1, 0.3, 0.5, 0.7, 0.9])
        true = np.abs(coarse.pressure(r, 0) - fine.pressure(r, 0)).max() / fine.pressure(r, 0).max()
        ratio.append(float(coarse.error_estimate["pressure"][0]) / max(true, 2e-14))
    assert np.mean(np.array(ratio) >= 1.0) > 0.9
    assert np.median(ratio) < 30.0


def pressure_and_stated(number, seed=3, nodes=12, finer=24):
    """Of scene `number` on few nodes: the pressure's relative distance from more in a norm, and the stated one."""
    scene = random_scene(np.random.default_rng([seed, number]))
    coarse, fine = (Mdr(flat_punch=IntegralEquation(nodes=count)).solve(scene) for count in (nodes, finer))
    a = float(coarse.contact_radius[0])
    r = a * np.linspace(0.02, 0.98, 25)
    weight = r * (a - r) * (a + r)
    p, q = coarse.pressure(r, 0), fine.pressure(r, 0)
    return np.sqrt(weight @ (p - q) ** 2 / (weight @ q**2)), float(coarse.error_estimate["pressure"][0])


def test_pressures_beside_a_rim_hardly_left_count_what_the_excess_errs():
    """Seen to fail: 26 times what was stated, since an error of the radius counted over the radius."""
    sublayers = tuple(
        Sublayer(thickness=h, youngs_modulus=E, poissons_ratio=0.5) for h, E in ((0.745, 25.227), (0.255, 0.439))
    )
    layer = LayerStack(sublayers=sublayers, interfaces=("bonded",), support="bonded")
    indenter = TruncatedCone(flat_radius=0.2273, slope=0.1)
    scene = Scene(layer=layer, indenter=indenter, loading=ContactRadii([0.22815]))
    scene = scene.replace(loading=IndentationDepths(Mdr().solve(scene).indentation_depth))
    r = np.append(0.2273 * np.linspace(0.05, 0.95, 10), np.linspace(0.22735, 0.2281, 10))
    coarse, fine = (Mdr(flat_punch=IntegralEquation(nodes=nodes)).solve(scene) for nodes in (12, 36))
    change = np.abs(coarse.pressure(r, 0) / fine.pressure(r, 0) - 1)
    assert np.median(change[r > 0.2273]) < coarse.error_estimate["pressure"][0]


@pytest.mark.parametrize("number", [72, 104, 146])
def test_pressures_of_small_punches_count_what_their_edge_value_errs(number):
    """Seen to fail: 0.91, 0.18 and 0.37 of the true error were stated."""
    true, stated = pressure_and_stated(number, 51, 12, 36)
    assert true <= stated


def test_pressures_count_psi_where_k_bar_is_one_by_accident():
    """k_bar = 0.98 and c_bar = 0.41; seen to fail: a twentieth of the true error was stated."""
    true, stated = pressure_and_stated(87)
    assert stated > 0.5 * true


def detachment(seed, number):
    """A scene of `random_scene` pulled off against a work of adhesion between 1e-6 and 0.1."""
    rng = np.random.default_rng([seed, number])
    scene, effects = random_scene(rng), (Adhesion(work_of_adhesion=float(10 ** rng.uniform(-6, -1))),)
    return scene.replace(loading=Detachment(control=str(rng.choice(["displacement", "force"]))), effects=effects)


def lost_and_stated(seed, number):
    """Of a detachment on 12 nodes: relative errors and stated ones, which count those of 24 nodes."""
    coarse, fine = (Mdr(flat_punch=IntegralEquation(nodes=nodes)).solve(detachment(seed, number)) for nodes in (12, 24))
    true = [abs(getattr(coarse, name) / getattr(fine, name) - 1) for name in AT_LOSS]
    stated, own = ([float(path.error_estimate[name][0]) for name in AT_LOSS] for path in (coarse, fine))
    return np.array(true), np.array(stated), np.array(own)


@pytest.mark.parametrize("number", [79, 97])
def test_jumps_between_panels_of_few_nodes_are_no_rough_springs(number):
    """Seen to fail: NotConvergedError, as panels were halved towards jumps of 3e-7 that no polynomial resolves."""
    true, stated, own = lost_and_stated(77, number)
    assert np.all(true <= stated + own)
