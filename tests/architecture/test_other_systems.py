"""Everything imports and solves on systems without the modules and signals that only POSIX has."""

import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
# Python's own modules on POSIX have loaded some of these before: only later imports are blocked.
WITHOUT_POSIX = """
import importlib.abc, multiprocessing, signal, subprocess, sys, threading, warnings

class Blocked(importlib.abc.MetaPathFinder):
    def find_spec(self, name, path=None, target=None):
        if name in {"resource", "fcntl", "termios", "pwd", "grp", "syslog"}:
            raise ModuleNotFoundError(f"No module named {name!r}", name=name)

for name in ("resource", "fcntl", "termios", "pwd", "grp", "syslog"):
    sys.modules.pop(name, None)
sys.meta_path.insert(0, Blocked())
for name in ("SIGALRM", "SIGPIPE", "SIGKILL", "SIGHUP", "ITIMER_REAL", "setitimer", "alarm", "pause"):
    delattr(signal, name)
subprocess.Popen.kill = subprocess.Popen.terminate  # as on Windows
"""
IMPORT_ALL = """
import importlib, pkgutil
for package in ("contact", "bem", "mdr", "fem_reference", "cases", "reports"):
    for module in pkgutil.walk_packages(importlib.import_module(package).__path__, f"{package}."):
        if not module.name.endswith("__main__") and ".workers." not in module.name:
            importlib.import_module(module.name)
"""
SOLVE = """
from pathlib import Path
from bem import Bem
from cases.run.lock import locked
from cases.run.apart import TimeLimitReached, apart
from contact import ContactRadii, Layer, Paraboloid, Scene
from fem_reference import Fem
from mdr import Mdr

layer = Layer(thickness=1e-3, youngs_modulus=1e6, poissons_ratio=0.4)
scene = Scene(layer=layer, indenter=Paraboloid(radius_of_curvature=0.01), loading=ContactRadii([1e-4]))
with locked(Path(sys.argv[1])):
    forces = [method.solve(scene).normal_force[0] for method in (Mdr(), Bem(points=96), Fem(accuracy=1e-3))]
assert max(forces) < 1.01 * min(forces)
import time
assert apart(max, 1, 2, seconds=60) == 2
try:
    apart(time.sleep, 60, seconds=0.05)
except TimeLimitReached:
    print("solved")
"""


def without_posix(code, *arguments):
    command = [sys.executable, "-W", "ignore", "-c", WITHOUT_POSIX + code, *map(str, arguments)]
    return subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False, timeout=120)


def test_all_modules_import_without_posix():
    done = without_posix(IMPORT_ALL)
    assert done.returncode == 0, done.stderr[-1500:]


@pytest.mark.slow
def test_three_methods_solve_under_a_lock_and_a_time_limit_without_posix(tmp_path):
    done = without_posix(SOLVE, tmp_path)
    assert done.stdout == "solved\n", done.stderr[-1500:]
