"""Impact of a sphere on a standard-solid layer, Fig. 12: springs of Eq. (51), integrated in extended precision.

Springs of stiffness 4 cbar(x/h) carry G_inf w + s each, with s' = G_1 w' - s/tau from the moment t_c at which they are
touched. With S = G_1 int_0^t exp(-(t - t')/tau) delta' dt' a spring touched at t_c holds
S(t) - exp(-(t - t_c)/tau) S(t_c), and it lets go when its force is back at zero.
On the way in everything is smooth in u = sqrt(t), because the contact
radius grows like sqrt(t); on the way out the edge is the spring whose force is zero. Both ways take the classical
Runge-Kutta rule of fourth order.
"""

from collections.abc import Callable
from dataclasses import dataclass, field

from mpmath import mp, mpf

from benchmarks.references.layer_equation import Contact

# Confinement up to which springs are tabulated: the thinnest layer reaches a/h = 1.1.
LARGEST_RATIO = mpf("1.2")
# Chebyshev points over the confinement, and Gauss nodes of each solution.
POINTS, NODES = 18, 18

G_1 = mpf("7.5e6")
G_INF = G_1 / 9
TAU = mpf("1e-3")
MASS = mpf("0.02")
CURVATURE_RADIUS = mpf("1e-2")
VELOCITY = mpf("1.27479e-3") / CURVATURE_RADIUS

Function = Callable[[mpf], mpf]
State = list[mpf]


@dataclass(frozen=True)
class SphereSprings:
    """cbar and the MDR profile over the contact radius [m]; the half-space has 1 and a^2/R."""

    stiffness: Function = lambda a: mpf(1)
    profile_slope: Function = lambda a: 2 * a / CURVATURE_RADIUS
    sharpness: mpf = field(default_factory=lambda: 1 / CURVATURE_RADIUS)


def tabulated_springs() -> tuple[list[mpf], list[mpf]]:
    """Chebyshev sums of cbar and of g R/a^2 over a/h in [0, `LARGEST_RATIO`], for bonded incompressible layers."""

    def solved(ratio: mpf) -> tuple[mpf, mpf]:
        contact = Contact(ratio, mpf("0.5"), NODES)
        edge = contact.density(lambda x: mpf(1)).value(contact.a)
        return edge**2, contact.density(lambda x: x**2).value(contact.a) / (edge * contact.a**2)

    places = [mp.cos(mp.pi * (2 * i + 1) / (2 * POINTS)) for i in range(POINTS)]
    values = [solved(LARGEST_RATIO * (1 + x) / 2) for x in places]
    return _coefficients([v[0] for v in values]), _coefficients([v[1] for v in values])


def _coefficients(values: list[mpf]) -> list[mpf]:
    """Of the Chebyshev sum through values at the roots of T_n."""
    n = len(values)
    angles = [mp.pi * (2 * i + 1) / (2 * n) for i in range(n)]
    sums = [mp.fsum(v * mp.cos(k * t) for v, t in zip(values, angles, strict=True)) for k in range(n)]
    return [sums[0] / n, *(2 * s / n for s in sums[1:])]


def _chebyshev(coefficients: list[mpf], x: mpf) -> tuple[mpf, mpf]:
    """The sum and its derivative at x in [-1, 1]."""
    t, d = [mpf(1), x], [mpf(0), mpf(1)]
    for _ in coefficients[2:]:
        t.append(2 * x * t[-1] - t[-2])
        d.append(2 * t[-2] + 2 * x * d[-1] - d[-2])
    return mp.fdot(coefficients, t), mp.fdot(coefficients, d)


def springs_of(thickness: mpf, table: tuple[list[mpf], list[mpf]]) -> SphereSprings:
    """Springs of a bonded incompressible layer [m]."""

    def place(a: mpf) -> mpf:
        return 2 * a / (thickness * LARGEST_RATIO) - 1

    def slope(a: mpf) -> mpf:
        value, change = _chebyshev(table[1], place(a))
        return (2 * a * value + a**2 * change * 2 / (thickness * LARGEST_RATIO)) / CURVATURE_RADIUS

    start = _chebyshev(table[1], mpf(-1))[0] / CURVATURE_RADIUS
    return SphereSprings(lambda a: _chebyshev(table[0], place(a))[0], slope, start)


@dataclass(frozen=True)
class SphereImpact:
    """Rebound speed over approach speed, and the largest force [N]."""

    restitution: mpf
    peak_force: mpf


def impact(springs: SphereSprings, steps: int) -> SphereImpact:
    """The impact with so many steps to the largest depth, about."""
    inward, end = _inward(springs, steps)
    forces = [(_force(state, state[:], u * u), u) for u, state, _ in inward]
    return SphereImpact(restitution=_outward(inward, end, steps), peak_force=_vertex(forces))


# Depth, velocity, S, contact radius, and integrals over it of c, c g and c exp(t_c/tau) S(t_c).
DEPTH, SPEED, MEMORY, RADIUS, SPRINGS, PROFILE, TOUCHED = range(7)


def _force(state: State, edge: State, time: mpf) -> mpf:
    """2 int_0^a f dx of a motion whose edge was touched in the state ``edge`` of the way in."""
    now = G_INF * state[DEPTH] + state[MEMORY]
    return 8 * (now * edge[SPRINGS] - G_INF * edge[PROFILE] - mp.exp(-time / TAU) * edge[TOUCHED])


def _inward(springs: SphereSprings, steps: int) -> tuple[list[tuple[mpf, State, State]], mpf]:
    """u, state and its derivative in u at every step, and the u at which the body stands still."""

    def rates(u: mpf, state: State) -> State:
        """Slope of the state in u, the root of time."""
        depth, v, memory, a = state[:4]
        growth = 2 * u * v / springs.profile_slope(a) if u else mp.sqrt(VELOCITY / springs.sharpness)
        c, time = springs.stiffness(a), u * u
        motion = [v, -_force(state, state, time) / MASS, G_1 * v - memory / TAU]
        return [2 * u * one for one in motion] + [
            growth,
            c * growth,
            c * depth * growth,
            c * mp.exp(time / TAU) * memory * growth,
        ]

    step = mp.sqrt(mpf("1.2e-3")) / steps
    u, state = mpf(0), [mpf(0), VELOCITY, *[mpf(0)] * 5]
    passed = [(u, state, rates(u, state))]
    while True:
        after = _stepped(rates, u, state, step)
        if after[SPEED] <= 0:
            part = _to_rest(rates, u, state, step)
            state, u = _stepped(rates, u, state, part), u + part
            return [*passed, (u, state, rates(u, state))], u
        u, state = u + step, after
        passed.append((u, state, rates(u, state)))


def _to_rest(rates: Callable[[mpf, State], State], u: mpf, state: State, step: mpf) -> mpf:
    """The part of a step after which the body stands still."""
    return mp.findroot(lambda part: _stepped(rates, u, state, part)[SPEED], (step / 3, step / 2), tol=1e-40)


def _stepped(rates: Callable[[mpf, State], State], x: mpf, state: State, step: mpf) -> State:
    """One step of the classical Runge-Kutta rule."""

    def moved(slope: State, part: mpf) -> State:
        return [s + part * d for s, d in zip(state, slope, strict=True)]

    k1 = rates(x, state)
    k2 = rates(x + step / 2, moved(k1, step / 2))
    k3 = rates(x + step / 2, moved(k2, step / 2))
    k4 = rates(x + step, moved(k3, step))
    return [s + step / 6 * (a + 2 * b + 2 * c + d) for s, a, b, c, d in zip(state, k1, k2, k3, k4, strict=True)]


def _outward(inward: list[tuple[mpf, State, State]], end: mpf, steps: int) -> mpf:
    """Restitution: the edge retreats until the spring in the middle lets go."""
    edge = end

    def rates(time: mpf, state: State) -> State:
        """Slope of the state in time."""
        nonlocal edge
        edge = _edge(inward, state, time, edge)
        full = [*state, *[mpf(0)] * 4]
        force = _force(full, _between(inward, edge), time)
        return [state[SPEED], -force / MASS, G_1 * state[SPEED] - state[MEMORY] / TAU]

    state, time, step = inward[-1][1][:3], end**2, end**2 / steps
    while True:
        after = _stepped(rates, time, state, step)
        if G_INF * after[DEPTH] + after[MEMORY] <= 0:
            if step < end**2 / steps / 2**24:
                return -state[SPEED] / VELOCITY
            step /= 2
            continue
        time, state = time + step, after


def _edge(inward: list[tuple[mpf, State, State]], state: State, time: mpf, near: mpf) -> mpf:
    """u at which the spring was touched whose force is zero now, by bisection and secants from above."""

    def pull(u: mpf) -> mpf:
        touched = _between(inward, u)
        fading = mp.exp((u * u - time) / TAU) * touched[MEMORY]
        return G_INF * (state[DEPTH] - touched[DEPTH]) + state[MEMORY] - fading

    low, high = mpf(0), inward[-1][0]
    if pull(low) <= 0:
        return low
    for _ in range(8):
        middle = (low + high) / 2
        low, high = (middle, high) if pull(middle) > 0 else (low, middle)
    return mp.findroot(pull, (low, high), solver="anderson", tol=1e-32, verify=False)


def _between(inward: list[tuple[mpf, State, State]], u: mpf) -> State:
    """The state on the way in at u, by cubics through values and slopes."""
    step = inward[1][0]
    i = min(int(u / step), len(inward) - 2)
    (start, left, left_slope), (stop, right, right_slope) = inward[i], inward[i + 1]
    width = stop - start
    s = (u - start) / width
    values = zip(left, right, left_slope, right_slope, strict=True)
    return [
        (1 + 2 * s) * (1 - s) ** 2 * a + s**2 * (3 - 2 * s) * b + width * s * (1 - s) * ((1 - s) * p - s * q)
        for a, b, p, q in values
    ]


def _vertex(samples: list[tuple[mpf, mpf]]) -> mpf:
    """Largest value of smooth samples over x: the top of the polynomial through the five highest places."""
    top = max(range(len(samples)), key=lambda i: samples[i][0])
    near = samples[top - 2 : top + 3]

    def curve(x: mpf) -> mpf:
        return mp.fsum(
            y * mp.fprod((x - other) / (own - other) for _, other in near if other != own) for y, own in near
        )

    place = mp.findroot(lambda x: mp.diff(curve, x), (near[1][1], near[3][1]), tol=1e-24)
    return curve(place)
