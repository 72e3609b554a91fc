"""The flat punch on stacks and graded layers: panels that shrink towards the axis, and towards both ends.

Enters: the kernel of a layer. Leaves: a flat-punch solution as for one layer. Read `graded_panels_factor` for stacks;
for graded layers `point_kernel`, `relative_panels`, `edge_systems` and `graded_solution`.
"""
