"""Derives the workspace polynomials from the Cayley-Menger determinant; the only module with sympy.

    python -m synth.geometry.derivation        writes _gamma_polynomials.py

The determinant of five points is the Gram determinant of four edges,

    D(1,2,3,4,5) = det [v_i . v_j],    v = b = P2 - P1, g = P3 - P1, k = P4 - P3, x = P5 - P1,

whose inner products are linear in the squared distances. Only three of them move with P5: x.x = N,
b.x = d12 z and g.x = (N + f) / 2, where f = s13 - s35; from k.x the position drops out. A border
expands a determinant into cofactors, here of the 3x3 Gram matrix of b, g, k:

    Gamma = N det(Gram) - y^T adj(Gram) y,    y = (d12 z, (N + f) / 2, k.x).

Collecting powers of N and z gives q0 ... q5; collecting powers of s15 = N and s25 = N - 2 d12 z + s12
gives the same determinant as a quadratic in these two distances. Differences of distances are taken
first and once, which is also what keeps the digits over short baselines.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations_with_replacement
from pathlib import Path

import sympy
from sympy import Expr, Matrix, Symbol

ARGUMENTS = ("s12", "s13", "s14", "s23", "s24", "s34", "s35", "s45")
OUTPUT = Path(__file__).with_name("_gamma_polynomials.py")

N = Symbol("N")
D12_Z = Symbol("d12_z")  # the product d12 z: D knows the height of P5 in no other way
EDGES = {"b": (1, 2), "g": (1, 3), "k": (3, 4)}
GAMMA = sympy.symbols("q:6")


@dataclass(frozen=True)
class Derivation:
    """The workspace polynomials, each layer in terms of the ones before.

    Attributes:
        products: Inner products of the edges, in the squared distances.
        cofactors: Cofactors of the Gram matrix of b, g, k, and its determinant, in `products`.
        gamma: q0, ..., q5 in `products`, `cofactors` and each other.
        quadratic: c0, ..., c5 of D = c0 + c1 s15 + c2 s25 + c3 s15^2 + c4 s15 s25 + c5 s25^2, likewise.
    """

    products: dict[Symbol, Expr]
    cofactors: dict[Symbol, Expr]
    gamma: dict[Symbol, Expr]
    quadratic: dict[Symbol, Expr]


def squared_distance(i: int, j: int) -> Expr:
    """Return the symbol s_ij, with s_ji = s_ij and s_ii = 0."""
    return sympy.S.Zero if i == j else Symbol(f"s{min(i, j)}{max(i, j)}")


def bordered_determinant() -> Expr:
    """Return D(1,2,3,4,5) = -1/16 of the bordered 6x6 determinant: 130 terms in ten squared distances."""
    bordered = Matrix(6, 6, lambda i, j: squared_distance(i, j) if i * j else int(i != j))
    return sympy.expand(-bordered.det(method="berkowitz") / 16)


def inner_product(first: tuple[int, int], second: tuple[int, int]) -> Expr:
    """Return (P_j - P_i) . (P_n - P_m) in squared distances, for the edges (i, j) and (m, n)."""
    (i, j), (m, n) = first, second
    s = squared_distance
    return (s(i, n) + s(j, m) - s(i, m) - s(j, n)) / 2


def symmetric(prefix: str) -> Matrix:
    """Return a symmetric 3x3 matrix of symbols, named by the edges b, g and k."""
    return Matrix(3, 3, lambda i, j: Symbol(prefix + "".join(sorted("bgk"[i] + "bgk"[j]))))


def derive() -> Derivation:
    """Derive the polynomials."""
    gram, adjugate = symmetric(""), symmetric("adj_")
    pairs = list(combinations_with_replacement(range(3), 2))
    ends = list(EDGES.values())
    f, xk, volume = sympy.symbols("f xk det")
    products = {gram[i, j]: inner_product(ends[i], ends[j]) for i, j in pairs}
    products[f] = squared_distance(1, 3) - squared_distance(3, 5)
    products[xk] = inner_product((1, 5), EDGES["k"])
    cofactors = {adjugate[i, j]: gram.adjugate()[i, j] for i, j in pairs}
    cofactors[volume] = gram.row(0).dot(adjugate.row(0))

    y = Matrix([D12_Z, (N + f) / 2, xk])
    terms = sympy.Poly(N * volume - (y.T * adjugate * y)[0], N, D12_Z).coeff_monomial
    q0, q1, q2, q3, q4, q5 = GAMMA
    s12 = squared_distance(1, 2)
    # z^2 = (d12 z)^2 / s12 also has its share in N, which stands apart as q2.
    gamma = {
        q0: terms(N**2),
        q1: terms(N * D12_Z),
        q2: terms(N),
        q3: q2 + s12 * terms(D12_Z**2),
        q4: terms(D12_Z),
        q5: terms(1),
    }

    s15, s25 = squared_distance(1, 5), squared_distance(2, 5)
    quartic = q0 * N**2 + q1 * D12_Z * N + q2 * N + terms(D12_Z**2) * D12_Z**2 + q4 * D12_Z + q5
    from_distances = sympy.expand(quartic.subs({N: s15, D12_Z: (s15 + s12 - s25) / 2}))
    terms = sympy.Poly(from_distances, s15, s25).coeff_monomial
    monomials = (1, s15, s25, s15**2, s15 * s25, s25**2)
    quadratic = {Symbol(f"c{i}"): terms(monomial) for i, monomial in enumerate(monomials)}
    return Derivation(products, cofactors, gamma, quadratic)


def source(derivation: Derivation) -> str:
    """Return the derivation as the text of a Python module."""
    layers = (derivation.products, derivation.cofactors, derivation.gamma, derivation.quadratic)
    assignments = [f"    {name} = {_code(value)}" for layer in layers for name, value in layer.items()]
    results = [f"({', '.join(map(str, layer))})" for layer in layers[2:]]
    return "\n".join([
        '"""GENERATED by `python -m synth.geometry.derivation`: change that module, not this one."""',
        "",
        "from __future__ import annotations",
        "",
        "from typing import Any",
        "",
        "",
        "def workspace_polynomials(",
        f"    {', '.join(f'{name}: Any' for name in ARGUMENTS)}",
        ") -> tuple[tuple[Any, ...], tuple[Any, ...]]:",
        '    """Return (q0, ..., q5) and (c0, ..., c5), of numbers, arrays or symbols alike."""',
        *assignments,
        f"    return {', '.join(results)}",
        "",
    ])  # fmt: skip


def _code(expression: Expr) -> str:
    """Return an expression as Python code over one denominator, with spaces around * and /."""
    numerator, denominator = sympy.fraction(sympy.together(expression))
    text = (
        str(sympy.pycode(sympy.expand(numerator))).replace("**", "^").replace("*", " * ").replace("^", "**")
    )
    if denominator == 1:
        return text
    return f"({text}) / {denominator}" if numerator.is_Add else f"{text} / {denominator}"


if __name__ == "__main__":
    OUTPUT.write_text(source(derive()), encoding="utf-8")
