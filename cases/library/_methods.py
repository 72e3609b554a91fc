"""The methods that cases compare, with their settings; a method that does not model a scene answers with its reason."""

from cases.declare.methods import MethodUse

MDR = MethodUse(label="mdr")
FEM = MethodUse(label="fem", settings={"order": 4, "growth": 0.33, "edge_cell": 1e-7, "truncation": 1e-10})
QUICK_FEM = MethodUse(label="fem", settings={"accuracy": 1e-4})
DETACHING_FEM = MethodUse(label="fem", settings={"accuracy": 3e-5})
PEELING_FEM = MethodUse(label="fem", settings={"accuracy": 5e-5})
BEM = MethodUse(label="bem", settings={"points": 256})
DETACHING_BEM = MethodUse(label="bem", settings={"points": 128})
EQUATION = MethodUse(label="integral_equation")
TABLE = MethodUse(label="mdr_table", settings={"cells": 128, "ratios": 60, "radii": 200})
EVERY = (MDR, FEM, BEM, EQUATION, TABLE)
