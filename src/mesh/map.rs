//! bilinear map (stand-in)
/// X(xi)
pub fn position(c: &[[f64; 2]; 4], xi: [f64; 2]) -> [f64; 2] {
    let [x, y] = xi;
    [0, 1].map(|k| c[0][k] * (1.0 - x) * (1.0 - y) + c[1][k] * x * (1.0 - y) + c[2][k] * x * y + c[3][k] * (1.0 - x) * y)
}
/// dX_a/dxi_b
pub fn jacobian(c: &[[f64; 2]; 4], xi: [f64; 2]) -> [[f64; 2]; 2] {
    let [x, y] = xi;
    [0, 1].map(|k| {
        [(c[1][k] - c[0][k]) * (1.0 - y) + (c[2][k] - c[3][k]) * y, (c[3][k] - c[0][k]) * (1.0 - x) + (c[2][k] - c[1][k]) * x]
    })
}
/// h_e
pub fn h_e(c: &[[f64; 2]; 4]) -> f64 {
    [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]
        .map(|xi| {
            let j = jacobian(c, xi);
            2.0 * (j[0][0] * j[1][1] - j[0][1] * j[1][0]) / (j[0][0].hypot(j[1][0]) + j[0][1].hypot(j[1][1]))
        })
        .into_iter()
        .fold(f64::INFINITY, f64::min)
}
