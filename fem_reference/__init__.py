"""The independent reference: axisymmetric finite elements for contact with layers.

A scene enters; paths, detachments, impacts and histories with stated errors leave. Read `weak_forms`, `materials`,
`mesh` and `layer` (one discrete layer), `prescribed_contact` (stiffness, its derivative, depth and force of one contact
radius), `equilibria` and `adhesion` (loads), `surface`, `contact_set`, `memory` and `motions` (time), `friction`, and
`stated` (errors from a coarser companion). `profiles` and `materials` define the scene's functions independently.
Nothing here uses the layer kernel, the integral equation or the method of dimensionality reduction.
"""

from contact.records.extras import missing_extra

try:
    from fem_reference.method import Fem
except ModuleNotFoundError as error:
    # The same error, with its remedy where the missing module belongs to an extra of this distribution.
    raise ModuleNotFoundError(missing_extra(error) or str(error), name=error.name) from None

__all__ = ["Fem"]
