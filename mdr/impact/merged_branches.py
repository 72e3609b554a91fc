"""Few relaxation times in place of a table of many: those far from the time of contact are merged by their moments.

A branch that relaxes fast answers a strain rate e' with G tau e' - G tau^2 e'' + ..., a slow one a strain e with
G e - (G/tau) int e dt + .... Two branches with the first four moments of many, sum G tau^(1+k) or sum G/tau^k, answer
alike up to the fifth power of tau/T or the fourth of T/tau: they are the two-node Gauss rule of the table.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable

import numpy as np

from bem.kernels.moduli import relaxation_of
from contact import ImpactHistory, Layer, PronySeries, Scene, Viscoelasticity
from contact.records.validation import FloatArray

# Tables of more branches are merged: the equations of motion have two unknowns per branch, and fast branches make them
# stiff. With half as many, tables of ten branches take three times as long merged as not; with twice as many, tables of
# thirty take four times as long as merged.
_MANY = 16
# Branches so many times faster or slower than the contact are merged in the answer, and in the one beside it that tells
# the error. Half as large: errors 30 times as large, two thirds of the time.
_FINE, _COARSE = 100.0, 30.0
# The same of the first answer, which finds the time of contact from the elastic one. Half as large: 20 % off.
_FIRST = 10.0
# In the first so many relaxation times of merged branches the force is right on average only: exp(-20) is 2e-9.
_EARLY = 20.0
# Numbers of an impact; the change of the largest of them is added to all samples.
_NUMBERS = ("coefficient_of_restitution", "contact_time", *ImpactHistory.SCALARS)


def with_merged_branches(scene: Scene, solve: Callable[[Scene], ImpactHistory]) -> ImpactHistory:
    """The impact of a scene, many relaxation times merged; stated errors include the change by a coarser merger.

    Args:
        scene: Whose loading is an impact.
        solve: Solver of a scene as it is.
    """
    law = relaxation_of(scene)
    if law.moduli.size <= _MANY or not isinstance(scene.layer, Layer):
        return solve(scene)
    elastic = solve(scene.replace(effects=()))
    first = solve(_merged(scene, elastic.contact_time / _FIRST, elastic.contact_time * _FIRST**2))
    duration = first.contact_time
    fastest, slowest = duration / _FINE, duration * _FINE
    fine = solve(_merged(scene, fastest, slowest))
    # The coarser answer merges one branch more on either side at least: where none is near, both would be the same.
    kept = law.times[(law.times >= fastest) & (law.times <= slowest)]
    near, far = kept.min(initial=slowest), kept.max(initial=fastest)
    coarse = solve(_merged(scene, max(1.001 * near, duration / _COARSE), min(far / 1.001, duration * _COARSE)))
    change = {name: abs(getattr(coarse, name) / getattr(fine, name) - 1.0) for name in _NUMBERS}
    errors = {name: error + change.get(name, max(change.values())) for name, error in fine.error_estimate.items()}
    # No force is larger than that of the instantaneous modulus of the whole table.
    stiffer = scene.layer.youngs_modulus / fine.scene.layer.youngs_modulus
    force = stiffer * np.abs(fine.normal_force) / fine.peak_force
    errors["normal_force"] = errors["normal_force"] + np.where(fine.time < _EARLY * fastest, force, 0.0)
    note = f"relaxation times below {fastest:.2g} s and above {slowest:.2g} s are merged; stated errors include it"
    costs = [answer.cost for answer in (elastic, first, coarse, fine)]
    wall, cpu = (math.fsum(getattr(cost, name) for cost in costs) for name in ("wall_seconds", "cpu_seconds"))
    cost = dataclasses.replace(fine.cost, wall_seconds=wall, cpu_seconds=cpu)
    return dataclasses.replace(fine, scene=scene, cost=cost, error_estimate=errors, notes=(*fine.notes, note))


def _merged(scene: Scene, fastest: float, slowest: float) -> Scene:
    """The scene with at most two branches below the fastest relaxation time [s], and two above the slowest."""
    law = relaxation_of(scene)
    times, moduli = law.times, law.moduli
    used = moduli > 0.0
    fast, slow = used & (times < fastest), used & (times > slowest)
    kept = used & ~fast & ~slow
    fast_times, lags = _two_nodes(times[fast], moduli[fast] * times[fast])
    rates, slow_moduli = _two_nodes(1.0 / times[slow], moduli[slow])
    model = PronySeries(
        long_term_shear_modulus=law.long_term_modulus,
        shear_moduli=np.concatenate([lags / fast_times, moduli[kept], slow_moduli]),
        relaxation_times=np.concatenate([fast_times, times[kept], 1.0 / rates]),
    )
    modulus = 2.0 * (1.0 + scene.layer.poissons_ratio) * model.relaxation.instantaneous_modulus
    layer = scene.layer.replace(youngs_modulus=modulus)
    others = tuple(effect for effect in scene.effects if not isinstance(effect, Viscoelasticity))
    return scene.replace(layer=layer, effects=(*others, model))


def _two_nodes(nodes: FloatArray, weights: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Nodes and weights of the Gauss rule with the first four moments of a discrete measure, by two Lanczos steps."""
    if nodes.size <= 2:
        return nodes, weights
    first = np.sqrt(weights / weights.sum())
    mean = float(first @ (nodes * first))
    second = (nodes - mean) * first
    spread = float(np.linalg.norm(second))
    second /= spread
    found, vectors = np.linalg.eigh([[mean, spread], [spread, float(second @ (nodes * second))]])
    return found, weights.sum() * vectors[0] ** 2
