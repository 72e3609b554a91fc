"""What the uncertainty of inputs makes of an answer.

- ``inputs``: what is uncertain, from text such as "thickness=3%, poissons_ratio=0.48..0.5"
- ``propagation``: by differences or by samples, to every quantity, with correlations

``from cases.uncertain import propagate; propagate(scene, "thickness=3%").quantity("normal_force")``
"""

from cases.uncertain.inputs import UncertainInputs, read_inputs
from cases.uncertain.propagation import Propagated, PropagatedQuantity, propagate

__all__ = ["Propagated", "PropagatedQuantity", "UncertainInputs", "propagate", "read_inputs"]
