"""The flat punch on stacks and graded layers: panels that shrink towards the axis.

Enters: the kernel of a layer. Leaves: a flat-punch solution as for one layer. Read `graded_panels_factor`.
"""
