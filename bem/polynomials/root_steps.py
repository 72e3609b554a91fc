"""How many steps a bracketed search for a root may take."""

# Most steps. Bisection alone gains one binary digit a step and needs about 53, so the cap binds on faulty curves only.
MOST_STEPS = 60
