"""Displacement and stress inside the body, from the density of the contact's pressure.

A density and a kernel enter; fields at points leave. Read ``fields`` first, then ``half_space_part`` (closed forms) and
``layer_part`` (what the layer adds, an integral over wavenumbers).
"""
