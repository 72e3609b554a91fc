"""Tables of reports, before anyone prints them.

Enters: records of a run or an answer. Leaves: rows of text for pages, terminal and CSV. Read `table` first.
"""
