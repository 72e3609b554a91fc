"""The effect ledger of a case: what its scenes' parts move, from solving with and without."""

import functools

import pytest

from cases.answers import Table
from cases.case import Case, CaseScene
from cases.claims import Equal
from cases.declare.methods import MethodUse
from cases.effects import NOTHING_PULLS, Ablation
from cases.run.solve_task import job_of, solve
from contact import Adhesion, Detachment, FlatPunch, Impact, KelvinVoigt, Layer, Paraboloid, Scene
from tests.cases.fake_case import WHY

LAYER = Layer.incompressible(thickness=1.0, shear_modulus=1.0)
IMPACT = Scene(
    layer=LAYER,
    indenter=Paraboloid(radius_of_curvature=5.0),
    loading=Impact(mass=0.1, velocity=0.05),
    effects=(KelvinVoigt(shear_modulus=1.0, viscosity=1e-3),),
)
DETACHMENT = Scene(
    layer=LAYER,
    indenter=FlatPunch(radius=0.3),
    loading=Detachment(control="force"),
    effects=(Adhesion(work_of_adhesion=1e-4),),
)


@functools.cache
def entries(scene):
    study = Ablation(scene="scene", methods=("mdr",), slow=("fem",))
    claim = Equal(name="c", quantity="peak_force", to=lambda _: [1.0], tolerance=1.0, why=WHY)
    case = Case(
        name="ablated",
        title="t",
        question="q",
        equations=(),
        text="t",
        suites=("ci",),
        scenes=(CaseScene(name="scene", parameters={}, scene=scene),),
        methods=(MethodUse(label="mdr"),),
        claims=(claim, study),
    )
    answers = Table(solve(job_of(task)) for task in study.tasks(case))
    return {entry.part: entry for entry in study.records(case, answers)}


def test_a_little_viscosity_moves_restitution_and_may_be_dropped_where_that_does_not_matter():
    found = entries(IMPACT)
    assert set(found) == {"KelvinVoigt", "finite thickness"}
    viscosity = found["KelvinVoigt"]
    lost = viscosity.changes["coefficient_of_restitution"]
    assert 1e-4 < lost < 0.1  # an elastic impact returns all its speed, a damped one that much less
    assert viscosity.may_be_dropped(2 * max(viscosity.changes.values()))
    assert not viscosity.may_be_dropped(0.5 * lost)
    assert 0.0 <= viscosity.share_of_time <= 1.0


def test_a_detachment_is_nothing_without_adhesion():
    adhesion = entries(DETACHMENT)["Adhesion"]
    assert (adhesion.remark, adhesion.changes, adhesion.share_of_time) == (NOTHING_PULLS, {}, 1.0)
    assert not adhesion.may_be_dropped(1.0)


def test_the_finite_thickness_under_a_wide_punch_cannot_be_dropped():
    assert entries(DETACHMENT)["finite thickness"].changes["pull_off_depth"] > 0.1


@pytest.mark.parametrize(("suite", "methods"), [("ci", ("mdr",)), ("nightly", ("mdr", "fem"))])
def test_costly_methods_are_left_to_the_nightly_suite(suite, methods):
    assert Ablation(scene="scene", slow=("fem",)).in_suite(suite).methods == methods
