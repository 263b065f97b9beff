//! What each effect is, as a formula in one line.

/// Table, name and formula. `n` is the outward normal in X, t = P n, `z_p` the impedance rho0 c_p, theta as in `docs/method.md`; a star is
/// what the flux has. An entry of the registry may have none.
const FORMULAS: &[(&str, &str, &str)] = &[
    (
        "[[boundary]]",
        "wall",
        "v*.n = v_w, t*.n = t.n - z_p (v.n - v_w), no tangential traction: t*.T = 0, v*.T = v.T - theta t.T / z_p",
    ),
    ("[[boundary]]", "symmetry", "a wall with v_w = 0"),
    ("[[boundary]]", "free", "t* = 0, v* = v - Z^-1 t"),
    ("[[boundary]]", "clamped", "v* = 0, t* = t - z_p v"),
    ("[[boundary]]", "velocity", "v* = v_d(X, t), t* = t + z_p (v_d - v)"),
    ("[[boundary]]", "traction", "t* = t_d(X, t), v* = v + theta (t_d - t) / z_p"),
    ("[[boundary]]", "absorbing", "v* = (v - Z^-1 t) / 2, t* = (t - Z v) / 2"),
    (
        "[[boundary]]",
        "unilateral",
        "the wall where it is touched and pressed, else free; Coulomb: |t_s| <= mu |t_n|; dg/dt = v_w - v*.n",
    ),
    ("[[boundary]]", "half-plane", "unilateral contact with the obstacle at x = X + u, along its normal"),
    ("[[boundary]]", "disc", "unilateral contact with the obstacle at x = X + u, along its normal"),
    ("[[boundary]]", "polygon", "unilateral contact with the obstacle at x = X + u, along its normal"),
    ("[[boundary]]", "pressure", "t* = -p(X, t) cof(F) n"),
    ("[[boundary]]", "foundation", "t* = -k u - c v"),
    (
        "[[boundary]]",
        "contact",
        "t_n = min(0, t*_n + max(0, gap)/(y dt)) + k min(0, gap), |t_s| <= mu |t_n|, y = 1/z_1 + 1/z_2",
    ),
    ("[[boundary]]", "cohesive", "t = (1 - d) K w up to the strength, then a line to 0; the area is the energy"),
    ("[[boundary]]", "periodic", "the flux between the cells of both groups"),
    ("[[source]]", "body-force", "dp/dt += rho0 b(X, t)"),
    ("[[source]]", "gravity", "dp/dt += rho0 b, b constant"),
    ("[[source]]", "damping", "dp/dt += -alpha p"),
    ("[[source]]", "sponge", "dp/dt += -alpha s(X) p, s from 0 to 1"),
    ("[[source]]", "pressure-pulse", "dp/dt += -grad p(X, t)"),
    ("[curl]", "rotation", "F <- exp(-theta_r r E) F, then F <- F - theta_d (D - mean D)"),
    ("[curl]", "lcf", "F <- F - theta (F - Pi F), Pi F the nearest gradient of the cell"),
    (
        "[limiter]",
        "moment",
        "the highest moments of a cell at a front are cut to the differences of the means of its neighbours",
    ),
    (
        "[limiter]",
        "vertex",
        "F, p <- mean + alpha (F, p - mean), alpha so that corners stay among the means around them",
    ),
    ("[scheme]", "angular_momentum", "p <- p + rho0 omega E (x - x_c), one omega a body"),
    ("[scheme]", "springs", "v* = mean v + Y ([t] - k R a), da/dt = R^T Y ([t] - 1.03 k R a), k = beta M / l"),
    ("[[output]]", "fields", "F, p, u and internal variables as they are"),
    ("[[output]]", "line", "the polynomials at X_i = from + i (to - from) / (samples - 1)"),
    ("[[output]]", "ledger", "E(t) = E(0) + works - dissipations, each as the step has it"),
    ("[[output]]", "probe", "x = X + u(X, t), and fields at X"),
    (
        "[[output]]",
        "force",
        "impulse = int t* dS dt, work = int t*.v* dS dt, force = impulse since the row before over the time",
    ),
    ("[[output]]", "extreme", "min and max of q over nodes, faces and corners of cells"),
    ("[[output]]", "length", "|x(B) - x(A)|, or max x_k - min x_k; x = X + u"),
    (
        "[[output]]",
        "energy",
        "int |p|^2 / (2 rho0) dX, int W dX and what laws have dissipated, over the cells of a material",
    ),
    ("[[quantity]]", "value", "q(X)"),
    ("[[quantity]]", "peak", "max or min of q over nodes, faces and corners of cells"),
    ("[[quantity]]", "extent", "max x_k - min x_k over the boundary, x = X + u"),
    ("[[quantity]]", "length", "|x(B) - x(A)|, x = X + u"),
    ("[[quantity]]", "force", "int t*_k dS; its mean over the run is the impulse over the time"),
    ("[[quantity]]", "energy", "int |p|^2 / (2 rho0) dX, int W dX, or what laws have dissipated"),
    ("[[quantity]]", "front-width", "the distance between 10 % and 90 % of the jump"),
    ("[[quantity]]", "overshoot", "max(q - high, low - q, 0) / (high - low)"),
];

/// The formula of an entry of a table of the scene; none where none is written down.
pub fn formula(table: &str, name: &str) -> Option<&'static str> {
    FORMULAS.iter().find(|(of, known, _)| *of == table && *known == name).map(|(_, _, formula)| *formula)
}

/// Table and name of each formula.
#[cfg(test)]
pub fn all() -> impl Iterator<Item = (&'static str, &'static str)> {
    FORMULAS.iter().map(|(table, name, _)| (*table, *name))
}
