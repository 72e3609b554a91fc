"""Quantities by the symbols that readers know."""

SYMBOLS = {
    "time": "t",
    "contact_radius": "a",
    "indentation_depth": "δ",
    "velocity": "v",
    "normal_force": "F",
    "contact_stiffness": "k_N",
    "kinetic_energy": "E_kin",
    "stored_energy": "E_el",
    "dissipated_energy": "E_diss",
    "stick_radius": "c",
}
