"""Impact of a sphere on a standard-solid layer, Fig. 12: springs of Eq. (51), integrated in extended precision.

The spring at x has the force 4 cbar(x/h) (G_inf w + s) per length, with s' = G_1 w' - s/tau from the time t_c at which
it is touched. With S = G_1 int_0^t exp(-(t - t')/tau) delta' dt' a spring touched at t_c has
s = S(t) - exp(-(t - t_c)/tau) S(t_c). It leaves the contact when its force is zero again.
During compression all quantities are smooth in u = sqrt(t), because the contact radius grows like sqrt(t). During
restitution the contact edge is the spring of zero force. Both phases are integrated by the classical Runge-Kutta rule
of fourth order.
"""

from collections.abc import Callable
from dataclasses import dataclass, field

from mpmath import mp, mpf

from benchmarks.references.layer_equation import Contact

# Largest tabulated confinement a/h: on the thinnest layer it reaches 1.1.
LARGEST_RATIO = mpf("1.2")
# Number of Chebyshev points over the confinement, and of Gauss nodes of each solution.
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
    """Functions of the contact radius a [m]; the defaults are those of the half-space.

    Attributes:
        stiffness: Spring stiffness cbar(a).
        profile_slope: Slope dg/da of the MDR profile g.
        sharpness: Limit of g/a^2 for a -> 0 [1/m].
    """

    stiffness: Function = lambda a: mpf(1)
    profile_slope: Function = lambda a: 2 * a / CURVATURE_RADIUS
    sharpness: mpf = field(default_factory=lambda: 1 / CURVATURE_RADIUS)


def tabulated_springs() -> tuple[list[mpf], list[mpf]]:
    """Chebyshev sums of cbar and of g R/a^2 over a/h in [0, `LARGEST_RATIO`], for bonded incompressible layers."""

    def solved(ratio: mpf) -> tuple[mpf, mpf]:
        """cbar and g R/a^2 at a ratio a/h."""
        contact = Contact(ratio, mpf("0.5"), NODES)
        edge = contact.density(lambda x: mpf(1)).value(contact.a)
        return edge**2, contact.density(lambda x: x**2).value(contact.a) / (edge * contact.a**2)

    places = [mp.cos(mp.pi * (2 * i + 1) / (2 * POINTS)) for i in range(POINTS)]
    values = [solved(LARGEST_RATIO * (1 + x) / 2) for x in places]
    return _coefficients([v[0] for v in values]), _coefficients([v[1] for v in values])


def _coefficients(values: list[mpf]) -> list[mpf]:
    """Coefficients of the Chebyshev sum through n values at the roots of T_n."""
    n = len(values)
    angles = [mp.pi * (2 * i + 1) / (2 * n) for i in range(n)]
    sums = [mp.fsum(v * mp.cos(k * t) for v, t in zip(values, angles, strict=True)) for k in range(n)]
    return [sums[0] / n, *(2 * s / n for s in sums[1:])]


def _chebyshev(coefficients: list[mpf], x: mpf) -> tuple[mpf, mpf]:
    """Chebyshev sum and its derivative at x in [-1, 1]."""
    t, d = [mpf(1), x], [mpf(0), mpf(1)]
    for _ in coefficients[2:]:
        t.append(2 * x * t[-1] - t[-2])
        d.append(2 * t[-2] + 2 * x * d[-1] - d[-2])
    return mp.fdot(coefficients, t), mp.fdot(coefficients, d)


def springs_of(thickness: mpf, table: tuple[list[mpf], list[mpf]]) -> SphereSprings:
    """Springs of a bonded incompressible layer of a thickness [m], from `tabulated_springs`."""

    def place(a: mpf) -> mpf:
        """Argument in [-1, 1] of the Chebyshev sums at a contact radius a [m]."""
        return 2 * a / (thickness * LARGEST_RATIO) - 1

    def slope(a: mpf) -> mpf:
        """dg/da at a contact radius a [m]."""
        value, change = _chebyshev(table[1], place(a))
        return (2 * a * value + a**2 * change * 2 / (thickness * LARGEST_RATIO)) / CURVATURE_RADIUS

    start = _chebyshev(table[1], mpf(-1))[0] / CURVATURE_RADIUS
    return SphereSprings(lambda a: _chebyshev(table[0], place(a))[0], slope, start)


@dataclass(frozen=True)
class SphereImpact:
    """Result of an impact.

    Attributes:
        restitution: Rebound speed over approach speed.
        peak_force: Largest force [N].
    """

    restitution: mpf
    peak_force: mpf


def impact(springs: SphereSprings, steps: int) -> SphereImpact:
    """Restitution and largest force, with about ``steps`` time steps until the largest depth."""
    compression, end = _compression(springs, steps)
    forces = [(_force(state, state[:], u * u), u) for u, state, _ in compression]
    return SphereImpact(restitution=_restitution(compression, end, steps), peak_force=_vertex(forces))


# Components of a state: depth, velocity, S, contact radius a, and integrals over a of c, c g and c exp(t_c/tau) S(t_c).
DEPTH, SPEED, MEMORY, RADIUS, SPRINGS, PROFILE, TOUCHED = range(7)


def _force(state: State, edge: State, time: mpf) -> mpf:
    """Force 2 int_0^a f dx [N]; ``edge`` is the state at the time when the contact edge was touched."""
    now = G_INF * state[DEPTH] + state[MEMORY]
    return 8 * (now * edge[SPRINGS] - G_INF * edge[PROFILE] - mp.exp(-time / TAU) * edge[TOUCHED])


def _compression(springs: SphereSprings, steps: int) -> tuple[list[tuple[mpf, State, State]], mpf]:
    """Compression: u, state and derivative of the state by u at every step, and the u at which the velocity is zero."""

    def rates(u: mpf, state: State) -> State:
        """Derivative of the state by u, the root of time."""
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
    steps_so_far = [(u, state, rates(u, state))]
    while True:
        following = _stepped(rates, u, state, step)
        if following[SPEED] <= 0:
            part = _to_rest(rates, u, state, step)
            state, u = _stepped(rates, u, state, part), u + part
            return [*steps_so_far, (u, state, rates(u, state))], u
        u, state = u + step, following
        steps_so_far.append((u, state, rates(u, state)))


def _to_rest(rates: Callable[[mpf, State], State], u: mpf, state: State, step: mpf) -> mpf:
    """Part of a step, in u, after which the velocity is zero."""
    return mp.findroot(lambda part: _stepped(rates, u, state, part)[SPEED], (step / 3, step / 2), tol=1e-40)


def _stepped(rates: Callable[[mpf, State], State], x: mpf, state: State, step: mpf) -> State:
    """State after one step of the classical Runge-Kutta rule."""

    def shifted(slope: State, part: mpf) -> State:
        """The state plus ``part`` times a slope."""
        return [s + part * d for s, d in zip(state, slope, strict=True)]

    k1 = rates(x, state)
    k2 = rates(x + step / 2, shifted(k1, step / 2))
    k3 = rates(x + step / 2, shifted(k2, step / 2))
    k4 = rates(x + step, shifted(k3, step))
    return [s + step / 6 * (a + 2 * b + 2 * c + d) for s, a, b, c, d in zip(state, k1, k2, k3, k4, strict=True)]


def _restitution(compression: list[tuple[mpf, State, State]], end: mpf, steps: int) -> mpf:
    """Coefficient of restitution: the edge recedes until the spring in the middle leaves the contact."""
    edge = end

    def rates(time: mpf, state: State) -> State:
        """Derivative of depth, velocity and S by time."""
        nonlocal edge
        edge = _edge(compression, state, time, edge)
        full = [*state, *[mpf(0)] * 4]
        force = _force(full, _between(compression, edge), time)
        return [state[SPEED], -force / MASS, G_1 * state[SPEED] - state[MEMORY] / TAU]

    state, time, step = compression[-1][1][:3], end**2, end**2 / steps
    while True:
        following = _stepped(rates, time, state, step)
        if G_INF * following[DEPTH] + following[MEMORY] <= 0:
            if step < end**2 / steps / 2**24:
                return -state[SPEED] / VELOCITY
            step /= 2
            continue
        time, state = time + step, following


def _edge(compression: list[tuple[mpf, State, State]], state: State, time: mpf, last_edge: mpf) -> mpf:
    """u at which the spring of zero force at ``time`` was touched, by bisection and secants."""

    def spring_force(u: mpf) -> mpf:
        """Force over stiffness at ``time`` of the spring touched at u."""
        touched = _between(compression, u)
        fading = mp.exp((u * u - time) / TAU) * touched[MEMORY]
        return G_INF * (state[DEPTH] - touched[DEPTH]) + state[MEMORY] - fading

    low, high = mpf(0), compression[-1][0]
    if spring_force(low) <= 0:
        return low
    for _ in range(8):
        middle = (low + high) / 2
        low, high = (middle, high) if spring_force(middle) > 0 else (low, middle)
    return mp.findroot(spring_force, (low, high), solver="anderson", tol=1e-32, verify=False)


def _between(compression: list[tuple[mpf, State, State]], u: mpf) -> State:
    """State of the compression at u, by cubics through values and slopes."""
    step = compression[1][0]
    i = min(int(u / step), len(compression) - 2)
    (start, left, left_slope), (stop, right, right_slope) = compression[i], compression[i + 1]
    width = stop - start
    s = (u - start) / width
    values = zip(left, right, left_slope, right_slope, strict=True)
    return [
        (1 + 2 * s) * (1 - s) ** 2 * a + s**2 * (3 - 2 * s) * b + width * s * (1 - s) * ((1 - s) * p - s * q)
        for a, b, p, q in values
    ]


def _vertex(samples: list[tuple[mpf, mpf]]) -> mpf:
    """Largest value of samples (y, x): the maximum of the polynomial through the five samples around the highest."""
    top = max(range(len(samples)), key=lambda i: samples[i][0])
    near = samples[top - 2 : top + 3]

    def curve(x: mpf) -> mpf:
        """Lagrange polynomial through the five samples."""
        return mp.fsum(
            y * mp.fprod((x - other_node) / (node - other_node) for _, other_node in near if other_node != node)
            for y, node in near
        )

    place = mp.findroot(lambda x: mp.diff(curve, x), (near[1][1], near[3][1]), tol=1e-24)
    return curve(place)
