"""What a run produces: frozen, validated records, from the single number up to the whole run.

Everything a report shows is one of these records; a report computes nothing.  Read `run` first, then `scene_run` and
`claim`; the others are tables and figures that some cases add.
"""
