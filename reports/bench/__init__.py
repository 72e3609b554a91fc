"""What the bench sees: fits of force curves and sweeps, as tables, pictures and CSV files.

Enters: files of curves and scenes. Leaves: lines in the terminal, and the files asked for. Read `fits` first.
"""
