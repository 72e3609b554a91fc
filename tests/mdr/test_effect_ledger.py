"""Only the effects that a scene lists are imported, called and paid for."""

import subprocess
import sys

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
