"""The layer as finite elements: mesh, elements, weak forms, assembly, linear solver.

Enters: a layer, a contact strip and mesh settings. Leaves: the factorised stiffness of the layer and fields on its
mesh. Read `problem` first, then `settings`, `mesh` and `assembly`; `weak_forms` defines what the assembly must equal.
"""
