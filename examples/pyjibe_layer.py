"""A model for PyJibe (Preferences, Extensions) and nanite's `load_model_from_file`: paraboloid on a bonded layer."""

from mdr.curves.nanite_models import layer_model

globals().update(vars(layer_model("paraboloid", "bonded")))
