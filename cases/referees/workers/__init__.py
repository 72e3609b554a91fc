"""Scripts that run inside the interpreter of a referee: JSON in, JSON out, nothing of this project imported."""
