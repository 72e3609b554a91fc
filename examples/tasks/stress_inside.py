"""Where the layer is stressed most."""

from contact import load_scene
from mdr import Mdr

path = Mdr().solve(load_scene("sphere_on_a_gel.toml"))
most = path.inside(step=len(path) - 1).largest("von_mises")
print(f"{most.value / 1e3:.3g} kPa at r = {most.radius * 1e6:.2f} um, z = {most.depth * 1e6:.2f} um")
