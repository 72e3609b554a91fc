"""Linear systems of a discrete layer: condensed triangles, order of elimination, checked factorisation."""
