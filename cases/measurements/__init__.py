"""What is measured of methods: cost of accuracy, hard ladders, advice, answers to an accuracy.

Enters: methods and scenes of the library. Leaves: errors, stated errors and seconds, for reports
and for the gate. Read `measurement` first: the one kind of row and the queries on it; then
`driver`, which makes rows, `study`, which makes a case of a report, and `suites`, the studies that a report shows.
"""
