"""List of the reference numbers; ``python -m benchmarks.references.table`` computes them."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cache, partial
from pathlib import Path

from mpmath import mp, mpf

from benchmarks.references import layer_equation, partial_slip, sphere_impact

PLACE = Path(__file__).parents[2] / "cases" / "library" / "reference_numbers.toml"
LAYERS: dict[str, str | None] = {f"bonded nu={nu}": nu for nu in ("0.3", "0.4", "0.45", "0.5")} | {"unbonded": None}
# Number of Gauss nodes for at least twelve digits, by a/h.
NODES = {"0.1": 16, "0.2": 16, "0.5": 18, "1": 20, "2": 24, "5": 34, "10": 50}
PRESSURE_AT = ("0", "0.2", "0.4", "0.6", "0.8", "0.9", "0.95")
PARABOLOIDS = {
    "bonded nu=0.5": ("0.2", "1", "2", "5", "10"),
    "bonded nu=0.3": ("1",),
    "unbonded": ("1", "2", "5"),
}
CONES = {
    "bonded nu=0.5": ("0.1", "1", "2", "5"),
    "bonded nu=0.45": ("1", "2", "5"),
    "bonded nu=0.3": ("1",),
    "unbonded": ("1", "2", "5"),
}
ELONGATIONS = {"0.5": "0.46", "0.45": "0.6", "0.4": "0.914"}
# Thickness [mm] of the layers under impact; zero is the half-space.
THICKNESSES = ("0", "1", "2", "3")
# Time steps until the largest depth: with 200 restitutions err by 1.3e-8; with 400 and 800 they agree to 4e-10.
STEPS = 400
# Poisson's ratio and c/a of paraboloids with partial slip; the numbers are mu, delta R/a^2, F/F_Hertz, heat/(F delta).
PARTIAL_SLIPS = (("0", "0.3"), ("0", "0.9"), ("0.3", "0.3"), ("0.3", "0.7"), ("0.45", "0.5"), ("0.49", "0.6"))
# Written digits, and the digits written beyond `Entry.digits` if those are ten or fewer.
KEPT, GUARD = 14, 2

HEAD = """# Reference numbers, computed by `python -m benchmarks.references.table` in extended precision; do not edit.
# Those of partial slip come from double precision, which repeats twelve digits on other points.
# What each list holds stands in `benchmarks/references/table.py`.
"""


@dataclass(frozen=True)
class Entry:
    """One list of numbers.

    Attributes:
        kind: section of ``reference_numbers.toml``.
        name: name within the section.
        compute: function that returns the numbers, from the nodes (or steps) to add to the usual ones.
        digits: number of digits that agree with a computation on other nodes.
    """

    kind: str
    name: str
    compute: Callable[[int], list[mpf]]
    digits: int = 12


def entries() -> Iterator[Entry]:
    """All entries, sorted by kind."""
    for label, nu in LAYERS.items():
        for ratio in ("0.2", "1", "2"):
            yield _entry("stiffness", label, ratio, _single(layer_equation.stiffness, ratio, nu))
    yield _entry("spring", "bonded nu=0.5", "1", _single(layer_equation.spring, "1", "0.5"))
    for ratio in ("0.5", "1", "2", "5"):
        yield _entry("pressure", "bonded nu=0.5", ratio, partial(_pressure, ratio))
    for function, places in ((layer_equation.paraboloid, PARABOLOIDS), (layer_equation.truncated_cone, CONES)):
        for label, ratios in places.items():
            for ratio in ratios:
                yield _entry(function.__name__, label, ratio, _pair(function, ratio, LAYERS[label]))
    for label, nu in LAYERS.items():
        yield Entry("first_order", label, partial(_first_order, nu))
    for nu, near in ELONGATIONS.items():
        yield Entry("largest_elongation", f"bonded nu={nu}", partial(_elongation, nu, near), digits=10)
    for thickness in THICKNESSES:
        name = f"h={thickness} mm" if thickness != "0" else "half-space"
        yield Entry("sphere_impact", name, partial(_impact, thickness), digits=8)
    for nu, share in PARTIAL_SLIPS:
        yield Entry("partial_slip", f"nu={nu} c/a={share}", partial(_partial_slip, nu, share), digits=11)


def _entry(kind: str, label: str, ratio: str, compute: Callable[[int], list[mpf]]) -> Entry:
    """Entry of a layer at a ratio a/h, with the nodes of `NODES`."""

    def with_nodes(more: int) -> list[mpf]:
        """Numbers with ``more`` nodes than usual."""
        return compute(NODES[ratio] + more)

    # The equation of a thin incompressible layer magnifies roundings: one digit less at a/h = 10.
    return Entry(kind, f"{label} a/h={ratio}", with_nodes, 11 if ratio == "10" else 12)


def _single(function: Callable[..., mpf], ratio: str, nu: str | None) -> Callable[[int], list[mpf]]:
    return lambda nodes: [function(ratio, nu, nodes)]


def _pair(function: Callable[..., tuple[mpf, mpf]], ratio: str, nu: str | None) -> Callable[[int], list[mpf]]:
    return lambda nodes: list(function(ratio, nu, nodes))


def _pressure(ratio: str, nodes: int) -> list[mpf]:
    return layer_equation.pressure(ratio, "0.5", nodes, PRESSURE_AT)


def _first_order(nu: str | None, _: int) -> list[mpf]:
    return [layer_equation.first_order(nu)]


def _elongation(nu: str, near: str, more: int) -> list[mpf]:
    return list(layer_equation.largest_elongation(nu, near, 18 + more))


def _impact(thickness: str, more: int) -> list[mpf]:
    """Restitution and largest force [N]."""
    steps = STEPS + 10 * more
    with mp.workdps(20):
        springs = sphere_impact.SphereSprings()
        if thickness != "0":
            springs = sphere_impact.springs_of(mpf(thickness) / 1000, _springs())
        answer = sphere_impact.impact(springs, steps)
    return [answer.restitution, answer.peak_force]


def _partial_slip(nu: str, share: str, more: int) -> list[mpf]:
    """mu, depth, force and heat in double precision, with a step that is larger by ``more`` hundredths."""
    answer = partial_slip.partial_slip(float(nu), float(share), partial_slip.STEP + more / 100)
    return [mpf(value) for value in (answer.coefficient, answer.depth, answer.force, answer.heat)]


@cache
def _springs() -> tuple[list[mpf], list[mpf]]:
    with mp.workdps(layer_equation.DIGITS):
        return sphere_impact.tabulated_springs()


def computed(entry: Entry, more: int = 0) -> list[mpf]:
    """Numbers of an entry with ``more`` nodes than usual."""
    with mp.workdps(layer_equation.DIGITS):
        return entry.compute(more)


def main() -> None:
    """Compute every number and write ``reference_numbers.toml``."""
    lines, kind = [HEAD], ""
    for entry in entries():
        if entry.kind != kind:
            kind = entry.kind
            lines.append(f"\n[{kind}]\n")
        digits = KEPT if entry.digits > 10 else entry.digits + GUARD
        values = ", ".join(mp.nstr(value, digits, strip_zeros=False) for value in computed(entry))
        lines.append(f'"{entry.name}" = [{values}]\n')
    PLACE.write_text("".join(lines), encoding="utf-8")


if __name__ == "__main__":
    main()
