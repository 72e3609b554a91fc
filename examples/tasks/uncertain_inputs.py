"""What a thickness known to 3 % makes of the force."""

from cases.run.propagation import propagate
from contact import IndentationDepths, load_scene

scene = load_scene("sphere_on_a_gel.toml").replace(loading=IndentationDepths([0.4e-6]))
force = propagate(scene, "thickness=3%, radius=1%").quantity("normal_force")
print(f"F = {force.values[-1] * 1e9:.3g} nN +- {100 * force.inputs[-1] / force.values[-1]:.1f} %")
