"""Writes paper/paper.md from paper/paper.in.md with numbers of the baselines: python paper/build.py."""

import json
from pathlib import Path
from statistics import median
from typing import Any

HERE = Path(__file__).parent
OTHERS = {
    "integral_equation": "direct integral equation",
    "fem": "own finite elements",
    "bem": "own boundary elements",
    "calculix": "CalculiX",
    "contact_mechanics": "ContactMechanics",
    "tamaas": "Tamaas",
}
COMPARED = ("normal_force", "contact_stiffness")


def baselines() -> list[list[dict[str, Any]]]:
    """Per case its head followed by its answers."""
    files = sorted((HERE.parent / "baselines").glob("*.jsonl"))
    return [[json.loads(line) for line in file.read_text(encoding="utf-8").splitlines()] for file in files]


def differences(method: str, cases: list[list[dict[str, Any]]]) -> list[float]:
    """Largest difference of force or stiffness from MDR per common scene, over the scale of the quantity."""
    found = []
    for _, *answers in cases:
        reference = {answer["scene"]: answer["quantities"] for answer in answers if answer["method"] == "mdr"}
        for answer in answers:
            if answer["method"] == method and answer["scene"] in reference:
                pairs = ((answer["quantities"].get(q), reference[answer["scene"]].get(q)) for q in COMPARED)
                change = [
                    max(abs(x - y) for x, y in zip(one["values"], other["values"], strict=True)) / one["scale"]
                    for one, other in pairs
                    if one and other and len(one["values"]) == len(other["values"]) > 0
                ]
                found += [max(change)] if change else []
    return found


def numbers() -> dict[str, str]:
    """The numbers of the paper, by their names in paper.in.md."""
    cases = baselines()
    judged = {
        kind: sum(c["judged"] for head, *_ in cases for c in head["claims"] if c["kind"] == kind)
        for kind in ("exact", "agreement", "invariant", "order")
    }
    rows = []
    for method, name in OTHERS.items():
        change = differences(method, cases)
        rows.append(f"| {name} | {len(change)} | {max(median(change), 1e-16):.0e} | {max(change):.0e} |")
    counts = {
        "cases": len(cases),
        "answers": sum(len(answers) for _, *answers in cases),
        "judged": sum(judged.values()),
    }
    return {name: str(value) for name, value in (counts | judged).items()} | {"table": "\n".join(rows)}


def paper() -> str:
    """The text of the paper."""
    return (HERE / "paper.in.md").read_text(encoding="utf-8").format_map(numbers())


if __name__ == "__main__":
    (HERE / "paper.md").write_text(paper(), encoding="utf-8")
