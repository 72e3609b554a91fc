"""The adhered flat punch without a mesh: it presses, and the surface below it may not slide.

A layer's thickness, support and Poisson's ratio enter; stiffness, edge stiffness and fields leave. Read
``adhered_punch`` first, then ``coulomb`` and ``adhered_fields``.
"""
