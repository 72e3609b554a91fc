"""Layer stacks and graded layers as finite elements: mesh lines at interfaces, and moduli at quadrature points.

Enters: a `LayerStack` or `GradedLayer`, a contact and mesh settings. Leaves: a mesh and a problem that the solvers of
plain layers take. Read `parts` first, then `drawing` and `problem`.
"""
