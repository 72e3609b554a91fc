"""The independent reference: axisymmetric finite elements for contact with layers.

Enters: a scene. Leaves: contact paths, detachments, impacts and histories with stated errors. Read `method` first, then
`elastic.path`, `elastic.prescribed_radius` and `discrete_layer.problem`; `stated` compares answers at two resolutions.
Nothing here knows the layer kernel, the integral equation or the method of dimensionality reduction.
"""

from contact.records.extras import missing_extra

try:
    from fem_reference.method import Fem
except ModuleNotFoundError as error:
    # The same error, with what to do about it; what is no extra of this distribution is told as it is.
    raise ModuleNotFoundError(missing_extra(error) or str(error), name=error.name) from None

__all__ = ["Fem"]
