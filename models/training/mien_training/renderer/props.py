"""Simple solids: the body below the bust, and things held in front of the face."""
import numpy as np

# Rings from the bust's edge down: scale, remaining share of its variation in height, drop in cm.
SHOULDERS = [(1.0, 1.0, 0.0), (1.12, 1.0, -1.0), (1.35, 0.8, -3.5), (1.55, 0.5, -8.0), (1.6, 0.0, -45.0)]
ROUND = 14  # corners of a circle


def rim(corners, vertices):
    """Vertices of the open edge of triangles [n,3], in order around the vertical."""
    edges = np.vstack([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]]).astype(np.int64)
    _, first, uses = np.unique(np.sort(edges, 1) @ [1, 1 << 20], return_index=True, return_counts=True)
    ids = np.unique(edges[first[uses == 1]])
    return ids[np.argsort(np.arctan2(vertices[ids, 0], vertices[ids, 2]))]


def strips(rings, around):
    """Triangles [.,3] between consecutive rings of `around` vertices."""
    k = np.arange(around)
    quads = [np.stack([r * around + k,
                       r * around + (k + 1) % around, (r + 1) * around + k, (r + 1) * around + (k + 1) % around], 1)
             for r in range(rings - 1)]
    q = np.concatenate(quads)
    return np.ascontiguousarray(np.concatenate([q[:, [0, 2, 1]], q[:, [1, 2, 3]]]), np.int32)


def body(edge):
    """Shoulders under the bust's edge [n,3]: vertices."""
    centre = edge.mean(0)
    return np.concatenate([(edge - centre) * [scale, keep, scale] + centre + [0, drop, 0]
                           for scale, keep, drop in SHOULDERS]).astype(np.float32)


def capsule(start, end, radius, end_radius=None):
    """A rod with round ends: vertices and triangles."""
    end_radius = radius if end_radius is None else end_radius
    axis = (end - start) / (np.linalg.norm(end - start) + 1e-9)
    side = np.cross(axis, [0.3, 0.9, 0.2])
    side /= np.linalg.norm(side)
    up = np.cross(axis, side)
    angle = 2 * np.pi * np.arange(ROUND) / ROUND
    circle = np.cos(angle)[:, None] * side + np.sin(angle)[:, None] * up
    cap = np.linspace(0.05, np.pi / 2, 5)
    rings = [start - axis * radius * np.cos(a) + circle * radius * np.sin(a) for a in cap]
    rings += [end + axis * end_radius * np.cos(a) + circle * end_radius * np.sin(a) for a in cap[::-1]]
    return np.concatenate(rings), strips(len(rings), ROUND)


def join(solids):
    shift = np.cumsum([0] + [len(v) for v, _ in solids])
    vertices = np.concatenate([v for v, _ in solids])
    return np.float32(vertices), np.ascontiguousarray(np.concatenate([t + s for (_, t), s in zip(solids, shift)]),
                                                      np.int32)


def random_rotation(rng):
    q, r = np.linalg.qr(rng.normal(size=(3, 3)))
    q *= np.sign(np.diag(r))
    return q * np.linalg.det(q)


def hand(rng):
    """Palm, four fingers and a thumb, about 18 cm; bent a little."""
    solids = [capsule(np.array([-2.5, -8.0, 0]), np.array([-2.0, -1, 0]), 2.0),
              capsule(np.array([2.5, -8.0, 0]), np.array([2.0, -1, 0]), 2.0),
              capsule(np.array([0, -9.0, 0]), np.array([0, -16.0, 0]), 3.0)]
    spread, bend = rng.uniform(0.6, 1.6), rng.normal(0, 1.2)
    for k in range(4):
        base = np.array([(k - 1.5) * 1.9, 0, 0])
        knee = base + [(k - 1.5) * 0.4 * spread, rng.uniform(3, 4.5), bend * 0.5]
        tip = knee + [(k - 1.5) * 0.3 * spread, rng.uniform(1.5, 4), bend * rng.uniform(0.5, 2)]
        solids += [capsule(base, knee, 0.95, 0.85), capsule(knee, tip, 0.85, 0.7)]
    thumb = np.array([3.2, -6.0, 0.5])
    solids.append(capsule(thumb, thumb + [3.0, 4.5, rng.uniform(0, 2)], 1.1, 0.9))
    return join(solids)


def microphone(rng):
    length = rng.uniform(10, 25)
    return join([capsule(np.zeros(3), np.array([0, 0.5, 0]), rng.uniform(1.8, 3.5)),
                 capsule(np.array([0, -1.0, 0]), np.array([0, -length, 0]), rng.uniform(0.8, 1.6))])


def card(rng):
    """A flat polygon: paper, a phone, a plate."""
    count = rng.integers(3, 7)
    angle = np.sort(rng.uniform(0, 2 * np.pi, count)) if rng.random() < 0.5 else 2 * np.pi * np.arange(count) / count
    ring = np.stack([np.cos(angle) * rng.uniform(2, 8), np.sin(angle) * rng.uniform(2, 8), np.zeros(count)], 1)
    fan = [[0, k, k + 1] for k in range(1, count - 1)]
    return np.float32(ring), np.ascontiguousarray(fan, np.int32)


def blob(rng):
    vertices, triangles = capsule(np.array([0, -0.1, 0]), np.array([0, 0.1, 0]), rng.uniform(1.5, 5))
    return np.float32(vertices * rng.uniform(0.5, 1.5, 3)), triangles


def sample_occluder(rng, skin_colour):
    """(vertices around their own centre, triangles, linear colour [3])."""
    kind = rng.choice(["hand", "hand", "microphone", "card", "blob"])
    vertices, triangles = {"hand": hand, "microphone": microphone, "card": card, "blob": blob}[kind](rng)
    if kind == "hand" or (kind == "blob" and rng.random() < 0.5):
        colour = skin_colour * np.exp(rng.normal(0, 0.15))
    else:
        colour = rng.uniform(0.01, 0.8) * np.exp(rng.normal(0, 0.6, 3))
    if kind in ("hand", "microphone"):
        lean = rng.uniform(-1.2, 1.2)
        c, s = np.cos(lean), np.sin(lean)
        turn = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
    else:
        turn = random_rotation(rng)
    return np.float32(vertices @ turn.T), triangles, np.clip(colour, 0, 0.9)
