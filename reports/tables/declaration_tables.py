"""Tables of what a case declares: its scenes, its methods, its claims with their reasons."""

from cases.declare.case import Case, CaseScene, ClaimOfCase
from reports.words import Table, display_name, small


def scene_table(case: Case) -> Table:
    """The scenes with the parameters that set them apart, and who solves them."""
    names = tuple(dict.fromkeys(name for scene in case.scenes for name in scene.parameters))
    rows = tuple(
        (scene.name, *(f"{scene.parameters.get(name, '')}" for name in names), _solvers(case, scene))
        for scene in case.scenes
    )
    note = "In brackets: in the nightly suite only."
    return Table(title="Scenes", note=note, heads=("scene", *names, "methods"), rows=rows, words=2 + len(names))


def _solvers(case: Case, scene: CaseScene) -> str:
    names = ((use.label, display_name(use.label)) for use in case.methods_of(scene))
    return ", ".join(f"({name})" if label in scene.nightly else name for label, name in names)


def method_table(case: Case) -> Table:
    """The methods with the settings that differ from their defaults."""
    rows = tuple(
        (display_name(use.label), ", ".join(f"{name} = {value}" for name, value in use.settings.items()) or "defaults")
        for use in case.methods
    )
    return Table(title="Methods", note="", heads=("method", "settings"), rows=rows, words=2)


def claim_table(case: Case) -> Table:
    """The claims with tolerance, reason and origin."""
    heads = ("kind", "claim", "quantity", "tolerance", "expected because", "tolerance from", "origin")
    return Table(title="Claims", note="", heads=heads, rows=tuple(_claim_row(c) for c in case.claims), words=7)


def _claim_row(claim: ClaimOfCase) -> tuple[str, ...]:
    reason = claim.reason
    origin = f"{reason.origin}: {reason.source}"
    names = (str(claim.kind), claim.name, claim.quantity, small(claim.tolerance))
    return *names, reason.because, reason.derived_from, origin
