"""Contact on the half-space that sticks inside r = c and slides beyond: Spence's coupled problem of finite friction.

As the contact grows, increments are flat punches that stick in r < c and slide with q = mu p in c < r < a, and c/a
depends on mu and nu alone: du_r/da, not u_r, vanishes where the surface sticks, and its traction has no singularity at
c, else friction would be exceeded or slip turned. With lengths in a and Abel densities of pressure and shear,

    p(r) = -(1/r) d/dr int_r^1 phi t/sqrt(t^2-r^2) dt,      q(r) = -d/dr int_r^1 psi/sqrt(t^2-r^2) dt,

u_z = 1 on r < 1 and u_r = 0 on r < k = c/a are, with beta = (1-2 nu)/(2-2 nu) and H f = (1/pi) PV int f(t)/(t-x) dt
over (-1, 1), phi even, psi odd,

    phi - beta H psi = 1 on (0, 1),          psi + beta H phi = 0 on (0, k),
    psi = mu G phi on (k, 1),     (G phi)(t) = phi(t) - (2 t/(3 pi)) int_t^1 phi(y) R_D(0, t^2/y^2, 1)/y^2 dy,

R_D Carlson's integral; G 1 = (2 t/pi) K(sqrt(1-t^2)). That psi is continuous at k gives mu. Where beta is small this is
Spence's ln((1+k)/(1-k))/(2k) = (mu/beta) K(sqrt(1-k^2)). Outside the punch the transform of the surface is -beta H psi,
from which the depth of a paraboloid follows, delta = a^2/(2 R I). Sinc quadrature on logarithmic points towards k and 1
resolves the powers of the distance to them; principal values use every second point. In double precision twelve digits
are equal on other points. The solvers share no code with this module.

Source: D. A. Spence, J. Elasticity 5 (1975) 297; V. I. Mossakovskii, J. Appl. Math. Mech. 27 (1963) 418. Checks are
the limits of no coupling and of full stick, not their printed numbers.
"""

from dataclasses import dataclass

import numpy as np
from scipy.special import ellipk, elliprd, sici

from contact.records.validation import FloatArray

# Step of the points in the logarithm of their distance to k: with 0.25 and 0.3 thirteen digits are equal.
STEP = 0.25
# Range of the points in the logarithm of the distance to k; nearer points contribute like the root of their distance.
REACH = 60.0
# Largest number of fixed-point iterations; they contract by about beta times the larger of beta and mu.
MOST_ROUNDS = 400
# Change of mu and phi at which the iteration ends.
SETTLED = 1e-13


@dataclass(frozen=True)
class PartialSlip:
    """Numbers of the contact with one nu and c/a.

    Attributes:
        coefficient: Coefficient of friction mu.
        depth: Depth delta R/a^2 of a paraboloid of radius R; 1 without friction.
        force: Force F of a paraboloid over that of Hertz at the same depth.
        stiffness: Stiffness k_N of the flat punch over 2 E* a.
        heat: Energy dissipated by a paraboloid over F delta.
    """

    coefficient: float
    depth: float
    force: float
    stiffness: float
    heat: float


@dataclass(frozen=True)
class _Points:
    """Quadrature points t of one interval, with distances to both ends free of cancellation, shape (n,) each.

    Attributes:
        t: Points.
        left: Distances to the lower end.
        right: Distances to the upper end.
        weight: Derivatives dt/dz by the variable z = ln(left/right) of the quadrature.
    """

    t: FloatArray
    left: FloatArray
    right: FloatArray
    weight: FloatArray

    @classmethod
    def between(cls, low: float, high: float, places: FloatArray, shift: float) -> "_Points":
        """Points of [low, high] at values z = places - shift of ln(left/right)."""
        z, length = places - shift, high - low
        left, right = length / (1.0 + np.exp(-z)), length / (1.0 + np.exp(z))
        return cls(np.where(z < 0.0, low + left, high - right), left, right, left * right / length)

    def principal(self, step: float, z: FloatArray) -> FloatArray:
        """Matrix (n, n) of (1/pi) PV int f/(t - x) dt on the interval, by every second point, without cancellation."""
        there, here = z[None, :] / 2.0, z[:, None] / 2.0
        odd = (np.arange(z.size)[None, :] - np.arange(z.size)[:, None]) % 2 == 1
        apart = np.where(odd, np.sinh(there - here), 1.0)
        return np.where(odd, step / np.pi * np.cosh(here) / (np.cosh(there) * apart), 0.0)


class HalfSpaceContact:
    """Discrete equations for one k = c/a, on points with a ``step`` of the logarithmic variable."""

    def __init__(self, share: float, step: float) -> None:
        self.k, self.step = share, step
        count, shift = round(REACH / step), float(np.log((1.0 - share) / (2.0 * share)))
        places: FloatArray = np.asarray(step * np.arange(-count, count + 1), dtype=np.float64)
        outer = np.asarray(step * np.arange(-count, count + 1 + max(0, round(shift / step))), dtype=np.float64)
        self.stuck = _Points.between(-share, share, places, 0.0)
        # Shifted, so that both intervals have the same distances to k.
        self.slid = _Points.between(share, 1.0, outer, shift)
        self._transform_parts(places, outer - shift)
        self._slip_parts()

    def _transform_parts(self, inner: FloatArray, outer: FloatArray) -> None:
        """Matrices of H between the sticking and the sliding interval; ``mirrored`` ones are those of -1 < t < -k.

        Args:
            inner: Values of ln(left/right) at the points of the sticking interval, shape (n,).
            outer: Values of ln(left/right) at the points of the sliding interval, shape (m,).
        """
        unit = self.step / np.pi
        stuck, slid, k = self.stuck, self.slid, self.k
        self.stuck_to_stuck, self.slid_to_slid = stuck.principal(self.step, inner), slid.principal(self.step, outer)
        self.slid_to_stuck = unit * slid.weight / (slid.left + stuck.right[:, None])
        self.mirrored_to_stuck = -unit * slid.weight / (slid.left + stuck.left[:, None])
        self.stuck_to_slid = -unit * stuck.weight / (stuck.right + slid.left[:, None])
        self.mirrored_to_slid = -unit * slid.weight / (slid.t + slid.t[:, None])
        self.stuck_to_k, self.slid_to_k = -unit * stuck.weight / stuck.right, unit * slid.weight / slid.left
        self.mirrored_to_k = -unit * slid.weight / (slid.t + k)
        # H 1 on both intervals and at k; H t = 2/pi + t H 1.
        self.of_one = [
            np.log((stuck.right + 1.0 - k) / (stuck.left + 1.0 - k)) / np.pi,
            np.log(slid.right / (1.0 + slid.t)) / np.pi,
            np.log((1.0 - k) / (1.0 + k)) / np.pi,
        ]

    def _slip_parts(self) -> None:
        """Matrices of G - 1 at the sliding points and at k: indefinite integrals by Stenger's sinc rule."""
        t, weight = self.slid.t, self.step * self.slid.weight / self.slid.t**2
        ahead = np.arange(t.size)[None, :] - np.arange(t.size)[:, None]
        self.beyond = 0.5 + sici(np.pi * ahead)[0] / np.pi
        kernel = elliprd(0.0, (t[:, None] / t) ** 2, 1.0)
        self.slip = -2.0 * t[:, None] / (3.0 * np.pi) * self.beyond * kernel * weight
        self.slip_at_k = -2.0 * self.k / (3.0 * np.pi) * elliprd(0.0, (self.k / t) ** 2, 1.0) * weight
        self.slip_of_one = 2.0 / np.pi * t * ellipk(1.0 - t**2)
        self.slip_of_one_at_k = 2.0 / np.pi * self.k * ellipk(1.0 - self.k**2)

    def transform(self, stuck: FloatArray, slid: FloatArray, parity: int) -> tuple[FloatArray, FloatArray, float]:
        """H f on both intervals and at k, of a function f of given parity that vanishes at k."""
        return (
            self.stuck_to_stuck @ stuck + (self.slid_to_stuck + parity * self.mirrored_to_stuck) @ slid,
            self.stuck_to_slid @ stuck + (self.slid_to_slid + parity * self.mirrored_to_slid) @ slid,
            float(self.stuck_to_k @ stuck + (self.slid_to_k + parity * self.mirrored_to_k) @ slid),
        )

    def solve(self, poissons_ratio: float) -> PartialSlip:
        """Coefficient of friction for which c/a = k, and the numbers of this contact.

        Raises:
            ArithmeticError: the iteration does not converge.
        """
        beta = (1.0 - 2.0 * poissons_ratio) / (2.0 - 2.0 * poissons_ratio)
        # phi - phi(k) on both intervals, phi(k), and mu.
        inner, outer, at_k, mu = np.zeros_like(self.stuck.t), np.zeros_like(self.slid.t), 1.0, 0.0
        for _ in range(MOST_ROUNDS):
            first, second, third = self.transform(inner, outer, 1)
            slipping = outer + self.slip @ outer + at_k * self.slip_of_one
            slipping_at_k = float(self.slip_at_k @ outer) + at_k * self.slip_of_one_at_k
            last_mu, mu = mu, -beta * (third + at_k * self.of_one[2]) / slipping_at_k
            shear, sheared = -beta * (first + at_k * self.of_one[0]), mu * slipping
            # psi = slope t + a remainder that vanishes at k.
            slope = mu * slipping_at_k / self.k
            transforms = self.transform(shear - slope * self.stuck.t, sheared - slope * self.slid.t, -1)
            points = (self.stuck.t, self.slid.t, self.k)
            phi = [
                1.0 + beta * (rest + slope * (2.0 / np.pi + point * log))
                for rest, point, log in zip(transforms, points, self.of_one, strict=True)
            ]
            change = abs(phi[2] - at_k) + abs(mu - last_mu)
            inner, outer, at_k = phi[0] - phi[2], phi[1] - phi[2], phi[2]
            if change < SETTLED:
                slip = sheared + beta * (second + at_k * self.of_one[1])
                return self._numbers(beta, mu, (phi[0], phi[1]), (shear, sheared), slip)
        raise ArithmeticError(
            f"partial slip at nu = {poissons_ratio:g}, c/a = {self.k:g} does not settle: {change:.1g}"
        )

    def _numbers(
        self,
        beta: float,
        mu: float,
        phi: tuple[FloatArray, FloatArray],
        psi: tuple[FloatArray, FloatArray],
        slip: FloatArray,
    ) -> PartialSlip:
        """k_N is int phi; delta = a^2/(2 R I), I = 1/2 - (beta/pi) int psi (-ln(1-t^2)/t^3 - 1/t) dt.

        For a paraboloid psi is the sum over all increments, t^2 int_t^1 psi/s^3 ds; its work on the slip is the heat.
        """
        stuck, slid = self.step * self.stuck.weight / 2.0, self.step * self.slid.weight
        stiffness = float(stuck @ phi[0] + slid @ phi[1])
        sticking_kernel = _depth_kernel(np.abs(self.stuck.t), -np.log1p(-(self.stuck.t**2)))
        sliding_kernel = _depth_kernel(self.slid.t, -np.log(self.slid.right) - np.log1p(self.slid.t))
        total = 0.5 - beta / np.pi * float(
            stuck @ (np.abs(psi[0]) * sticking_kernel) + slid @ (psi[1] * sliding_kernel)
        )
        grown = self.slid.t**2 * (self.beyond @ (slid * psi[1] / self.slid.t**3))
        heat = -1.2 * float(slid @ (grown * slip)) / stiffness
        return PartialSlip(float(mu), 1.0 / (2.0 * total), stiffness * (2.0 * total) ** 0.5, stiffness, heat)


def _depth_kernel(t: FloatArray, log: FloatArray) -> FloatArray:
    """Function -ln(1-t^2)/t^3 - 1/t from ``log`` = -ln(1-t^2), by its series at small t."""
    small = t < 0.05
    safe_t = np.where(small, 1.0, t)
    series = sum(t ** (2 * n - 1) / (n + 1) for n in range(1, 8))
    return np.asarray(np.where(small, series, log / safe_t**3 - 1.0 / safe_t))


def partial_slip(poissons_ratio: float, share: float, step: float = STEP) -> PartialSlip:
    """Numbers of the contact that sticks in r < ``share`` a."""
    return HalfSpaceContact(share, step).solve(poissons_ratio)
