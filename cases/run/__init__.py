"""Solving tasks anywhere, once, without loss: `runner` plans and judges, `solve_task` solves, `keys` names answers."""
