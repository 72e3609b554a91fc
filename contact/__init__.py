"""What a scene is and what an answer is: the vocabulary that all methods share.

Conventions: SI units; pressing is positive; z points into the layer; r is the distance from the axis.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from contact.answer.friction import FrictionHistory, FrictionPath
from contact.answer.method import Method, Supported, Unsupported, other_layer, refuse_other_layers
from contact.answer.shown import UNITS
from contact.answer.solution import (
    ContactPath,
    CriticalPoint,
    DetachmentPath,
    Fields,
    ForcePath,
    HistoryPath,
    ImpactHistory,
    Solution,
)
from contact.answer.stages import Cost, StageLog, StageRecord
from contact.records.errors import ContactError, InvalidInput, NotConvergedError, UnsupportedSceneError
from contact.records.validation import Numbers
from contact.scene.coated_pair import CoatedPair
from contact.scene.effects import (
    Adhesion,
    Effect,
    Friction,
    KelvinVoigt,
    PronySeries,
    Relaxation,
    StandardSolid,
    Viscoelasticity,
)
from contact.scene.graded_layer import (
    DepthFunction,
    ExponentialDepth,
    GradedLayer,
    LinearDepth,
    PowerLawDepth,
    TabulatedDepth,
)
from contact.scene.layer import ElasticBase, ElasticLayer, Layer, LayerStack, Sublayer
from contact.scene.loading import (
    ContactRadii,
    DepthHistory,
    Detachment,
    EquilibriumLoading,
    ForceHistory,
    HistoryLoading,
    Impact,
    IndentationDepths,
    Loading,
    NormalForces,
)
from contact.scene.profiles import (
    Cone,
    FlatPunch,
    Paraboloid,
    PowerLaw,
    Profile,
    Sphere,
    Spheroconical,
    Tabulated,
    TruncatedCone,
    TruncatedParaboloid,
)
from contact.scene.scene import AnyScene, Scene

if TYPE_CHECKING:
    from contact.files.scene_file import load_scene, scene_from_mapping, scene_to_mapping

__all__ = [
    "UNITS",
    "Adhesion",
    "AnyScene",
    "CoatedPair",
    "Cone",
    "ContactError",
    "ContactPath",
    "ContactRadii",
    "Cost",
    "CriticalPoint",
    "DepthFunction",
    "DepthHistory",
    "Detachment",
    "DetachmentPath",
    "Effect",
    "ElasticBase",
    "ElasticLayer",
    "EquilibriumLoading",
    "ExponentialDepth",
    "Fields",
    "FlatPunch",
    "ForceHistory",
    "ForcePath",
    "Friction",
    "FrictionHistory",
    "FrictionPath",
    "GradedLayer",
    "HistoryLoading",
    "HistoryPath",
    "Impact",
    "ImpactHistory",
    "IndentationDepths",
    "InvalidInput",
    "KelvinVoigt",
    "Layer",
    "LayerStack",
    "LinearDepth",
    "Loading",
    "Method",
    "NormalForces",
    "NotConvergedError",
    "Numbers",
    "Paraboloid",
    "PowerLaw",
    "PowerLawDepth",
    "Profile",
    "PronySeries",
    "Relaxation",
    "Scene",
    "Solution",
    "Sphere",
    "Spheroconical",
    "StageLog",
    "StageRecord",
    "StandardSolid",
    "Sublayer",
    "Supported",
    "Tabulated",
    "TabulatedDepth",
    "TruncatedCone",
    "TruncatedParaboloid",
    "Unsupported",
    "UnsupportedSceneError",
    "Viscoelasticity",
    "load_scene",
    "other_layer",
    "refuse_other_layers",
    "scene_from_mapping",
    "scene_to_mapping",
]

# Readers of files are loaded when the first of them is asked for: an answer to a scene written in Python needs none.
_FROM_FILES = ("load_scene", "scene_from_mapping", "scene_to_mapping")


def __getattr__(name: str) -> Any:
    """Load a reader when it is first asked for."""
    if name not in _FROM_FILES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = getattr(import_module("contact.files.scene_file"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
