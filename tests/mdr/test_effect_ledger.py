"""Only the effects that a scene lists are imported, called and paid for."""

import subprocess
import sys
import time

import pytest

from contact import Adhesion, ContactRadii, Detachment, Layer, Paraboloid, Scene
from mdr import Mdr
from tests.mdr.viscoelastic_scenes import figure_12

PROBE = """
import sys
from contact import ContactRadii, Layer, Paraboloid, Scene
from mdr import Mdr
layer = Layer(thickness=1e-3, youngs_modulus=1e6, poissons_ratio=0.45)
scene = Scene(layer=layer, indenter=Paraboloid(radius_of_curvature=0.01), loading=ContactRadii([1e-3]))
path = Mdr().solve(scene)
effects = "mdr.adhesive", "mdr.detachment", "mdr.history", "mdr.impact"
loaded = [name for name in sys.modules if name.startswith(effects)]
foreign = [name for name in ("skfem", "gmsh", "matplotlib", "pyfftw.pyfftw") if name in sys.modules]
sys.exit(f"loaded {loaded} {foreign}" if loaded or foreign else 0)
"""


def stages(path):
    return {stage.name for stage in path.stages}


def elastic(effects=(), loading=None):
    return Scene(
        layer=Layer(thickness=1e-3, youngs_modulus=1e6, poissons_ratio=0.45),
        indenter=Paraboloid(radius_of_curvature=0.01),
        loading=loading or ContactRadii([1e-3]),
        effects=effects,
    )


def test_an_elastic_scene_imports_no_effect():
    done = subprocess.run([sys.executable, "-c", PROBE], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


def test_stage_records_name_what_ran():
    bare = stages(Mdr().solve(elastic()))
    adhesion = (Adhesion(work_of_adhesion=0.05),)
    assert not bare & {"adhesion", "impact", "history"}
    assert "adhesion" in stages(Mdr().solve(elastic(adhesion)))
    assert "adhesion" in stages(Mdr().solve(elastic(adhesion, Detachment())))
    impact = stages(Mdr().solve(figure_12(1e-3)))
    assert "impact" in impact
    assert "adhesion" not in impact


def seconds_of(call):
    """Processor time; beside other work the least of several calls says what it costs."""
    start = time.process_time()
    call()
    return time.process_time() - start


@pytest.mark.slow
def test_time_grows_at_most_linearly_with_the_number_of_relaxation_times():
    import numpy as np

    from bem.flat_punch import IntegralEquation
    from contact import PronySeries
    from mdr.impact.solver import impact_batch
    from tests.mdr.viscoelastic_scenes import GLASSY_BRANCH, LONG_TERM

    source, seconds = IntegralEquation(), []
    for count in (1, 16, 64):
        model = PronySeries(
            long_term_shear_modulus=LONG_TERM,
            shear_moduli=np.full(count, GLASSY_BRANCH / count),
            relaxation_times=np.geomspace(2e-4, 5e-3, count) if count > 1 else np.array([1e-3]),
        )
        scenes = [figure_12(1e-3).replace(effects=(model,))] * 100
        seconds.append(min(seconds_of(lambda scenes=scenes: impact_batch(scenes, source)) for _ in range(3)))
    assert seconds[2] - seconds[0] < 1.5 * 63.0 / 15.0 * max(seconds[1] - seconds[0], 0.05 * seconds[0])
