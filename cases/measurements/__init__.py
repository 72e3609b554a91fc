"""What is measured of methods: cost of accuracy, random campaigns, hard ladders, evidence for settings, advice.

Enters: methods and scenes of the library or drawn at random. Leaves: errors, stated errors and seconds, for reports,
for the gate, and for the choice of settings. Read `measurement` first: the one kind of row and the queries on it; then
`driver`, which makes rows, `study`, which makes a case of a report, and `suites`, the studies that a report shows.
"""
