"""Thirty and more faults of the kinds that happen: where each is, what it does, and what must catch it.

`status` is what the guard must answer while the fault is on; without the fault every guard passes.
"""

import dataclasses
import math
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from tempfile import mkdtemp
from types import SimpleNamespace

import numpy as np

from cases.rules import Judgement
from cases.verdicts import Status
from contact import Layer, Paraboloid, Sphere, Spheroconical, TruncatedParaboloid
from tests.cases.fake_case import FAST
from tests.cases.gate.example_baselines import NOW, accepted
from tests.planted.guards import TEMPORARY, Claims, Test
from tests.planted.planting import found, override, set_to, swap


@dataclass(frozen=True)
class Fault:
    """One fault.

    Attributes:
        name: what is wrong, in words.
        area: its name in `AREAS`.
        plant: switches it on with a monkeypatch.
        guard: what must catch it.
        status: how the guard must end.
    """

    name: str
    area: str
    plant: Callable
    guard: Claims | Test
    status: Status = Status.FAIL


def cone(claims, scene, method):
    """Claims of the truncated cone about one method on one scene, with the library's own tolerances."""
    return Claims("truncated_cone", claims, (scene,), (method,))


PARABOLOID, SPHERE = Paraboloid(radius_of_curvature=0.02), Sphere(radius=0.02)
BONDED = Layer(thickness=1.0, youngs_modulus=0.91, poissons_ratio=0.3)
LAYER = ("layer depth", "layer force")
HALF_SPACE = ("half-space depth", "half-space force")

# -- kernels ---------------------------------------------------------------------------------------------------------


def plane_stress_kolosov(kernel):
    """kappa = (3 - nu)/(1 + nu), that of plane stress, is the kernel of another Poisson's ratio."""
    return lambda self, q: kernel(_with_ratio(self, lambda nu: nu / (1 + nu)), q)


def _with_ratio(stack, change):
    """The same layers with other Poisson's ratios."""
    sheets = (dataclasses.replace(one, poissons_ratio=change(one.poissons_ratio)) for one in stack.sheets)
    return dataclasses.replace(stack, sheets=tuple(sheets))


def unbonded_without_linear_term(kernel):
    """2 sinh^2(q)/sinh(2q): the 2q of the denominator is forgotten, 1 - chi = 2 D/(1 + D) with D = exp(-2q)."""

    def wrong(self, q):
        D = np.exp(-2 * np.asarray(q))
        return 2 * D / (1 + D) if self.sheets[0].slips_below else kernel(self, q)

    return wrong


def half(resolvent):
    """Half of the resolvent: y_1 - 1 is half of what it is."""
    return property(lambda self: resolvent(self) / 2)


def times(factor):
    """The answer of a function times a factor."""
    return lambda right: lambda *arguments: factor * right(*arguments)


KERNELS = {
    "Kolosov's constant of plane stress": (
        override("bem.kernels.stack:StackKernel", "one_minus_chi", plane_stress_kolosov),
        cone(LAYER, "bonded nu=0.45 a/h=1", "mdr"),
    ),
    "2q forgotten in the unbonded kernel": (
        override("bem.kernels.stack:StackKernel", "one_minus_chi", unbonded_without_linear_term),
        cone(LAYER, "unbonded a/h=1", "mdr"),
    ),
    "sinh 2q - 2q subtracted at small q": (
        set_to("bem.kernels.stack:_SERIES", 1e-9),
        Test("bem.test_kernels:test_kernel_keeps_full_relative_accuracy", ("bonded", 0.5)),
    ),
    "1 - chi wrong in the eighth digit": (
        override("bem.kernels.stack:StackKernel", "one_minus_chi", times(1 + 1e-8)),
        Claims("flat_punch_stiffness", ("stiffness to ten digits",), ("bonded nu=0.5 a/h=1",), ("mdr",)),
    ),
    "mean mode of a layer taken as zero": (
        set_to("bem.grid.influence:LEAST_SHARE", 1e6),
        Test(
            "bem.test_grid:test_a_uniform_pressure_compresses_a_layer_by_its_finite_mean_mode", ("unbonded", 0.3, 0.5)
        ),
    ),
    # The stated error grows with the true one.
    "five wave numbers on a panel where twenty are needed": (
        override("bem.equation:Sizes", "scaled", lambda f: lambda self, factor: f(self, factor)._replace(nodes=5)),
        cone(LAYER, "bonded nu=0.5 a/h=5", "mdr"),
        Status.INCONCLUSIVE,
    ),
    "resolvent of the equation counted half": (
        override("bem.equation:Radius", "resolvent", half),
        cone(LAYER, "bonded nu=0.5 a/h=1", "mdr"),
    ),
}

# -- the fast method -------------------------------------------------------------------------------------------------


def cone_without_flat_end(transform):
    """g_hs = (pi/2) tan(theta) (x - b): the truncated cone as a cone that starts at b."""
    return lambda self, x: np.pi / 2 * self._pieces[0, 0] * (x - self.flat)


def larger_harmonics(edges):
    """phi_n(a) times the root of two."""

    def wrong(self, shape, radii):
        phi, growth = edges(self, shape, radii)
        return math.sqrt(2) * phi, growth

    return wrong


def half_moment(at):
    """M counted half."""

    def wrong(self, *arguments):
        values = at(self, *arguments)
        return values._replace(M=values.M / 2)

    return wrong


def force_times(factor):
    """The force times a factor, the last one of a path if the factor is not a number."""

    def of(state):
        def wrong(self, *arguments):
            values = state(self, *arguments)
            force = values.force * factor
            if np.isnan(factor):
                force[:-1] = values.force[:-1]
            return values._replace(force=force)

        return wrong

    return of


def stiffness_of_the_contact(at):
    """y_1^2 = K/a: springs as stiff as the contact is on average."""

    def wrong(self, radii, *excess):
        values = at(self, radii, *excess)
        y1 = np.sqrt(values.K / radii)
        return values._replace(g=values.g * values.y1 / y1, y1=y1)

    return wrong


MDR = {
    "E in place of E*": (
        swap("bem.kernels.moduli:contact_modulus", lambda _: lambda layer: layer.surface.youngs_modulus),
        cone(HALF_SPACE, "half-space b/a=0.5", "mdr"),
    ),
    "profile's share of the force counted half": (
        override("mdr.spring_bed:Springs", "at", half_moment),
        cone(HALF_SPACE, "half-space b/a=0.5", "mdr"),
    ),
    "flat end forgotten in the half-space transform": (
        override("mdr.profiles:PiecewiseTip", "transform", cone_without_flat_end),
        cone(HALF_SPACE, "half-space b/a=0.5", "mdr"),
    ),
    "force wrong in the ninth digit": (
        override("mdr.spring_bed:Springs", "state", force_times(1 + 1e-9)),
        cone(HALF_SPACE, "half-space b/a=0.5", "mdr"),
    ),
    "second order of a nearly round contact counted twice": (
        override("mdr.shapes:Expanded", "_edges", larger_harmonics),
        Claims("nearly_round", ("force on an ellipse",), ("elliptic paraboloid, half-space",), ("mdr",)),
    ),
    "layer forgotten in the equation of harmonics": (
        override("mdr.harmonics:Harmonics", "_solve", lambda _: lambda self, radius: None),
        Test("verification.test_shapes:test_the_second_order_of_the_force_is_that_of_cells", (2, 1.0, 0.5)),
    ),
    # A search that misses its load raises.
    "search for the radius ends after one step": (
        set_to("mdr.radius_search:_MOST_STEPS", 1),
        Test(
            "mdr.test_method:test_radii_depths_and_forces_describe_the_same_path",
            ("bonded", SPHERE),
        ),
        Status.INVALID,
    ),
    "pressure of Eq. (9) twice too large": (
        override("mdr.contact_surface:Surface", "_inside", times(2)),
        Test(
            "mdr.test_method:test_the_pressure_carries_the_force",
            ("bonded", PARABOLOID),
        ),
    ),
    "layer's share of the pressure with the other sign": (
        override("mdr.contact_surface:Surface", "_image", times(-1)),
        Test(
            "mdr.test_method:test_the_pressure_carries_the_force",
            ("bonded", PARABOLOID),
        ),
    ),
    "contact stiffness in place of spring stiffness": (
        override("mdr.spring_bed:Springs", "at", stiffness_of_the_contact),
        cone(LAYER, "bonded nu=0.5 a/h=1", "mdr"),
    ),
    "a force that is not a number": (
        override("mdr.spring_bed:Springs", "state", force_times(np.nan)),
        cone(HALF_SPACE, "half-space b/a=0.5", "mdr"),
        Status.INVALID,
    ),
}


# -- transforms and the boundary elements ----------------------------------------------------------------------------


TRANSFORMS = {
    "inverse transform without its factor in one direction": (
        override(
            "bem.grid.transforms:CosineFilter", "__call__", lambda f: lambda self, p, s: f(self, p, s) * self.period
        ),
        Test("bem.test_grid:test_a_sinusoidal_load_has_its_closed_form", (BONDED,)),
    ),
    "no zero padding: the convolution is circular": (
        swap("bem.grid.operators:fast_period", lambda f: lambda least: f(least // 2)),
        Test(
            "bem.test_grid:test_free_space_is_the_sum_over_all_cells", (lambda: found("bem.grid.operators:HALF_SPACE"),)
        ),
    ),
    "Love's solution without 1/pi": (
        swap("bem.grid.influence:rectangle_influence", times(np.pi)),
        Test("bem.test_grid:test_a_cell_under_its_own_pressure_sinks_by_the_closed_form"),
    ),
    "layer correction with the wrong sign": (
        swap("bem.grid.influence:_cell_means", times(-1)),
        Test("bem.test_grid:test_printed_stiffness_is_met_on_a_grid_of_256", ("bonded", 0.3)),
    ),
    "complementarity never violated, whatever the pressure": (
        override("bem.grid.fields:ContactFields", "refuse_pulling", lambda _: lambda *a: None),
        Test("bem.test_grid:test_a_dent_in_which_cells_would_pull_is_refused_with_its_place"),
    ),
}

# -- weak forms ------------------------------------------------------------------------------------------------------


def without_hoop(strains):
    """u_r / r is no strain."""

    def wrong(*of):
        values = strains(*of)
        values[:, 2] = 0.0
        return values

    return wrong


def without_radius(measure):
    """dr dz where 2 pi r dr dz belongs."""
    return lambda jacobian, radius, weights: measure(jacobian, radius, weights) / radius


def deviator_in_the_plane():
    """A half where a third belongs: the deviator of two dimensions."""
    deviator = np.eye(4)
    deviator[:2, :2] -= 1 / 2
    return deviator


def sliding_base(held):
    """The base of a bonded layer slides."""

    def wrong(self):
        return np.unique(np.concatenate([2 * self.nodes_on("axis"), 2 * self.nodes_on("base") + 1]))

    return property(wrong)


def plane_strain_bulk(moduli):
    """1/K = (1 - 2 nu)/mu, that of plane strain."""

    def wrong(modulus, nu):
        right = moduli(modulus, nu)
        return right._replace(compressibility=(1 - 2 * nu) / right.shear)

    return wrong


def unit_of_e(_):
    """Stresses in units of E, where the moduli of finite elements are those of E* = 1."""
    return lambda layer: layer.youngs_modulus


def free_outer_edge(matrix):
    """The unbonded layer ends at the mesh."""
    return lambda layer: 0 * matrix(layer)


REFUSED = Status.INVALID  # energy and reactions give different stiffnesses: the method itself refuses the answer


def weak(plant, scene, status=Status.FAIL):
    """A fault of the finite elements; the guard compares with an integral equation that shares no line with them."""
    return plant, Test("fem_reference.test_method:test_truncated_cone_within_its_error_bars", scene), status


THICK, THIN = (0.1, 0.45, "bonded"), (20, 0.45, "bonded")  # a/h, nu, support
WEAK_FORMS = {
    "hoop strain forgotten": weak(swap("fem_reference.assembly:strains", without_hoop), THICK, REFUSED),
    "r forgotten in 2 pi r dr dz": weak(swap("fem_reference.assembly:measures", without_radius), THICK, REFUSED),
    "deviator of two dimensions": weak(
        set_to("fem_reference.assembly:DEVIATOR", deviator_in_the_plane()), THICK, REFUSED
    ),
    "bonded base that slides": weak(
        override("fem_reference.layer:DiscreteLayer", "supported_unknowns", sliding_base), THIN
    ),
    "bulk modulus of plane strain": weak(swap("fem_reference.materials:moduli", plane_strain_bulk), THICK, REFUSED),
    "Young's modulus as the unit of stress": weak(
        swap("fem_reference.materials:contact_modulus", unit_of_e), (0.1, 0.5, "bonded")
    ),
    "free outer edge of an unbonded layer": weak(
        swap("fem_reference.layer:membrane_matrix", free_outer_edge), (20, 0.3, "unbonded")
    ),
}

# -- time stepping ---------------------------------------------------------------------------------------------------


def weaker(together):
    """Forces on bodies that move are a hundredth too small."""

    def wrong(*arguments, **options):
        impacts = together(*arguments, **options)
        return dataclasses.replace(impacts, pull=0.99 * impacts.pull)

    return wrong


def forgets_slowly(fading):
    """E = exp(-0.9 (t - t_c)/tau): what was remembered at first contact fades a tenth too slowly."""
    return lambda phase, share: fading(phase, share) ** 0.9


def released_late(end):
    """The punch lets go a hundredth of the contact time after the force is back at zero."""

    def wrong(phase, *step):
        value, rate = end(phase, *step)
        return value + 0.01 * phase.duration * rate, rate

    return wrong


def arctan_beyond_one(restitution):
    """The oscillating branch of Eq. (49) continued beyond D = 1 without its artanh."""

    def wrong(damping):
        D = np.asarray(damping, dtype=float)
        root = np.sqrt(abs(1 - D**2))
        return np.where(D < 1, restitution(damping), np.exp(-2 * D / root * np.arctan2(root, D)))

    return wrong


def creeping_too_fast(patch):
    """Free springs creep back one per cent too fast."""
    from mdr.history.spring_law import SpringLaw

    right = SpringLaw.modes.func
    patch.setattr(SpringLaw, "modes", property(lambda law: right(law)._replace(rates=1.01 * right(law).rates)))


def seen_at_the_end(patch):
    """A touch or release that is over before the end of a step goes unseen."""
    from mdr.history import spring_bed

    def wrong(course):
        return np.where(course.values(np.ones((1, 1)))[0] < 0, 1.0, np.inf)

    patch.setattr(spring_bed, "first_fall", wrong)


TIME_STEPPING = {
    "free springs recover one per cent too fast": (
        creeping_too_fast,
        Test(
            "verification.test_reloading_histories:test_reloading_on_a_recovering_surface_is_what_each_spring_says",
            ("touched again", 0.1),
        ),
    ),
    "touches within a step unseen": (
        seen_at_the_end,
        Test("mdr.test_recovery:test_a_spring_that_is_touched_and_released_within_one_step"),
    ),
    "a hundredth of the force left out of the motion": (
        swap("mdr.impact.blows:_together", weaker),
        Claims("flat_punch_impact", ("restitution on the half-space",), ("half-space D=0.2",), ("mdr",)),
    ),
    "memory of first contact that fades too slowly": (
        override("mdr.impact.motion:Shrinkage", "fading_since", forgets_slowly),
        Claims("sphere_impact", ("restitution on layers", "energy balance"), ("bonded h=2 mm",), ("mdr",)),
    ),
    "release after the force is zero": (
        override("mdr.impact.motion:Shrinkage", "end", released_late),
        Test("mdr.test_contact_fronts:test_a_punch_that_a_dashpot_stops_leaves_when_two_exponentials_say", (3.0,)),
    ),
    "overdamped branch continued with arctan": (
        swap("docs.gallery._flat_punch_restitution:kelvin_voigt_restitution", arctan_beyond_one),
        Test("verification.test_impact:test_flat_punch_restitution_is_smooth_through_critical_damping"),
    ),
    "half of the dissipation": (
        swap("mdr.impact.history:_inverse", times(1 / 2)),
        Claims("sphere_impact", ("restitution on layers", "energy balance"), ("bonded h=2 mm",), ("mdr",)),
    ),
}


# -- adhesion ---------------------------------------------------------------------------------------------------------


ADHESION = {
    "2 pi lost in the elongation": (
        override("mdr.adhesive:Adhesive", "elongation", times((2 * np.pi) ** -0.5)),
        Claims("paraboloid_adhesion", ("JKR pull off force",), ("half-space, force",), ("mdr",)),
    ),
    "E in place of E* under adhesion": (
        swap("bem.kernels.moduli:contact_modulus", lambda _: lambda layer: layer.surface.youngs_modulus),
        Claims("paraboloid_adhesion", ("JKR pull off depth",), ("half-space, force",), ("mdr",)),
    ),
    "stability turned upside down": (
        override("bem.branch:Branch", "stable", lambda stable: lambda *arguments: ~stable(*arguments)),
        Test(
            "verification.test_adhesion:test_equilibrium_and_stability_are_those_of_the_energy",
            (
                Layer.half_space(youngs_modulus=0.75, poissons_ratio=0.5),
                Paraboloid(radius_of_curvature=1.0),
            ),
        ),
    ),
}


# -- friction ---------------------------------------------------------------------------------------------------------


def held_at_zero(equilibrium):
    """A new point is pulled back to where it lay before anything was pressed."""

    def wrong(before, *others):
        return equilibrium(dataclasses.replace(before, displacements=0.0 * before.displacements), *others)

    return wrong


def coupled_the_other_way(rubbed):
    """The coupling of pressure and radial displacement has the other sign: the force does not change, q does."""

    def wrong(surface, *others):
        sign = np.where(np.arange(len(surface.compliance)) < len(surface.radii), 1.0, -1.0)
        return rubbed(dataclasses.replace(surface, compliance=np.outer(sign, sign) * surface.compliance), *others)

    return wrong


def heat_of_the_traction_before(accounted):
    """What slid is counted with the traction before the step, which pointed the other way where the slip turned."""

    def wrong(before, after):
        heat = -(before.shear * (after.radial - before.radial))[after.sliding != 0]
        return dataclasses.replace(accounted(before, after), dissipated=before.dissipated + float(heat.sum()))

    return wrong


def forgetting_the_way(advance):
    """The displacement of points ahead of the contact is not remembered when they touch."""

    def wrong(before, active, end):
        radial = np.where(np.arange(len(before.radial)) >= before.active, 0.0, before.radial)
        moved = np.append(before.displacements[: len(radial)], radial)
        return advance(dataclasses.replace(before, displacements=moved), active, end)

    return wrong


def pulled_inward(rows):
    """The radial displacement of the fast method nearly without its sign."""

    def wrong(*arguments):
        radial, *others = rows(*arguments)
        return np.array([-0.9 * radial, *others])

    return wrong


def lower_layers_turned(beyond):
    """What a stack's lower layers add to the coupling has the other sign."""

    def wrong(kernel, wavenumber):
        found, alone = beyond(kernel, wavenumber), beyond(type(kernel).single("bonded", 0.5), wavenumber)
        return found[0], 2.0 * alone[1] - found[1], found[2]

    return wrong


def more_friction(factor):
    """Finite elements rub with a coefficient too large by a factor."""

    def of(solve):
        def wrong(method, scene):
            effects = tuple(effect.replace(coefficient=factor * effect.coefficient) for effect in scene.effects)
            return dataclasses.replace(solve(method, scene.replace(effects=effects)), scene=scene)

        return wrong

    return override("fem_reference:Fem", "solve", of)


def rubbing(name, *arguments):
    """A test of the friction of finite elements."""
    return Test(f"fem_reference.test_friction:{name}", arguments)


STUCK = rubbing("test_full_stick_is_that_of_mdr", 0.0, "bonded", 1.0, Paraboloid(radius_of_curvature=10.0))
RECIPROCITY = Claims(
    "friction_paraboloid",
    ("the first order is that of reciprocity",),
    ("nu=0.5 mu=0.04", "nu=0.5 mu=0.02"),
    ("fem",),
)


FRICTION = {
    "heat given back": (
        swap("fem_reference.friction.step:_accounted", heat_of_the_traction_before),
        rubbing("test_work_is_stored_or_dissipated_with_second_order_in_the_cells"),
    ),
    # That feeds energy in: no equilibrium is found.
    "friction along the slip": (
        swap("fem_reference.friction.step:_sliding", times(-1)),
        rubbing("test_coulombs_law_holds_and_slip_goes_against_the_traction"),
        Status.INVALID,
    ),
    "a layer that pulls inward where it pushes outward": (
        swap("mdr.inside:_from_rows", pulled_inward),
        rubbing("test_slope_at_vanishing_friction_is_that_of_reciprocity", 0.5, "bonded", 0.12),
    ),
    "new points held where nothing was pressed": (
        swap("fem_reference.friction.step:_equilibrium", held_at_zero),
        STUCK,
        Status.INVALID,
    ),
    "new points forget that they slid on the way": (
        swap("fem_reference.friction.step:advance", forgetting_the_way),
        STUCK,
        Status.INVALID,
    ),
    "pressure that pushes the surface the other way": (
        swap("fem_reference.friction.step:RubbedContact", coupled_the_other_way),
        STUCK,
    ),
    # Every second point then moves by another law.
    "two cells of the tractions on each cell of the mesh": (
        set_to("fem_reference.friction.growth:RUBBED_STRIDE", 2),
        rubbing("test_forces_under_stick_converge_to_those_of_mdr_with_second_order", "bonded"),
    ),
    "lower layers that pull where they push": (
        override("bem.kernels.stack:StackKernel", "beyond_half_space", lower_layers_turned),
        Test("mdr.test_stick_on_stacks:test_finite_elements_agree_on_one_stack"),
    ),
    # One per cent is within the stated error of the force.
    "friction one per cent too large": (more_friction(1.01), RECIPROCITY, Status.INCONCLUSIVE),
    "friction ten per cent too large": (more_friction(1.1), RECIPROCITY),
}

# -- comparators -----------------------------------------------------------------------------------------------------


def sign_ignored(judge):
    """error <= tolerance: every number that is too small passes."""
    return lambda error, *others, **more: judge(0.0 if error < 0.0 else error, *others, **more)


def everything_finite(_):
    """NaN passes for a number."""
    return SimpleNamespace(isfinite=lambda value: True, inf=math.inf, hypot=math.hypot)


def compared_with_itself(judged):
    """Both answers of an agreement are those of one method."""

    def wrong(self, case, scene, answers):
        first, second, *others = answers
        return judged(self, case, scene, [first, dataclasses.replace(first, method=second.method), *others])

    return wrong


def first_of(judgements):
    return judgements[0]


def natural_for_ratio(order):
    """ln r taken as r - 1."""

    def wrong(values, lengths):
        return order(values, lengths) * math.log(lengths[1] / lengths[0]) / (lengths[1] / lengths[0] - 1)

    return wrong


def without_circumference(norm):
    """dr where 2 pi r dr belongs."""

    def wrong(self, pressure):
        return norm(dataclasses.replace(self, weight=self.weight / (2 * np.pi * self.radius)), pressure)

    return wrong


COMPARATORS = {
    "sign of an error ignored": (
        swap("cases.rules:compared", sign_ignored),
        Test("cases.test_rules:test_exact_passes_within_and_fails_beyond"),
    ),
    "NaN taken for a number": (
        set_to("cases.rules:math", everything_finite(None)),
        Test("cases.test_rules:test_non_finite_is_invalid_and_never_equal_to_itself", (math.nan, math.nan)),
    ),
    "negative tolerances taken as positive": (
        swap("cases.rules:positive_tolerance", lambda _: abs),
        Test("cases.test_rules:test_a_tolerance_of_the_wrong_sign_is_refused", (-1e-10,)),
    ),
    "uncertainties ignored in a verdict": (
        swap("cases.rules:compared", lambda f: lambda error, stated, *a, **k: f(error, 0.0, *a, **k)),
        Test("cases.test_runner:test_a_coarse_method_is_inconclusive", (TEMPORARY,)),
    ),
    "an answer compared with itself": (
        override("cases.claims:Agree", "judged", compared_with_itself),
        Test("cases.test_runner:test_a_wrong_factor_disagrees", (TEMPORARY,)),
    ),
    "the first judgement in place of the worst": (
        swap("cases.rules:worst_judgement", lambda _: first_of),
        Test("cases.test_rules:test_the_worst_judgement_decides_and_an_empty_claim_is_refused"),
    ),
    "observed order with ln r taken as r - 1": (
        swap("cases.convergence:observed_order", natural_for_ratio),
        Test("cases.test_convergence:test_nasa_tutorial"),
    ),
    "safety factor of an order that fits, for any order": (
        swap(
            "cases.convergence:grid_convergence_index",
            lambda f: lambda fine, coarse, ratio, observed, formal, **k: f(fine, coarse, ratio, formal, formal, **k),
        ),
        Test(
            "cases.test_convergence:test_safety_factor_trusts_the_formal_order_only_within_ten_percent", (1.7, 3.0, 1.7)
        ),
    ),
    "norm without 2 pi r": (
        override("cases.norms:RingQuadrature", "norm", without_circumference),
        Test("cases.test_norms:test_weighted_norm_of_one_is_the_root_of_the_area"),
    ),
    "a run of nothing passes": (
        swap("cases.verdicts:exit_code", lambda f: lambda statuses, strict=False: 0),
        Test("cases.test_status:test_nothing_ran_is_not_a_pass"),
    ),
}

# -- baselines -------------------------------------------------------------------------------------------------------


def absent_passes(place):
    """What is absent from this run (1) or from the baseline (2) passes."""
    passed = Judgement(status=Status.PASS, message="")
    return lambda absent: lambda *a: passed if a[place] is None else absent(*a)


def accepted_folder():
    """Baselines of the fabricated run."""
    return accepted(Path(mkdtemp()))


BASELINES = {
    "missing records pass": (
        swap("cases.gate.gate:_absent", absent_passes(1)),
        Test("cases.gate.test_gate:test_what_differs_fails_by_its_name", (accepted_folder, "a missing quantity")),
    ),
    "extra records pass": (
        swap("cases.gate.gate:_absent", absent_passes(2)),
        Test("cases.gate.test_gate:test_what_differs_fails_by_its_name", (accepted_folder, "a method nobody accepted")),
    ),
    "tolerances a thousand times too wide": (
        swap("cases.gate.baseline:permitted_change", lambda f: lambda values, step: 1e3 * f(values, step)),
        Test(
            "cases.gate.test_gate:test_a_change_of_1e_7_with_tolerance_1e_9_always_fails",
            (accepted_folder, "mdr", 100, 1 + 1e-7),
        ),
    ),
    "unknowns within ten percent": (
        swap("cases.gate.gate:permitted_count_change", lambda f: lambda name, b: f("iterations", b)),
        Test(
            "cases.gate.test_gate:test_unknowns_within_2_percent_and_other_counters_within_a_fifth_or_three",
            (accepted_folder, 21421, 3, Status.DIFF),
        ),
    ),
    "settings left out of the specification": (
        swap("cases.run.keys:question", lambda f: lambda task: f(dataclasses.replace(task, use=FAST))),
        Test("cases.gate.test_baseline:test_another_scene_or_setting_is_another_question", (lambda: {"cell": 0.5},)),
    ),
    "uncommitted changes accepted": (
        swap("cases.gate.accept:_refused_circumstances", lambda _: lambda run, now: ()),
        Test(
            "cases.gate.test_accept:test_the_wrong_place_or_time_is_refused",
            (TEMPORARY, dataclasses.replace(NOW, changed=("mdr/core.py",)), "mdr/core.py"),
        ),
    ),
    "failing claims accepted": (
        swap("cases.gate.accept:_refused_run", lambda _: lambda answers, verdicts: ()),
        Test(
            "cases.gate.test_accept:test_a_failing_exact_or_order_claim_is_refused",
            (TEMPORARY, lambda: "exact", lambda: Status.FAIL),
        ),
    ),
    "tolerances loosened unnoticed": (
        override("cases.gate.accept:Change", "loosens", lambda _: property(lambda self: False)),
        Test(
            "cases.gate.test_accept:test_loosening_is_refused_without_the_flag_and_kept_with_its_reason", (TEMPORARY,)
        ),
    ),
    "slower code passes while its interval touches the limit": (
        swap(
            "benchmarks.race:slowdown",
            lambda f: lambda base, head: dataclasses.replace(f(base, head), lower=f(base, head).lower / 1.5),
        ),
        Test(
            "benchmarks.test_race:test_identical_code_passes_and_a_slowdown_of_one_and_a_half_fails_in_59_of_60_races"
        ),
    ),
}

# -- profiles --------------------------------------------------------------------------------------------------------


def one_percent(kind, name):
    """Profiles of a kind are answered with one of their radii 1 % larger."""

    def wrong(solve):
        def solved(self, scene):
            tip = scene.indenter
            larger = tip.replace(**{name: 1.01 * getattr(tip, name)}) if isinstance(tip, kind) else tip
            return solve(self, scene.replace(indenter=larger))

        return solved

    return wrong


TIPS = {
    "sphere": (Sphere, "radius"),
    "spheroconical": (Spheroconical, "radius"),
    "worn paraboloid": (TruncatedParaboloid, "radius_of_curvature"),
}
PROFILES = {
    f"{tip} 1 % too blunt for {method}, {body}": (
        override(place, "solve", one_percent(*what)),
        Claims("round_and_worn_tips", claims, (f"{tip}, {body}",), methods),
    )
    for tip, what in TIPS.items()
    for method, place in {"mdr": "mdr:Mdr", "fem": "fem_reference:Fem"}.items()
    for claims, body, methods in (
        (("depth of a tip", "force on a tip"), "half-space", (method,)),
        (("normal force: MDR and fem",), "bonded nu=0.5", ("mdr", "fem")),
    )
}

AREAS = {
    "kernels": KERNELS,
    "mdr": MDR,
    "transforms": TRANSFORMS,
    "weak forms": WEAK_FORMS,
    "time stepping": TIME_STEPPING,
    "adhesion": ADHESION,
    "friction": FRICTION,
    "comparators": COMPARATORS,
    "baselines": BASELINES,
    "profiles": PROFILES,
}
FAULTS = tuple(Fault(name, area, *fault) for area, group in AREAS.items() for name, fault in group.items())
