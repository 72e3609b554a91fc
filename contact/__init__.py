"""What a scene is and what an answer is: the vocabulary that all methods share.

Conventions: SI units; pressing is positive; z points into the layer; r is the distance from the axis.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from contact.answer.evidence import UNITS as UNITS
from contact.answer.method import Method as Method
from contact.answer.method import Supported as Supported
from contact.answer.method import Unsupported as Unsupported
from contact.answer.method import not_round as not_round
from contact.answer.method import other_layer as other_layer
from contact.answer.paths import ContactPath as ContactPath
from contact.answer.paths import CriticalPoint as CriticalPoint
from contact.answer.paths import DetachmentPath as DetachmentPath
from contact.answer.paths import Fields as Fields
from contact.answer.paths import ForcePath as ForcePath
from contact.answer.paths import FrictionHistory as FrictionHistory
from contact.answer.paths import FrictionPath as FrictionPath
from contact.answer.paths import HistoryPath as HistoryPath
from contact.answer.paths import ImpactHistory as ImpactHistory
from contact.answer.solution import Solution as Solution
from contact.answer.stages import Cost as Cost
from contact.answer.stages import StageLog as StageLog
from contact.answer.stages import StageRecord as StageRecord
from contact.records.errors import ContactError as ContactError
from contact.records.errors import InvalidInput as InvalidInput
from contact.records.errors import NotConvergedError as NotConvergedError
from contact.records.errors import UnsupportedSceneError as UnsupportedSceneError
from contact.records.validation import Numbers as Numbers
from contact.scene.coated_pair import CoatedPair as CoatedPair
from contact.scene.effects import Adhesion as Adhesion
from contact.scene.effects import Effect as Effect
from contact.scene.effects import Friction as Friction
from contact.scene.effects import KelvinVoigt as KelvinVoigt
from contact.scene.effects import PronySeries as PronySeries
from contact.scene.effects import Relaxation as Relaxation
from contact.scene.effects import StandardSolid as StandardSolid
from contact.scene.effects import Viscoelasticity as Viscoelasticity
from contact.scene.graded_layer import DepthFunction as DepthFunction
from contact.scene.graded_layer import ExponentialDepth as ExponentialDepth
from contact.scene.graded_layer import GradedLayer as GradedLayer
from contact.scene.graded_layer import LinearDepth as LinearDepth
from contact.scene.graded_layer import PowerLawDepth as PowerLawDepth
from contact.scene.graded_layer import TabulatedDepth as TabulatedDepth
from contact.scene.layer import ElasticBase as ElasticBase
from contact.scene.layer import ElasticLayer as ElasticLayer
from contact.scene.layer import Layer as Layer
from contact.scene.layer import LayerStack as LayerStack
from contact.scene.layer import Sublayer as Sublayer
from contact.scene.loading import ContactRadii as ContactRadii
from contact.scene.loading import DepthHistory as DepthHistory
from contact.scene.loading import Detachment as Detachment
from contact.scene.loading import EquilibriumLoading as EquilibriumLoading
from contact.scene.loading import ForceHistory as ForceHistory
from contact.scene.loading import HistoryLoading as HistoryLoading
from contact.scene.loading import Impact as Impact
from contact.scene.loading import IndentationDepths as IndentationDepths
from contact.scene.loading import Loading as Loading
from contact.scene.loading import NormalForces as NormalForces
from contact.scene.profiles import Cone as Cone
from contact.scene.profiles import FlatPunch as FlatPunch
from contact.scene.profiles import Paraboloid as Paraboloid
from contact.scene.profiles import PowerLaw as PowerLaw
from contact.scene.profiles import Profile as Profile
from contact.scene.profiles import Sphere as Sphere
from contact.scene.profiles import Spheroconical as Spheroconical
from contact.scene.profiles import Tabulated as Tabulated
from contact.scene.profiles import TruncatedCone as TruncatedCone
from contact.scene.profiles import TruncatedParaboloid as TruncatedParaboloid
from contact.scene.scene import AnyScene as AnyScene
from contact.scene.scene import Scene as Scene
from contact.scene.shapes import EllipticParaboloid as EllipticParaboloid
from contact.scene.shapes import EllipticPunch as EllipticPunch
from contact.scene.shapes import Harmonic as Harmonic
from contact.scene.shapes import Harmonics as Harmonics
from contact.scene.shapes import PolygonalPunch as PolygonalPunch
from contact.scene.shapes import Pyramid as Pyramid
from contact.scene.shapes import Shape as Shape

if TYPE_CHECKING:
    from contact.files.scene_file import load_scene as load_scene
    from contact.files.scene_file import scene_from_mapping as scene_from_mapping
    from contact.files.scene_file import scene_to_mapping as scene_to_mapping

# Functions of `contact.files.scene_file`, imported at their first use: scenes written in Python need none of them.
_SCENE_FILES = ("load_scene", "scene_from_mapping", "scene_to_mapping")


def __getattr__(name: str) -> Any:
    """Import a function that reads or writes scene files."""
    if name not in _SCENE_FILES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module("contact.files.scene_file"), name)


def __dir__() -> list[str]:
    return sorted({*globals(), *_SCENE_FILES})
