"""Numbers of the cases from finished runs (`dgmpm_io.Run`)."""

import numpy as np


def track(run, name, column):
    """Times, s, and a column of `tracks/<name>.csv`, by its name without the unit."""
    table = run.table(f"tracks/{name}")
    full = next(key for key in table.dtype.names if key.split("_[")[0] == column)
    return table["t_[s]"], table[full]


def line(run, name, column, time=None):
    """A column of `lines/<name>.csv`, at the recorded time nearest to `time` (default: the last one)."""
    table = run.table(f"lines/{name}")
    times = table["t"]
    at = times[-1] if time is None else times[np.abs(times - time).argmin()]
    return table[column][times == at]


def ledger(run, column):
    """A column of the ledger."""
    return run.table("ledger")[column]


def frequency(t, u, guess):
    """w, rad/s, of the best a sin(w t) + b cos(w t) + c t + d within 10 % of a guess."""

    def rest(w):
        waves = np.stack([np.sin(w * t), np.cos(w * t), t / t[-1], np.ones_like(t)], axis=-1)
        return ((waves @ np.linalg.lstsq(waves, u, rcond=None)[0] - u) ** 2).sum()

    low, high = 0.9 * guess, 1.1 * guess
    while high - low > 1e-7 * guess:
        places = np.linspace(low, high, 9)
        best = np.argmin([rest(w) for w in places])
        low, high = places[max(best - 1, 0)], places[min(best + 1, 8)]
    return (low + high) / 2


def turn(t, u, k):
    """Time and value at the top of the parabola through three rows around row k."""
    t, u = t[k - 1 : k + 2], u[k - 1 : k + 2]
    c = np.polyfit(t - t[1], u, 2)
    move = -c[1] / (2 * c[0])
    return t[1] + move, np.polyval(c, move)


def lowest(run, name, column):
    """The smallest value of a column through time, between the rows."""
    t, u = track(run, name, column)
    return turn(t, u, np.argmin(u))[1]


def return_frequency(run, name, column, between):
    """1 over the time of the largest value within a span of time, of a body that starts at rest at its highest place."""
    t, u = track(run, name, column)
    rows = np.flatnonzero((t > between[0]) & (t < between[1]))
    return 1 / turn(t, u, rows[np.argmax(u[rows])])[0]


def mean_radius(run, group):
    """The mean distance from the origin, m, of a group of edges in the last snapshot."""
    snapshot = run.snapshots()[-1]
    mesh, (s, w) = snapshot.mesh, np.polynomial.legendre.leggauss(4)
    s, w, zero, one = (s + 1) / 2, w / 2, 0 * s, 0 * s + 1
    sides = [(zero, s), (one, s), (s, zero), (s, one)]
    edges = mesh.edges[mesh.edges[:, 2] == mesh.edge_groups.index(group)]
    radii = []
    for cell, side, _ in edges:
        xi = np.stack(sides[side], axis=-1)
        x = mesh.positions(xi)[cell] + snapshot.in_cells("displacement", xi)[cell]
        radii.append(np.linalg.norm(x, axis=-1) @ w)
    return np.mean(radii)


def return_error(run):
    """Relative L2 difference of the velocity between the first and the last snapshot."""
    first, last = run.snapshots()[0], run.snapshots()[-1]
    weight = first.masses[:, None]
    change = (weight * (last.field("velocity") - first.field("velocity")) ** 2).sum()
    return np.sqrt(change / (weight * first.field("velocity") ** 2).sum())


def order(coarse, fine):
    """The observed order of errors on cells of a size and of half of it."""
    return np.log2(coarse / fine)


def contact(t, force):
    """When the force first passes half of its median while it is there, and when it last does so: s."""
    half = np.median(force[force > 0.1 * force.max()]) / 2
    on = np.flatnonzero(force > half)
    first, last = on[0], on[-1]
    begin = np.interp(half, force[first - 1 : first + 1], t[first - 1 : first + 1])
    end = np.interp(-half, -force[last : last + 2], t[last : last + 2])
    return begin, end


def touching(run, name, column):
    """The time between the first and the last row with a force, s."""
    t, force = track(run, name, column)
    on = np.flatnonzero(force != 0)
    return t[on[-1]] - t[on[0]]


def rise(values):
    """How far values ever stand above the first one, as a share of it."""
    return max(values.max() / values[0] - 1, 0.0)
