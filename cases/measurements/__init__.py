"""What is measured of methods: cost of accuracy, random campaigns, hard ladders, evidence for settings, advice.

Enters: methods and scenes of the library or drawn at random. Leaves: errors, stated errors and seconds, for reports,
for the gate, and for the choice of settings. Read `suites` first: the studies that a report shows.
"""
