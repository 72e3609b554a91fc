"""Solvers that nobody here wrote, beside ours: the suite "referees"."""
