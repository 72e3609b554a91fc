"""What a run found: records, statuses, files, and two runs side by side.

Enters: judged records. Leaves: `results.json`, and the same records read back. Read `records` first.
"""
