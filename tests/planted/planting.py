"""How a fault is switched on: one function or constant of the sources is replaced wherever it is known by name."""

import importlib
import sys

OWN = ("contact", "bem", "mdr", "fem_reference", "cases", "reports", "benchmarks", "tests")


def found(place):
    """The object that "module:name" names."""
    module, _, name = place.partition(":")
    return getattr(importlib.import_module(module), name)


def swap(place, wrong):
    """A fault that replaces the function at `place` by `wrong(original)`, in every module that imported it."""

    def plant(patch):
        original = found(place)
        faulty = wrong(original)
        for module, name in _known_as(original):
            patch.setattr(module, name, faulty)

    return plant


def set_to(place, value):
    """A fault that gives the constant at `place` another value."""
    module, _, name = place.partition(":")
    return lambda patch: patch.setattr(importlib.import_module(module), name, value)


def override(place, name, wrong):
    """A fault that replaces a method or property of the class at `place` (or inherited) by `wrong(original)`."""

    def plant(patch):
        cls = found(place)
        original = next(vars(one)[name] for one in cls.__mro__ if name in vars(one))
        patch.setattr(cls, name, wrong(getattr(original, "func", getattr(original, "fget", original))))

    return plant


def forget_computed():
    """Empty every cache of the sources: an answer from before the fault would hide it, one from after would spread."""
    for module in _own_modules():
        for value in list(vars(module).values()):
            clear = getattr(value, "cache_clear", None)
            if callable(clear):
                clear()


def _known_as(original):
    names = [(module, name) for module in _own_modules() for name, value in vars(module).items() if value is original]
    assert names, f"{original} is known by no name: the fault would change nothing"
    return names


def _own_modules():
    return [module for name, module in list(sys.modules.items()) if name.split(".")[0] in OWN and module is not None]
