"""The force at one depth over the thickness of the gel."""

from cases.sweep import sweep
from contact import IndentationDepths, load_scene
from mdr import Mdr

scene = load_scene("sphere_on_a_gel.toml").replace(loading=IndentationDepths([0.4e-6]))
table = sweep(scene, "thickness=2um..50um:3:log", Mdr()).columns
for thickness, force in zip(table["thickness [m]"], table["normal_force [N]"], strict=True):
    print(f"{thickness * 1e6:.3g} um: {force * 1e9:.3g} nN")
