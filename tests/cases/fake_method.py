"""Fabricated methods: the half-space answers of a paraboloid with a chosen error, for tests of the engine only."""

import os
import time
from dataclasses import dataclass, replace
from pathlib import Path
from typing import ClassVar, Self

import numpy as np

from contact import (
    ContactPath,
    ContactRadii,
    Cost,
    NotConvergedError,
    Paraboloid,
    Scene,
    StageLog,
    Supported,
    Unsupported,
)


@dataclass(frozen=True, kw_only=True)
class HertzFields:
    """Hertz pressure times a factor."""

    contact_radius: np.ndarray
    peak: np.ndarray

    def pressure(self, radius, step):
        inside = np.clip(1 - (radius / self.contact_radius[step]) ** 2, 0, None)
        return self.peak[step] * np.sqrt(inside)

    def surface_displacement(self, radius, step):
        return np.zeros_like(radius)


@dataclass(frozen=True, kw_only=True)
class FakeHertz:
    """Hertz's solution times (1 + error cell^order): as if a mesh of that cell size had found it.

    ``plant`` spoils the answer: "nan", "not converged", "die" (the process), "sleep", "raise", "no pressure",
    "last bits" (of Young's modulus move the force).
    """

    name: ClassVar[str] = "fake"

    cell: float = 0.0
    error: float = 1.0
    order: float = 1.0
    stated: float = 0.0
    plant: str = ""
    trace: str = ""
    shared_inputs: tuple[str, ...] = ()

    def supports(self, scene: Scene):
        if not isinstance(scene.indenter, Paraboloid):
            return Unsupported(f"models paraboloids only, got {type(scene.indenter).__name__}")
        return Supported()

    def solve(self, scene: Scene) -> ContactPath:
        self._spoil()
        log = StageLog()
        with log.stage("closed form"):
            path = self._path(scene)
        return replace(path, cost=log.cost(unknowns=int(1 / max(self.cell, 1e-3))), stages=log.records)

    def refined(self) -> Self:
        return replace(self, cell=self.cell / 2)

    def _path(self, scene: Scene) -> ContactPath:
        assert isinstance(scene.loading, ContactRadii)
        a, radius = scene.loading.values, scene.indenter.radius_of_curvature
        modulus = scene.layer.contact_modulus
        factor = 1 + self.error * self.cell**self.order
        force = 4 / 3 * modulus * a**3 / radius * factor
        if self.plant == "nan":
            force = force * np.nan
        if self.plant == "last bits":
            bits = int(np.float64(scene.layer.youngs_modulus).view(np.int64)) % 7
            force = force * (1 + 1e-6 * bits)
        stated = np.full(a.size, self.stated)
        quantities = ("contact_radius", "indentation_depth", "normal_force", "contact_stiffness", "pressure")
        fields = HertzFields(contact_radius=a, peak=2 * modulus * a / (np.pi * radius) * factor)
        return ContactPath(
            scene=scene,
            method=self.name,
            settings={"cell": self.cell},
            error_estimate=dict.fromkeys(quantities, stated),
            cost=Cost(wall_seconds=0, cpu_seconds=0, peak_memory_bytes=0, unknowns=0, counters={}),
            contact_radius=a,
            indentation_depth=a**2 / radius * factor,
            normal_force=force,
            contact_stiffness=2 * modulus * a,
            fields=None if self.plant == "no pressure" else fields,
        )

    def _spoil(self) -> None:
        if self.trace:
            with Path(self.trace).open("a", encoding="utf-8") as stream:
                stream.write(f"{self.cell}\n")
        match self.plant:
            case "die":
                os.kill(os.getpid(), 9)
            case "sleep":
                time.sleep(30)
            case "compute":
                end = time.monotonic() + 30
                while time.monotonic() < end:
                    pass
            case "raise":
                raise ZeroDivisionError("a slip in a solver")
            case "not converged":
                raise NotConvergedError("residual too large", {"residual": 0.1})
