"""The cases, one file per case; `cases.declare.registry` finds them in this folder."""
