"""What must catch a fault: claims of the library on a few scenes, or one test; each answers with a status."""

import dataclasses
import importlib
from collections.abc import Mapping
from dataclasses import dataclass, field

import pytest

from cases.answers import Table
from cases.claims import Agree
from cases.convergence import Order
from cases.declare.registry import load_cases
from cases.run.solve_task import job_of, solve
from cases.verdicts import Status, worst
from contact import NotConvergedError, UnsupportedSceneError

TEMPORARY = object()  # stands for a fresh folder among a test's arguments


@dataclass(frozen=True)
class Claims:
    """Claims of a library case as they stand, with their own tolerances, on some of its scenes and methods."""

    case: str
    claims: tuple[str, ...]
    scenes: tuple[str, ...]
    methods: tuple[str, ...]

    def load(self):
        return self._slice()

    def status(self, folder):
        case = self._slice()
        rows = {}
        for task in case.tasks():
            rows.setdefault(task.identity, solve(job_of(task)))
        return worst(verdict.status for verdict in case.verdicts(Table(rows.values())))

    def _slice(self):
        case = load_cases()[self.case]
        chosen = [claim for claim in case.claims if claim.name in self.claims]
        assert len(chosen) == len(self.claims), f"{self.case} has no {set(self.claims) - {c.name for c in chosen}}"
        return dataclasses.replace(
            case,
            scenes=tuple(dataclasses.replace(case.scene(name), nightly=()) for name in self.scenes),
            methods=tuple(use for use in case.methods if use.label in self.methods),
            claims=tuple(self._narrowed(claim) for claim in chosen),
        )

    def _narrowed(self, claim):
        own = {} if isinstance(claim, Agree | Order) else {"methods": self.methods}
        if isinstance(expected := getattr(claim, "to", None), Mapping):
            own["to"] = {name: values for name, values in expected.items() if name in self.scenes}
        return dataclasses.replace(claim, scenes=self.scenes, **own)


@dataclass(frozen=True)
class Test:
    """A test of the suite with the arguments it runs with: FAIL when it fails, INVALID when a solver gives up."""

    __test__ = False

    place: str
    arguments: tuple = field(default=())

    def load(self):
        module, _, name = self.place.partition(":")
        return getattr(importlib.import_module(f"tests.{module}"), name)

    def status(self, folder):
        arguments = [folder if argument is TEMPORARY else argument for argument in self._arguments()]
        try:
            self.load()(*arguments)
        except (AssertionError, pytest.fail.Exception):
            return Status.FAIL
        except (NotConvergedError, UnsupportedSceneError):
            return Status.INVALID
        return Status.PASS

    def _arguments(self):
        return [argument() if callable(argument) else argument for argument in self.arguments]
