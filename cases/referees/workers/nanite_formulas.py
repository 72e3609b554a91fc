"""nanite inside its own interpreter: depths in, forces out."""

import importlib
import json
import sys

import numpy as np


def main() -> None:
    """Answer one question; nanite counts depths downwards from the point of contact."""
    question = json.load(sys.stdin)
    formula = importlib.import_module(f"nanite.model.model_{question.pop('formula')}").model_func
    force = formula(-np.array(question.pop("depths")), **question)
    sys.stdout.write("\n" + json.dumps({"normal_force": force.tolist()}) + "\n")


if __name__ == "__main__":
    main()
