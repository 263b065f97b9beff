"""Exact solutions of the cases, stated apart from the program. SI units."""

from functools import lru_cache

import numpy as np

#: The Rayleigh wave of rayleigh.toml: speed, m/s.
RAYLEIGH_SPEED = 2912.42041


def rayleigh_surface(x):
    """v1, v2 at the surface, m/s, whenever a whole number of periods is over."""
    rate = 2 * np.pi * RAYLEIGH_SPEED * 1e-5
    ratio = 5.4568253 / (2 * np.pi)
    return -rate * (1 - 0.5699528) * np.cos(2 * np.pi * x), -rate * ratio * (1 - 1.7545312) * np.sin(2 * np.pi * x)


def freund(time):
    """K, Pa sqrt(m), of crack.toml at a time: 2 s/(1 - nu) sqrt(c (t - t_c)(1 - 2 nu)/pi)."""
    young, nu, density, load = 2.1e11, 0.3, 8000.0, 5e8
    c = np.sqrt(young * (1 - nu) / (density * (1 + nu) * (1 - 2 * nu)))
    return 2 * load / (1 - nu) * np.sqrt(c * (time - 2 / c) * (1 - 2 * nu) / np.pi)


def opening_intensity(r, opening, reach):
    """K, Pa sqrt(m), from the opening, m, at distances r, m, behind the tip of crack.toml.

    E/(8 (1 - nu^2)) opening sqrt(2 pi/r) tends to K at the tip; the straight line through its values for r in `reach`
    gives K at r = 0.
    """
    young, nu = 2.1e11, 0.3
    apparent = young / (8 * (1 - nu**2)) * opening * np.sqrt(2 * np.pi / r)
    inside = (r > reach[0]) & (r < reach[1])
    return np.polyfit(r[inside], apparent[inside], 1)[1]


@lru_cache
def lamb_waves(x):
    """Times, and u1, u2, m, at the surface of lamb.toml, at a distance x from the middle of the force.

    For a traction q(k, s) along y on the surface of the half-plane y < 0, transformed along x (k) and in time (Laplace's
    s): u2 = q a ks^2/(mu R), u1 = i k q (2 k^2 + ks^2 - 2 a b)/(mu R), with a^2 = k^2 + s^2/c_P^2, b^2 = k^2 + ks^2,
    ks = s/c_S, R = (2 k^2 + ks^2)^2 - 4 k^2 a b, for waves exp(i k x). Both transforms are inverted by sums: with 4 as the
    real part of s (1/s) the pole of Rayleigh's wave does not lie on the path.
    """
    c_p, c_s, density = 3200.0, 1847.5, 2200.0
    mu, damping, span, length = density * c_s**2, 4.0, 4.0, 24000.0
    t = np.arange(4096) * span / 4096
    a = 2075.0843 * (t - 0.08) ** 2
    force = -1e6 * (1 - 2 * a) * np.exp(-a)
    spectrum = np.fft.rfft(force * np.exp(-damping * t))
    k = 2 * np.pi * np.arange(8192) / length
    share = 2 / length * 40 * np.sqrt(np.pi) * np.exp(-((40 * k) ** 2) / 4)
    share[0] /= 2
    answer = np.zeros((2, len(spectrum)), complex)
    for n in range(int(70 * span)):  # the spectrum ends well below 70 Hz
        s = damping + 2j * np.pi * n / span
        shear = (s / c_s) ** 2
        p_root, s_root = np.sqrt(k**2 + (s / c_p) ** 2), np.sqrt(k**2 + shear)
        rayleigh = mu * ((2 * k**2 + shear) ** 2 - 4 * k**2 * p_root * s_root)
        answer[0, n] = -(share * k * (2 * k**2 + shear - 2 * p_root * s_root) / rayleigh) @ np.sin(k * x)
        answer[1, n] = (share * p_root * shear / rayleigh) @ np.cos(k * x)
    return t, np.fft.irfft(answer * spectrum, 4096) * np.exp(damping * t)


def lamb(x, component, times):
    """u1 or u2, m, of `lamb_waves` at times."""
    t, waves = lamb_waves(x)
    return np.interp(times, t, waves[component - 1])
