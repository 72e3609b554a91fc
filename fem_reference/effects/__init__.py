"""One file for each effect beyond elastic frictionless contact; imported only when a scene lists it."""
