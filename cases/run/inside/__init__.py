"""What a run keeps of the body inside: fields at points, and the laws that they must obey.

Enters: a path and the points of a scene's sampling. Leaves: curves and quantities. Read `points` first.
"""
