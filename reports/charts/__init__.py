"""The figures a report draws by itself, each from one kind of record; their data are those records, digit for digit.

========================  ==========================================================
`charts.agreement`        differences of two methods, with uncertainty, against the tolerance
`charts.convergence`      error under refinement, formal slope, GCI bars
`charts.ladder`           digits left as a parameter gets hard
`charts.solution`         one answer: force over depth, or its history
`charts.three_answers`    the front page: differences, costs and ladders of all cases
`charts.work_precision`   error against seconds, Pareto front, crossover
========================  ==========================================================
"""
