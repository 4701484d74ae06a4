"""Rotations and quaternions, batched over leading axes.

Quaternions are (w, x, y, z) as in MuJoCo and Blender. Rotation matrices map coordinates of the named inner frame
to the outer one (`world_from_ski @ vector_in_ski`).
"""

from __future__ import annotations

import numpy as np

Array = np.ndarray


def rotation_about(axis: str, angle: Array | float) -> Array:
    """Return right-handed rotations (..., 3, 3) about the coordinate axis "x", "y" or "z" by `angle` (...) [rad]."""
    angle = np.array(angle, dtype=float, order="C")  # contiguous: see `components`
    c, s = np.cos(angle), np.sin(angle)
    first, second = {"x": (1, 2), "y": (2, 0), "z": (0, 1)}[axis]
    out = np.zeros((*angle.shape, 3, 3))
    out[..., range(3), range(3)] = 1.0
    out[..., first, first] = c
    out[..., second, second] = c
    out[..., first, second] = -s
    out[..., second, first] = s
    return out


def components(vector: Array) -> Array:
    """Return the components of `vector` (..., k) as contiguous arrays (k, ...).

    numpy computes sines and arc tangents of strided views by one of two routines that differ in the last bit, chosen
    by where in memory the arrays happen to lie. Contiguous arguments keep results the same from run to run. They are
    copies: a view of a single vector counts as contiguous whatever its stride, and still makes numpy choose.
    """
    return np.array(np.moveaxis(np.asarray(vector, dtype=float), -1, 0), order="C")


def cross(a: Array, b: Array) -> Array:
    """Return the cross products (3, ...) of vectors by their components (3, ...)."""
    return np.stack((a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]))


def affine_inverse(matrix: Array) -> Array:
    """Return the inverses (n, 4, 4) of affine maps (n, 4, 4); numpy's own takes many times longer for small ones.

    For columns x, y, z the rows of the inverse are y cross z, z cross x and x cross y over the volume of the three.
    """
    x, y, z, place = np.ascontiguousarray(np.moveaxis(matrix[:, :3], 0, -1)).transpose(1, 0, 2)  # columns, (3, n) each
    rows = np.stack((cross(y, z), cross(z, x), cross(x, y)))
    rows /= np.sum(rows[0] * x, axis=0)
    out = np.zeros_like(matrix)
    out[:, :3, :3] = rows.transpose(2, 0, 1)
    out[:, :3, 3] = -np.sum(rows * place, axis=1).T
    out[:, 3, 3] = 1.0
    return out


def matrix_from_columns(x: Array, y: Array, z: Array) -> Array:
    """Stack three axes (..., 3) as the columns of a rotation matrix (..., 3, 3)."""
    return np.stack((x, y, z), axis=-1)


def normalized(vector: Array) -> Array:
    """Return `vector` (..., 3) divided by its length."""
    return vector / np.linalg.norm(vector, axis=-1, keepdims=True)


def quaternion_multiply(a: Array, b: Array) -> Array:
    """Return the Hamilton product a b of quaternions (..., 4)."""
    aw, ax, ay, az = np.moveaxis(np.asarray(a), -1, 0)
    bw, bx, by, bz = np.moveaxis(np.asarray(b), -1, 0)
    return np.stack(
        (
            aw * bw - ax * bx - ay * by - az * bz,
            aw * bx + ax * bw + ay * bz - az * by,
            aw * by - ax * bz + ay * bw + az * bx,
            aw * bz + ax * by - ay * bx + az * bw,
        ),
        axis=-1,
    )


def quaternion_conjugate(q: Array) -> Array:
    """Return the inverse of unit quaternions (..., 4)."""
    return np.asarray(q) * np.array([1.0, -1.0, -1.0, -1.0])


def matrix_from_quaternion(q: Array) -> Array:
    """Return rotation matrices (..., 3, 3) of unit quaternions (..., 4)."""
    w, x, y, z = np.moveaxis(np.asarray(q, dtype=float), -1, 0)
    rows = (
        (1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
        (2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)),
        (2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)),
    )
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)


def quaternion_from_matrix(matrix: Array) -> Array:
    """Return unit quaternions (..., 4) of rotation matrices (..., 3, 3), from the largest of the four squares."""
    m = np.asarray(matrix, dtype=float)
    parts = np.ascontiguousarray(np.moveaxis(m.reshape(-1, 9), 0, -1))  # (9, n)
    xx, yy, zz = parts[0], parts[4], parts[8]
    largest = np.argmax(np.stack((xx + yy + zz, xx, yy, zz)), axis=0)
    out = np.empty((4, len(largest)))
    for part in range(4):
        where = largest == part
        if where.all():
            out[:] = _quaternion_times(part, parts)
        elif where.any():
            out[:, where] = _quaternion_times(part, parts[:, where])
    out /= np.sqrt(np.sum(out * out, axis=0))
    return np.ascontiguousarray(out.T).reshape(*m.shape[:-2], 4)


def _quaternion_times(part: int, matrix: Array) -> tuple[Array, Array, Array, Array]:
    """Return quaternions of matrices (9, n) times four times their own `part` number 0..3, which is not zero."""
    xx, xy, xz, yx, yy, yz, zx, zy, zz = matrix
    if part == 0:
        return 1 + (xx + yy + zz), zy - yz, xz - zx, yx - xy
    if part == 1:
        return zy - yz, 1 + xx - yy - zz, xy + yx, xz + zx
    if part == 2:
        return xz - zx, xy + yx, 1 + yy - xx - zz, yz + zy
    return yx - xy, xz + zx, yz + zy, 1 + zz - xx - yy


def continuous_quaternions(q: Array) -> Array:
    """Flip signs along the first axis of `q` (n, ..., 4) so that neighbours lie in one hemisphere."""
    q = np.array(q, dtype=float)
    sign = np.sign(np.sum(q[1:] * q[:-1], axis=-1))
    sign[sign == 0] = 1.0
    q[1:] *= np.cumprod(sign, axis=0)[..., None]
    return q


def rotate(q: Array, vector: Array) -> Array:
    """Rotate vectors (..., 3) by unit quaternions (..., 4)."""
    return np.einsum("...ij,...j->...i", matrix_from_quaternion(q), np.asarray(vector, dtype=float))


def mirror_vector(vector: Array) -> Array:
    """Mirror vectors (..., 3) in the xz plane: left becomes right."""
    return np.asarray(vector) * np.array([1.0, -1.0, 1.0])


def mirror_quaternion(q: Array) -> Array:
    """Mirror rotations (..., 4) in the xz plane: rotations about x and z change sign."""
    return np.asarray(q) * np.array([1.0, -1.0, 1.0, -1.0])
