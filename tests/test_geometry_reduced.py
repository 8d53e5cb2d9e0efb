"""The reduced surfaces of the special categories: from Gamma in symbols, and as limits of general arms."""

import pytest
import sympy
from sympy import Matrix, Symbol, symbols

from synth.geometry import derivation
from synth.geometry._gamma_polynomials import workspace_polynomials

S = dict(zip(derivation.ARGUMENTS, symbols(derivation.ARGUMENTS), strict=True))
x, y, z, d12 = symbols("x y z d12", real=True)
N = x**2 + y**2 + z**2


def gamma(**constraints):
    """Gamma(x, y, z) in squared distances and d12, with some distances replaced."""
    q = workspace_polynomials(*(S | constraints).values())
    q0, q1, q2, q3, q4, q5 = q[0]
    quartic = q0 * N**2 + q1 * d12 * z * N + q2 * (x**2 + y**2) + q3 * z**2 + q4 * d12 * z + q5
    return sympy.expand(quartic.subs(S["s12"], d12**2))


def triangle(first, second, opposite):
    """D(i,j,k), four times the squared area of a triangle, in its squared sides."""
    return first * second - (first + second - opposite) ** 2 / 4


def edges_from_p1(i, j):
    """(P_i - P1) . (P_j - P1) in squared distances."""
    return derivation.inner_product((1, i), (1, j))


def is_zero(expression):
    return sympy.expand(expression.subs(S["s12"], d12**2)) == 0


class TestSpecialCases:
    def test_spherical(self):
        s12, s14, s24, s35 = (S[name] for name in ("s12", "s14", "s24", "s35"))
        reduced = gamma(s13=sympy.S.Zero, s23=s12, s34=s14)
        assert S["s45"] not in reduced.free_symbols
        assert is_zero(reduced + triangle(s12, s14, s24) / 4 * (N - s35) ** 2)

    def test_puma_like(self):
        s12, s23, s45 = (S[name] for name in ("s12", "s23", "s45"))
        reduced = gamma(s24=sympy.S.Zero, s14=s12, s34=s23, s13=s12 + s23)
        assert S["s35"] not in reduced.free_symbols
        assert is_zero(reduced + s12 * s23 / 4 * (x**2 + y**2 + (z - d12) ** 2 - s45) ** 2)

    def test_puma_like_with_oblique_axes(self):
        s12, s13, s23, s45 = (S[name] for name in ("s12", "s13", "s23", "s45"))
        reduced = gamma(s24=sympy.S.Zero, s14=s12, s34=s23)
        assert S["s35"] not in reduced.free_symbols
        square = (x**2 + y**2 + (z - d12) ** 2 - s45) ** 2
        assert is_zero(reduced + triangle(s12, s23, s13) / 4 * square)

    @pytest.mark.parametrize("sense", [1, -1])
    def test_scara_in_finite_distances(self, sense):
        rho, z3, z5, d34, radius = symbols("rho z3 z5 d34 R", real=True)
        z4 = z3 + sense * d34
        distances = {
            "s13": rho**2 + z3**2,
            "s14": rho**2 + z4**2,
            "s23": rho**2 + (z3 - d12) ** 2,
            "s24": rho**2 + (z4 - d12) ** 2,
            "s34": d34**2,
            "s35": radius**2 + (z5 - z3) ** 2,
            "s45": radius**2 + (z5 - z4) ** 2,
        }
        assert is_zero(gamma(**distances) + d12**2 * d34**2 * rho**2 * (z - z5) ** 2)

        # The two constraints that parallel axes put on the distances, and the height in distances.
        s12, s13, s14, s23, s24, s34, s35, s45 = (S | distances).values()
        assert is_zero(s13 - s14 - s23 + s24 + sense * 2 * d12 * d34)
        assert is_zero(d12 * (s14 - s13 - s34) - sense * d34 * (s12 + s13 - s23))
        height = (s12 + s13 - s23) / (2 * d12) + sense * (s34 + s35 - s45) / (2 * d34)
        assert is_zero(sympy.cancel(height.subs(S["s12"], d12**2)) - z5)

    def test_parallel_axes_are_one_equation_for_real_arms(self):
        # q0 = 0 makes bb det(Gram) minus a square, and points in space have det(Gram) >= 0.
        gram = derivation.symmetric("")
        bb, bg, bk, gk = gram[0, 0], gram[0, 1], gram[0, 2], gram[1, 2]
        minus_4_q0 = gram.adjugate()[1, 1]
        base = bb * gram[1, 1] - bg**2
        assert is_zero(bb * gram.det() - base * minus_4_q0 + (bb * gk - bg * bk) ** 2)

    def test_scara_as_in_the_paper_with_points_at_infinity(self):
        delta, z4, z5 = symbols("delta z4 z5")
        far = {"s13": delta**2, "s23": (d12 + delta) ** 2, "s34": (z4 + delta) ** 2, "s35": (z5 + delta) ** 2}
        in_delta = sympy.Poly(gamma(**far), delta)
        assert in_delta.degree() == 2
        leading = in_delta.coeff_monomial(delta**2).subs({S["s24"]: 0, S["s14"]: d12**2})
        phi = sympy.cancel(leading / ((z4 - d12) * d12**2)).subs(z4, d12)
        plane, sphere = z - z5, x**2 + y**2 + (z - d12) ** 2 - S["s45"]
        assert is_zero(phi + plane * sphere)
        assert is_zero(sympy.Poly(phi, d12).LC() + plane)

    def test_every_coplanar_pair_of_axes(self):
        # P3 = (x3, 0, z3), P4 = (x4, 0, z4): a sphere where x4 != x3, a plane where x4 = x3.
        x3, z3, x4, z4 = symbols("x3 z3 x4 z4", real=True)
        s35, s45 = S["s35"], S["s45"]
        coplanar = {
            "s13": x3**2 + z3**2,
            "s14": x4**2 + z4**2,
            "s23": x3**2 + (z3 - d12) ** 2,
            "s24": x4**2 + (z4 - d12) ** 2,
            "s34": (x4 - x3) ** 2 + (z4 - z3) ** 2,
        }
        root = (
            (N - coplanar["s13"] - s35) * (x4 - x3)
            - 2 * (z - z3) * (z3 * x4 - x3 * z4)
            - x3 * (coplanar["s34"] + s35 - s45)
        )
        assert is_zero(gamma(**coplanar) + d12**2 / 4 * root**2)

    def test_the_bideterminant_identity_says_why(self):
        # D(1,2,3) D(1,2,3,4,5) = D(1,2,3,4) D(1,2,3,5) - D(1,2,3,4; 1,2,3,5)^2: Jacobi's identity, which
        # every symmetric matrix obeys, read in inner products of the edges from P1.
        m = Matrix(4, 4, lambda i, j: Symbol(f"m{min(i, j)}{max(i, j)}"))
        determinant = m.det(method="berkowitz")
        d123, d1234, d1235 = (m.extract(i, i).det() for i in ([0, 1], [0, 1, 2], [0, 1, 3]))
        mixed = m.extract([0, 1, 2], [0, 1, 3]).det()
        assert is_zero(d123 * determinant - (d1234 * d1235 - mixed**2))
        products = {m[i, j]: edges_from_p1(i + 2, j + 2) for i in range(4) for j in range(i, 4)}
        in_distances = determinant.subs(products, simultaneous=True)
        assert is_zero(in_distances - derivation.bordered_determinant())

    def test_the_identity_is_silent_where_p3_is_p1(self):
        # 0 = 0, but not so from another point of axis 2: with P4 first the factor is D(1,2,4).
        def at_p1(rows, columns):
            minor = Matrix([[edges_from_p1(i, j) for j in columns] for i in rows]).det()
            return minor.subs({S["s13"]: 0, S["s23"]: S["s12"], S["s34"]: S["s14"]})

        assert is_zero(at_p1([2, 3], [2, 3]))
        assert is_zero(at_p1([2, 3, 4], [2, 3, 4]))
        assert is_zero(at_p1([2, 3, 4], [2, 3, 5]))
        assert is_zero(at_p1([2, 4], [2, 4]) - triangle(S["s12"], S["s14"], S["s24"]))
