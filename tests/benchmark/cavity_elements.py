#!/usr/bin/env python3
"""The expected figures of cavity.toml: cavity_elements.py [ELEMENTS], 48 elements across unless given; needs NumPy and SciPy.

Finite elements, velocity of degree 2 and discontinuous pressure of degree 1 on squares that shrink towards the walls. An
augmented Lagrangian (Fortin and Glowinski 1983) with a strain rate of its own at 3 x 3 Gauss points makes the yield exact.
Prints for each case the velocity along x in the middle of the cavity, and the vortex: where it is 0 there, and the flow
that turns below. Without a yield stress the vortex is at 0.765 of the height with 0.10008 of lid speed times width, as
published for creeping flow."""
import pathlib
import sys
import tomllib

import numpy as np
import scipy.sparse as sparse
from scipy.sparse.linalg import splu

HEIGHTS = (0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95)


def shape(s):
    """Values and slopes of the three quadratic functions on [0, 1]."""
    return (np.array([(1 - s) * (1 - 2 * s), 4 * s * (1 - s), s * (2 * s - 1)]), np.array([4 * s - 3, 4 - 8 * s, 4 * s - 1]))


def system(n):
    """Nodes of a unit cavity, B (three strain rates whose norm is gamma_dot at every Gauss point), their areas, and the
    divergence tested by the pressure's functions 1, x, y of each element."""
    edge = 0.5 - 0.5 * np.cos(np.pi * np.arange(n + 1) / n)
    line = np.sort(np.concatenate([edge, 0.5 * (edge[1:] + edge[:-1])]))
    gauss = 0.5 + 0.5 * np.sqrt(0.6) * np.array([-1, 0, 1])
    weight = np.array([5, 8, 5]) / 18
    m, total = 2 * n + 1, (2 * n + 1) ** 2
    i, j = (a.ravel() for a in np.meshgrid(np.arange(n), np.arange(n), indexing="ij"))
    hx, hy = np.diff(edge)[i], np.diff(edge)[j]
    nodes = np.stack([(2 * i + a) * m + 2 * j + b for a in range(3) for b in range(3)], 1)
    rows, columns, values, areas = [], [], [], []
    p_rows, p_columns, p_values = [], [], []
    element = np.arange(n * n)
    for k, (sx, wx) in enumerate(zip(gauss, weight)):
        for l, (sy, wy) in enumerate(zip(gauss, weight)):
            (fx, gx), (fy, gy) = shape(sx), shape(sy)
            dx = np.outer(gx, fy).ravel()[None, :] / hx[:, None]
            dy = np.outer(fx, gy).ravel()[None, :] / hy[:, None]
            row = 3 * (element * 9 + 3 * k + l)[:, None] + 0 * nodes
            for part, of_u, of_v in ((0, np.sqrt(2) * dx, 0 * dy), (1, 0 * dx, np.sqrt(2) * dy), (2, dy, dx)):
                rows += [(row + part).ravel(), (row + part).ravel()]
                columns += [nodes.ravel(), (nodes + total).ravel()]
                values += [of_u.ravel(), of_v.ravel()]
            area = hx * hy * wx * wy
            areas.append(area)
            for part, test in enumerate((1.0, sx - 0.5, sy - 0.5)):
                row = 3 * element[:, None] + part + 0 * nodes
                p_rows += [row.ravel(), row.ravel()]
                p_columns += [nodes.ravel(), (nodes + total).ravel()]
                p_values += [(area[:, None] * test * dx).ravel(), (area[:, None] * test * dy).ravel()]
    join = np.concatenate
    B = sparse.csr_matrix((join(values), (join(rows), join(columns))), shape=(27 * n * n, 2 * total))
    C = sparse.csr_matrix((join(p_values), (join(p_rows), join(p_columns))), shape=(3 * n * n, 2 * total))
    return line, B, np.stack(areas, 1).ravel(), C


def steady_flow(n, tau_0, mu, tolerance=1e-6, most=20000, relaxed=1.6):
    """Velocity in a unit cavity whose lid moves with speed 1, by the augmented Lagrangian."""
    line, B, area, C = system(n)
    m, total = line.size, line.size**2
    x, y = (a.ravel() for a in np.meshgrid(line, line, indexing="ij"))
    wall = (x == 0) | (x == 1) | (y == 0) | (y == 1)
    held = np.concatenate([wall, wall])
    v = np.zeros(2 * total)
    v[:total][(y == 1) & (x > 0) & (x < 1)] = 1.0  # at rest in the corners, so that nothing leaks there
    free = ~held
    W = sparse.diags(np.repeat(area, 3))
    r = 10 * mu + 2 * tau_0  # few iterations; any value gives the same flow
    A = (B.T @ W @ B) * (mu + r)
    Cf = C[1:][:, free]  # one pressure is free
    matrix = sparse.bmat([[A[free][:, free], -Cf.T], [-Cf, None]], format="csc")
    solve = splu(matrix).solve
    fixed_force, fixed_flow = A[free][:, held] @ v[held], C[1:][:, held] @ v[held]
    s, d = np.zeros(B.shape[0]), np.zeros(B.shape[0])
    for step in range(most):
        load = (B.T @ (W @ (r * d - s)))[free] - fixed_force
        v[free] = solve(np.concatenate([load, fixed_flow]))[: free.sum()]
        q = (B @ v).reshape(-1, 3)
        a = s.reshape(-1, 3) + r * (relaxed * q + (1 - relaxed) * d.reshape(-1, 3))
        size = np.linalg.norm(a, axis=1, keepdims=True)
        new = np.where(size > tau_0, (1 - tau_0 / np.maximum(size, 1e-300)) / r, 0) * a
        s = (a - r * new).ravel()
        gap = np.sqrt(np.sum(area[:, None] * (q - new) ** 2))
        move = np.sqrt(np.sum(area[:, None] * (new.ravel() - d).reshape(-1, 3) ** 2))
        d = new.ravel()
        if max(gap, move) < tolerance * np.sqrt(np.sum(area[:, None] * q**2)):
            break
    middle = v[:total].reshape(m, m)[m // 2]
    return line, middle, step + 1


def at(line, middle, y):
    """The quadratic of the element around y."""
    k = min(int(np.searchsorted(line[::2], y, side="right")) - 1, line[::2].size - 2)
    a, b = line[2 * k], line[2 * k + 2]
    return shape((y - a) / (b - a))[0] @ middle[2 * k : 2 * k + 3]


def vortex(line, middle):
    """Height where the velocity is 0, and the flow below it."""
    low, high = 0.5, 0.999
    for _ in range(60):
        half = 0.5 * (low + high)
        low, high = (half, high) if at(line, middle, half) < 0 else (low, half)
    ys = np.linspace(0, low, 4001)
    us = np.array([at(line, middle, y) for y in ys])
    return low, -np.sum(0.5 * (us[1:] + us[:-1]) * np.diff(ys))


def main():
    n = int(sys.argv[1]) if len(sys.argv) > 1 else 48
    setting = tomllib.loads((pathlib.Path(__file__).resolve().parent / "cavity.toml").read_text())
    L, U = setting["geometry"]["side"], setting["boundary"]["lid_speed"]
    for case in setting["material"]["case"]:
        line, middle, steps = steady_flow(n, case["yield_stress"], case["plastic_viscosity"] * U / L)
        height, flow = vortex(line, middle)
        for y in HEIGHTS:
            print(f"{case['name']},velocity_mm_per_s,{y * L:.4g},{1e3 * U * at(line, middle, y):.5g}")
        print(f"{case['name']},vortex_height_mm,0,{1e3 * L * height:.5g}")
        print(f"{case['name']},vortex_flow_mm2_per_s,0,{1e6 * U * L * flow:.5g}")
        print(f"{n} elements across, {steps} iterations", file=sys.stderr)


if __name__ == "__main__":
    main()
