"""Places the 175 landmarks on the rig; writes models/landmarks.json and rig_landmarks.npz.

The mean 3-D shape of the teacher's points over neutral frontal portraits is aligned with the neutral rig by the 68
landmarks that both have (similarity, then thin-plate spline). Points of eyelids and lips move to the rig's contours, at
the teacher's share of the distance between known corners; other points move to the nearest place of the skin.
"""
import json

import numpy as np
from scipy.interpolate import RBFInterpolator
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import dijkstra
from scipy.spatial import cKDTree

from mien_training.data import landmark_points as lp
from mien_training.paths import ROOT, data

TEMPLATE_HEIGHT = 0.80
PUPIL, LIMBUS = (0.08, 0.1), (0.36, 0.4)  # rings of vertices by their distance from the middle of the iris image
CM_PER_M = 100.0
# of the spline, cm: the jaw line's 68-landmark vertices are a choice of contour, not quite the same points
SMOOTHING = 1.0


def portraits():
    """Teacher points in pixels [n,478,3] (y down, z towards the viewer negative) and blendshapes by name."""
    labels = np.load(data() / "faces/labels.npz")
    width, height = labels["size_wh"].astype(float).T
    points = labels["landmarks"].astype(float) * np.stack([width, height, width], 1)[:, None]
    names = [str(name) for name in labels["blendshape_names"]]
    return points, dict(zip(names, labels["blendshapes"].astype(float).T)), labels["matrix_colmajor"]


def similarity(source, target):
    """Scale, rotation, shift of the least-squares similarity source -> target (Umeyama 1991)."""
    a, b = source - source.mean(0), target - target.mean(0)
    u, s, vt = np.linalg.svd(b.T @ a)
    sign = np.diag([1.0] * (source.shape[1] - 1) + [np.linalg.det(u @ vt)])
    rotation = u @ sign @ vt
    scale = np.trace(np.diag(s) @ sign) / (a ** 2).sum()
    return scale, rotation, target.mean(0) - scale * rotation @ source.mean(0)


def apply(transform, points):
    scale, rotation, shift = transform
    return scale * points @ rotation.T + shift


def mean_shape(shapes, rounds=5):
    """Generalised Procrustes mean of [n,p,d]."""
    mean = shapes[0]
    for _ in range(rounds):
        mean = np.mean([apply(similarity(s, mean), s) for s in shapes], 0)
    return mean


def quiet_frontal():
    points, shapes, matrix = portraits()
    forward = matrix.reshape(-1, 4, 4)[:, 2, :3]  # column-major: the head's z axis in camera space
    frontal = (np.abs(forward[:, 0]) < 0.12) & (np.abs(forward[:, 1]) < 0.2)
    quiet = (shapes["jawOpen"] < 0.03) & (shapes["eyeBlinkLeft"] < 0.25) & (shapes["mouthSmileLeft"] < 0.4) & \
            (shapes["mouthPucker"] < 0.4)
    return points[frontal], points[frontal & quiet]


def template(frontal):
    """Mean frontal shape in crop coordinates, its own mirror image."""
    mean = mean_shape(frontal[:, lp.TEACHER, :2])
    roll = np.arctan2(*(mean[lp.OUTER_EYE_CORNERS[1]] - mean[lp.OUTER_EYE_CORNERS[0]])[::-1])
    mean = mean @ np.array([[np.cos(roll), -np.sin(roll)], [np.sin(roll), np.cos(roll)]])
    middle = (mean.min(0) + mean.max(0)) / 2
    mean = (mean - middle) * TEMPLATE_HEIGHT / np.ptp(mean[:, 1])
    mean = (mean + mean[lp.MIRROR] * [-1, 1]) / 2
    return mean - (mean.min(0) + mean.max(0)) / 2 + 0.5


class RigSurface:
    def __init__(self):
        rig = np.load(data() / "rig/rig.npz")
        self.vertices, self.ibug = rig["v0"].astype(float), rig["landmarks68"]
        ranges = {str(n): tuple(r) for n, r in zip(rig["mat_names"], rig["mat_range"])}
        self.uv_vertices, self.uv = rig["gpu_pos"].astype(int), rig["gpu_uv"].astype(float)
        begin, end = ranges["M_Face"]
        self.skin = rig["f"][begin:end]
        self.regions = {str(n): tuple(r) for n, r in zip(rig["region_names"], rig["region_range"])}
        edges = np.vstack([self.skin[:, [0, 1]], self.skin[:, [1, 2]], self.skin[:, [2, 0]]])
        length = np.linalg.norm(self.vertices[edges[:, 0]] - self.vertices[edges[:, 1]], axis=1)
        n = len(self.vertices)
        self.graph = coo_matrix((length, edges.T), (n, n)).tocsr()

    def iris(self, side):
        """Vertices of an iris and their offsets [n,2] from the middle of its image."""
        begin, end = self.regions[f"iris_{side}"]
        mine = (self.uv_vertices >= begin) & (self.uv_vertices < end)
        return self.uv_vertices[mine], self.uv[mine] - 0.5

    def nearest(self, points):
        """Closest point of the outer skin: triangle vertices [n,3] and barycentric weights [n,3]."""
        a, b, c = (self.vertices[self.skin[:, k]] for k in range(3))
        normal = np.cross(b - a, c - a)
        outer = normal[:, 2] > -0.2 * np.linalg.norm(normal, axis=1)
        corners, weights = [], []
        candidates = np.flatnonzero(outer)
        tree = cKDTree((a + b + c)[candidates] / 3)
        for p in points:
            near = candidates[tree.query(p, 40)[1]]
            w = barycentric(p, a[near], b[near], c[near])
            gap = np.linalg.norm(w[:, :1] * a[near] + w[:, 1:2] * b[near] + w[:, 2:] * c[near] - p, axis=1)
            best = gap.argmin()
            corners.append(self.skin[near[best]])
            weights.append(w[best])
        return np.array(corners), np.array(weights)

    def path(self, first, last):
        """Shortest way along the skin's edges, vertex ids."""
        _, previous = dijkstra(self.graph, directed=False, indices=first, return_predecessors=True)
        way = [last]
        while way[-1] != first:
            way.append(previous[way[-1]])
        return way[::-1]

    def contour(self, first, last):
        """Way along the skin's edges between two iBUG points, through the waypoint between them if there is one."""
        begin, end = self.ibug[first], self.ibug[last]
        if (first, last) not in WAYPOINTS:
            return self.path(begin, end)
        middle = self.ibug[WAYPOINTS[first, last]]
        return self.path(begin, middle) + self.path(middle, end)[1:]


def barycentric(p, a, b, c):
    """Weights of the triangles' points closest to p (clamped to the triangle)."""
    u, v, w = b - a, c - a, p - a
    uu, uv, vv, wu, wv = ((x * y).sum(1) for x, y in ((u, u), (u, v), (v, v), (w, u), (w, v)))
    det = np.maximum(uu * vv - uv * uv, 1e-12)
    s, t = (vv * wu - uv * wv) / det, (uu * wv - uv * wu) / det
    weights = np.clip(np.stack([1 - s - t, s, t], 1), 0, None)
    return weights / weights.sum(1, keepdims=True)


# Contours whose known corners (iBUG numbers) the rig has too: (teacher curve, {position in it: iBUG number}).
# The teacher lacks four points of the outer lips; the rig's contour passes through them.
WAYPOINTS = {(48, 50): 49, (52, 54): 53, (48, 58): 59, (56, 54): 55}
CONTOURS = [
    ([33, 246, 161, 160, 159, 158, 157, 173, 133], {0: 36, 3: 37, 5: 38, 8: 39}),
    ([33, 7, 163, 144, 145, 153, 154, 155, 133], {0: 36, 3: 41, 5: 40, 8: 39}),
    ([263, 466, 388, 387, 386, 385, 384, 398, 362], {0: 45, 3: 44, 5: 43, 8: 42}),
    ([263, 249, 390, 373, 374, 380, 381, 382, 362], {0: 45, 3: 46, 5: 47, 8: 42}),
    (lp.LIPS_OUTER_UPPER, {0: 48, 4: 50, 5: 51, 6: 52, 10: 54}),
    ([61] + lp.LIPS_OUTER_LOWER + [291], {0: 48, 4: 58, 5: 57, 6: 56, 10: 54}),
    (lp.LIPS_INNER_UPPER, {0: 60, 4: 61, 5: 62, 6: 63, 10: 64}),
    ([78] + lp.LIPS_INNER_LOWER + [308], {0: 60, 4: 67, 5: 66, 6: 65, 10: 64}),
]


def on_contours(surface, teacher3d):
    """Teacher index -> (vertices [3], weights [3]) for the points of lids and lips."""
    placed = {}
    for curve, known in CONTOURS:
        steps = np.linalg.norm(np.diff(teacher3d[curve], axis=0), axis=1)
        arc = np.concatenate([[0], np.cumsum(steps)])
        stops = sorted(known)
        for first, last in zip(stops, stops[1:]):
            way = surface.contour(known[first], known[last])
            points = surface.vertices[way]
            length = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
            for i in range(first, last + 1):
                at = (arc[i] - arc[first]) / (arc[last] - arc[first]) * length[-1]
                k = int(np.clip(np.searchsorted(length, at) - 1, 0, len(way) - 2))
                share = np.clip((at - length[k]) / (length[k + 1] - length[k]), 0, 1)
                placed[curve[i]] = ([way[k], way[k + 1], way[k + 1]], [1 - share, share, 0.0])
    return placed


def on_irises(surface):
    """Centre of each pupil and the four ends of its iris, as teacher points 468-477 lie."""
    placed = {}
    for side, indices in (("right", lp.IRIS[0]), ("left", lp.IRIS[1])):
        vertices, offset = surface.iris(side)  # u of the texture runs to the subject's left on both eyes, v up
        radius = np.linalg.norm(offset, axis=1)
        nasal = 0.0 if side == "right" else np.pi
        towards = lambda low, high, angle: vertices[np.where((radius > low) & (radius < high), offset @ [
            np.cos(angle), np.sin(angle)], -1).argmax()]
        placed[indices[0]] = ([towards(*PUPIL, angle) for angle in (0, 2 * np.pi / 3, 4 * np.pi / 3)], [1 / 3] * 3)
        for index, angle in zip(indices[1:], (nasal, np.pi / 2, np.pi - nasal, -np.pi / 2)):
            placed[index] = ([towards(*LIMBUS, angle)] * 3, [1.0, 0.0, 0.0])
    return placed


def place(surface, mean):
    """Vertices [175,3] and weights [175,3] on the rig."""
    upright = mean * [1, -1, -1]  # x right (the subject's left), y up, z towards the viewer
    upright = apply(similarity(upright[lp.IBUG68], surface.vertices[surface.ibug]), upright)
    warp = RBFInterpolator(upright[lp.IBUG68], surface.vertices[surface.ibug], kernel="thin_plate_spline",
                           smoothing=SMOOTHING)
    warped = warp(upright)
    placed = {**on_contours(surface, upright), **on_irises(surface)}
    others = [k for k in lp.TEACHER if k not in placed]
    corners, weights = surface.nearest(warped[others])
    placed.update({k: (c, w) for k, c, w in zip(others, corners, weights)})
    return (np.array([placed[k][0] for k in lp.TEACHER], np.int32),
            np.array([placed[k][1] for k in lp.TEACHER], np.float32))


def main():
    frontal, quiet = quiet_frontal()
    shape = template(frontal)
    surface = RigSurface()
    vertices, weights = place(surface, mean_shape(quiet))
    np.savez(ROOT / "models/training/mien_training/data/rig_landmarks.npz", vertices=vertices, weights=weights)
    on_rig = (surface.vertices[vertices] * weights[..., None]).sum(1)
    table = {
        "points": [{"index": i, "name": name, "mediapipe": k} for i, (name, k) in enumerate(lp.named_points())],
        "ibug68": lp.IBUG,
        "mirror": lp.MIRROR,
        "template": [[round(float(x), 5), round(float(y), 5)] for x, y in shape],
        "head": [[round(float(v) / CM_PER_M, 5) for v in point] for point in on_rig],
    }
    out = ROOT / "models/landmarks.json"
    out.parent.mkdir(exist_ok=True)
    lines = ",\n".join("  " + json.dumps(p) for p in table["points"])
    rest = ",\n".join(f' "{k}": {json.dumps(table[k])}' for k in ("ibug68", "mirror", "template", "head"))
    out.write_text('{"points": [\n' + lines + "],\n" + rest + "}\n")

    flat = on_rig[:, :2] * [1, -1]
    difference = np.linalg.norm(apply(similarity(flat, shape), flat) - shape, axis=1)
    difference /= np.linalg.norm(shape[lp.OUTER_EYE_CORNERS[0]] - shape[lp.OUTER_EYE_CORNERS[1]])
    groups = {}
    for (name, _), d in zip(lp.named_points(), difference):
        groups.setdefault(name.rsplit("_", 1)[0], []).append(d)
    print(f"{len(frontal)} frontal portraits, {len(quiet)} of them neutral")
    for name, values in groups.items():
        print(f"{name:22s} rig to mean teacher shape {100 * np.mean(values):5.1f} % of the outer eye corner distance")


if __name__ == "__main__":
    main()
