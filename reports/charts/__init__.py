"""The figures a report draws by itself, each from one kind of record; their data are those records, digit for digit.

========================  ==========================================================
`charts.agreement`        differences of two methods, with uncertainty, against the tolerance
`charts.convergence`      error under refinement, formal slope, GCI bars
`charts.coverage`         stated over true errors of random scenes
`charts.error_map`        signed errors over a/h and Poisson's ratio
`charts.history`          how far accepted numbers moved, run after run
`charts.ladder`           digits left as a parameter gets hard
`charts.scaling`          seconds against size with the slope of theory
`charts.solution`         one answer: force over depth, or its history
`charts.three_answers`    the front page: differences, costs and ladders of all cases
`charts.work_precision`   error against seconds, Pareto front, crossover
========================  ==========================================================
"""
