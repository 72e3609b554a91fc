"""Limits: thick layers, thin layers, and Poisson's ratio up to exactly one half."""
