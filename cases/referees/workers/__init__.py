"""Scripts that run inside the interpreter of an outside solver: JSON in, JSON out, nothing of this project imported."""
