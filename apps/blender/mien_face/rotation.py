"""Rotations as quaternions (w, x, y, z), without Blender."""

import math

IDENTITY = (1.0, 0.0, 0.0, 0.0)


def product(a, b):
    """Rotates by b, then by a."""
    aw, ax, ay, az = a
    bw, bx, by, bz = b
    return (
        aw * bw - ax * bx - ay * by - az * bz,
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
    )


def inverse(q):
    w, x, y, z = q
    return (w, -x, -y, -z)


def of_angles(pitch, yaw, roll):
    """R = Ry(yaw) Rx(pitch) Rz(roll) in radians, in mien's axes: x to the subject's left, y up, z out of the face."""
    about_y = (math.cos(yaw / 2), 0.0, math.sin(yaw / 2), 0.0)
    about_x = (math.cos(pitch / 2), math.sin(pitch / 2), 0.0, 0.0)
    about_z = (math.cos(roll / 2), 0.0, 0.0, math.sin(roll / 2))
    return product(product(about_y, about_x), about_z)


def scaled(q, factor):
    """The same axis, `factor` times the angle."""
    w, x, y, z = q if q[0] >= 0.0 else tuple(-part for part in q)
    length = math.sqrt(x * x + y * y + z * z)
    if length == 0.0 or factor == 1.0:
        return (w, x, y, z)
    half = math.atan2(length, w) * factor
    along = math.sin(half) / length
    return (math.cos(half), x * along, y * along, z * along)


def nearer(q, previous):
    """q or -q, the same rotation, whichever is nearer to `previous`."""
    opposite = sum(a * b for a, b in zip(q, previous)) < 0.0
    return tuple(-part for part in q) if opposite else q


# Where a character's left, up and front (mien's x, y, z) lie in its space: an axis of Blender and a sign for each.
AXES = {
    "-Y": ((0, 1), (2, 1), (1, -1)),
    "Y": ((0, -1), (2, 1), (1, 1)),
    "X": ((1, 1), (2, 1), (0, 1)),
    "-X": ((1, -1), (2, 1), (0, -1)),
    "Z": ((0, 1), (1, 1), (2, 1)),
}


def to_space(q, front):
    """Converts a rotation from the axes of mien to those of a character that faces `front`, a key of AXES."""
    turned = [0.0, 0.0, 0.0]
    for part, (axis, sign) in zip(q[1:], AXES[front]):
        turned[axis] = sign * part
    return (q[0], *turned)


def of_bone(q, rest):
    """A rotation about the axes of the armature as one of a bone's own axes, whose rest orientation is `rest`."""
    return product(product(inverse(rest), q), rest)
