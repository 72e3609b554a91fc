"""What a case says: scenes, methods, claims, studies; and the table of methods.

Enters: modules of `cases.library` and entry points of installed packages. Leaves: `Case` records that no solver has
seen. Read `case` first.
"""
