"""Small geometry for many frames at once: vectors (n, 3), rotations (n, 3, 3), and a limb of two bones.

numpy's own cross product and norms are several times slower than these on a few hundred frames.
"""

from __future__ import annotations

import numpy as np

Array = np.ndarray


def dot(a: Array, b: Array) -> Array:
    """Return the dot products (...) of vectors (..., 3)."""
    return np.einsum("...i,...i->...", a, b)


def cross(a: Array, b: Array) -> Array:
    """Return the cross products (..., 3) of vectors (..., 3)."""
    out = np.empty(np.broadcast_shapes(a.shape, b.shape))
    ax, ay, az = a[..., 0], a[..., 1], a[..., 2]
    bx, by, bz = b[..., 0], b[..., 1], b[..., 2]
    out[..., 0] = ay * bz - az * by
    out[..., 1] = az * bx - ax * bz
    out[..., 2] = ax * by - ay * bx
    return out


def unit(a: Array) -> Array:
    """Return vectors (..., 3) divided by their lengths."""
    return a / np.sqrt(dot(a, a))[..., None]


def apply(rotation: Array, vector: Array) -> Array:
    """Return rotations (..., 3, 3) times vectors (..., 3)."""
    return np.einsum("...ij,...j->...i", rotation, vector)


def columns(x: Array, y: Array, z: Array) -> Array:
    """Return rotations (n, 3, 3) whose columns are the axes x, y, z (n, 3)."""
    out = np.empty((*x.shape, 3))
    out[..., 0], out[..., 1], out[..., 2] = x, y, z
    return out


def turn_yxz(y: Array | float, x: Array | float = 0.0, z: Array | float = 0.0) -> Array:
    """Return rotations (n, 3, 3) Ry Rx Rz, the order of the skeleton's hinges; angles (n,) or numbers [rad]."""
    cy, sy, cx, sx, cz, sz = np.cos(y), np.sin(y), np.cos(x), np.sin(x), np.cos(z), np.sin(z)
    out = np.empty((*np.broadcast_shapes(np.shape(y), np.shape(x), np.shape(z)), 3, 3))
    out[..., 0, 0] = cy * cz + sy * sx * sz
    out[..., 0, 1] = -cy * sz + sy * sx * cz
    out[..., 0, 2] = sy * cx
    out[..., 1, 0] = cx * sz
    out[..., 1, 1] = cx * cz
    out[..., 1, 2] = -sx
    out[..., 2, 0] = -sy * cz + cy * sx * sz
    out[..., 2, 1] = sy * sz + cy * sx * cz
    out[..., 2, 2] = cy * cx
    return out


def framed(forward: Array, up: Array) -> Array:
    """Return rotations (n, 3, 3) with x along `forward` (n, 3) and z as near to `up` (n, 3) as it can be."""
    x = unit(forward)
    y = unit(cross(up, x))
    return columns(x, y, cross(x, y))


def bend_at(upper: Array | float, lower: Array | float, distance: Array) -> Array:
    """Return the bend [rad], 0 when straight, of two bones of these lengths whose far ends are `distance` apart [m]."""
    cosine = (np.square(distance) - np.square(upper) - np.square(lower)) / (2.0 * upper * lower)
    return np.arccos(np.clip(cosine, -1.0, 1.0))


def distance_at(upper: float, lower: float, bend: Array | float) -> Array:
    """Return the distance [m] of the far ends of two bones bent by `bend` [rad]."""
    return np.sqrt(upper**2 + lower**2 + 2.0 * upper * lower * np.cos(bend))


def smoothstep(x: Array) -> Array:
    """Return 0 below 0, 1 above 1 and in between a rise whose slope and curvature vanish at both ends."""
    x = np.clip(x, 0.0, 1.0)
    return x * x * x * (10.0 + x * (6.0 * x - 15.0))


def soft_clip(x: Array, low: Array | float, high: Array | float, width: float) -> Array:
    """Return `x` held between `low` and `high`, turning from one to the other over about `width`; never past them."""
    for bound, sign in ((high, 1.0), (low, -1.0)):
        past = sign * (bound - x)  # how far inside of this bound
        x = bound - sign * 0.5 * (past + np.sqrt(past * past + width * width))
    return np.clip(x, low, high)
