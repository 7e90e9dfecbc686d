"""Skins from photographs: the visible skin of fitted portraits, without its light, in the rig's texture.

usage: python3 -m mien_training.renderer.portrait_skins [--most N] [--workers N]
Run portrait_fit.py before. Writes missing files $MIEN_CACHE/portrait_skins/<skin>+<portrait>.jpg, where <skin> of the
rig pack continues the photograph. The light is a spherical harmonic of second order (Ramamoorthi and Hanrahan 2001),
fitted so that the photograph is a skin of the pack under it; division by the light leaves the detail of the photograph
at the tone of that skin.
"""
import argparse
from multiprocessing import Pool
from pathlib import Path

import cv2
import numpy as np
from tqdm import tqdm

from mien_training.data import landmark_points as lp
from mien_training.data import portrait_labels
from mien_training.paths import cache
from mien_training.renderer import native
from mien_training.renderer.assets import names, pack, picture
from mien_training.renderer.lighting import basis
from mien_training.renderer.rig import Rig
from mien_training.renderer.scene import Shapes, material

SIDE = 384             # of the texture, texels
EACH = 5               # stride of the vertices that estimate the light
WORST_FIT = 0.023      # residual of the landmarks
MIN_EYES = 30        # outer eye corners' distance, pixels
EYES_CM = 9.5          # the same of the rig
HUBER = 0.25           # relative error of brightness beyond which a vertex counts less
WORST_LIGHT = 0.45     # mean log error of brightness after the light has been fitted
RIDGE = 0.004          # regularization of the light's shape, relative to the brightness
DARKEST = 0.4          # shade below which a place is not brightened further, in the median of the face
DARK_BLUE, DARK_BELOW = 0.33, 0.35  # linear blue over red, brightness relative to the brightest of the image
MIN_FACING, FULL_FACING = 0.25, 0.55  # cosine between normal and line of sight


def vertex_normals(vertices, triangles):
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    face = np.cross(b - a, c - a)
    out = np.zeros_like(vertices)
    for k in range(3):
        np.add.at(out, triangles[:, k], face)
    return out / np.maximum(np.linalg.norm(out, axis=1, keepdims=True), 1e-9)


class FaceTexture:
    """Where the texels of the face tile lie on the rig's skin."""

    def __init__(self, rig):
        begin, end = rig.materials["M_Face"]
        self.corner_vertex, corner_uv = rig.corner_position[begin:end], rig.corner_uv[begin:end]
        self.uv = rig.uv[corner_uv] * [SIDE, -SIDE] + [0, SIDE]  # [t,3,2] texels
        self.triangle = np.full((SIDE, SIDE), -1, np.int32)
        self.weight = np.zeros((SIDE, SIDE, 3), np.float32)
        for t, corners in enumerate(self.uv):
            self.paint(t, corners)
        self.vertex_uv = np.zeros((len(rig.neutral), 2), np.float32)
        self.vertex_uv[self.corner_vertex] = self.uv
        self.vertices = np.unique(self.corner_vertex)[::EACH]
        self.inside = self.oval(rig)

    def paint(self, t, corners):
        low = np.clip(np.floor(corners.min(0)), 0, SIDE).astype(int)
        high = np.clip(np.ceil(corners.max(0)), 0, SIDE).astype(int)
        y, x = np.mgrid[low[1]:high[1], low[0]:high[0]] + 0.5
        (x0, y0), (x1, y1), (x2, y2) = corners
        area = (x1 - x0) * (y2 - y0) - (x2 - x0) * (y1 - y0)
        if abs(area) < 1e-9 or not x.size:
            return
        w1 = ((x - x0) * (y2 - y0) - (x2 - x0) * (y - y0)) / area
        w2 = ((x1 - x0) * (y - y0) - (x - x0) * (y1 - y0)) / area
        w = np.stack([1 - w1 - w2, w1, w2], -1)
        hit = (w > -1e-6).all(-1)
        box = slice(low[1], high[1]), slice(low[0], high[0])
        self.triangle[box][hit], self.weight[box][hit] = t, w[hit]

    def spread(self, values):
        """Texels [SIDE,SIDE,c] of values [26719,c] at vertices."""
        return (values[self.corner_vertex[self.triangle]] * self.weight[..., None]).sum(-2)

    def oval(self, rig):
        """f32 [SIDE,SIDE]: 1 well inside the oval of the face, 0 outside."""
        corners = [lp.POSITION[k] for k in lp.FACE_OVAL]
        at = rig.landmarks(self.vertex_uv)[corners]
        mask = np.zeros((SIDE, SIDE), np.uint8)
        cv2.fillPoly(mask, [np.int32(at)], 1)
        return np.clip(cv2.distanceTransform(mask, cv2.DIST_L2, 5) / (0.07 * SIDE), 0, 1)


class Photograph:
    """A portrait with the rig laid over it."""

    def __init__(self, fits, i, rig):
        self.name, self.size = str(fits["name"][i]), fits["size_wh"][i]
        head = rig.identity(fits["identity"][i:i + 1])[0] + rig.expression(fits["controls"][i:i + 1])[0]
        self.pose = np.float32(np.concatenate([fits["rotation"][i], fits["translation"][i][:, None]], 1))
        self.vertices, self.f_px = head, float(fits["f_px"][i])
        self.posed = head @ fits["rotation"][i].T + fits["translation"][i]
        picture = cv2.imread(str(portrait_labels.of_names([self.name]).path(0)))[..., ::-1]
        self.linear = (picture / np.float32(255)) ** 2.2
        chroma = np.ptp(picture.astype(np.float32), 2)
        self.grey = bool(np.median(chroma) < 6)

    def pixels(self, points):
        return points[:, :2] * [1, -1] * self.f_px / -points[:, 2:] + self.size / 2

    def at(self, pixels):
        """Linear colours at pixels [...,2]."""
        where = np.float32(pixels) - 0.5
        return cv2.remap(self.linear, where[..., 0], where[..., 1], cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)

    def seen(self, rasterizer, rig):
        """uint8 [26719]: vertices that the head does not hide."""
        shapes = Shapes()
        mesh = shapes.mesh(np.ascontiguousarray(self.vertices, np.float32), rig.corner_position, self.pose, rig.uv,
                           rig.corner_uv)
        for part in ("M_Face", "M_BackHead"):
            shapes.part(mesh, rig.materials[part], material(native.SOLID), native.OPAQUE, 1, 0)
        side = float(self.size.max())
        view = native.View(self.f_px, *(self.size / 2), *(self.size / 2 - side / 2), 128 / side, 128, 128)
        scene = shapes.scene(native.Light(), view, np.zeros((128, 128, 3), np.uint8))
        points = np.ascontiguousarray(self.posed, np.float32)
        return rasterizer.render(scene, points, np.full(len(points), 0.7, np.float32))[1]


def is_dark(photo, landmarks):
    """Whether a colour photograph shows dark skin on the cheeks; landmarks [175,2] in pixels."""
    cheeks = landmarks[[lp.POSITION[k] for k in lp.CHEEK[0] + lp.CHEEK[1]]]
    red, green, blue = np.median(photo.at(cheeks[None])[0], axis=0)
    brightness = (red + green + blue) / 3 / np.percentile(photo.linear.mean(2), 99)
    return not photo.grey and blue < DARK_BLUE * red and brightness < DARK_BELOW


def least_squares(rows, values, weight, ridge=RIDGE):
    """Solves for a few unknowns by the normal equations: rows [n,k], values and weight [n] -> [k]. All but the first
    are regularized."""
    weighted = rows * weight[:, None]
    square = weighted.T @ rows
    penalty = np.diag([0.0] + [ridge * square[0, 0]] * (len(square) - 1))
    return np.linalg.solve(square + penalty, weighted.T @ values)


def light_of(colour, skin, normals, weight):
    """Coefficients [10,3] of the light, one tint of one shape, under which `skin` [n,3] looks like `colour` [n,3], and
    the remaining error. A shape per channel would explain lips, beards and make-up as coloured light."""
    shapes, w = basis(normals), weight.copy()
    brightness, albedo = colour.mean(1), skin.mean(1)
    for _ in range(4):
        shape = least_squares(shapes * albedo[:, None], brightness, w)
        shading = np.clip(shapes @ shape, 1e-3, None)
        error = np.abs(np.log((brightness + 0.01) / (shading * albedo + 0.01)))
        w = weight * np.minimum(1, HUBER / np.maximum(error, 1e-6))
    tint = (w[:, None] * colour).sum(0) / (w[:, None] * shading[:, None] * skin).sum(0)
    return shape[:, None] * tint, float((weight * np.minimum(error, 1)).sum() / weight.sum())


class Baker:
    def __init__(self):
        self.rig, self.rasterizer = Rig(), native.Rasterizer()
        self.face = FaceTexture(self.rig)
        self.skins = {}
        for name in names("skins", "train"):
            if "suit" not in name:
                image = cv2.resize(picture(pack("skins", f"{name}_face.jpg"))[..., :3], (SIDE, SIDE),
                                   interpolation=cv2.INTER_AREA)
                self.skins[name] = (image / np.float32(255)) ** 2.2
        uv = self.face.vertex_uv[self.face.vertices]
        column, row = np.clip(uv.astype(int), 0, SIDE - 1).T
        self.at_vertices = {n: cv2.GaussianBlur(s, (0, 0), 3)[row, column] for n, s in self.skins.items()}

    def bake(self, photo):
        """Texture uint8 [SIDE,SIDE,3], and the name of the skin that continues it."""
        normals = vertex_normals(photo.posed, self.face.corner_vertex).astype(np.float32)
        sight = -photo.posed / np.linalg.norm(photo.posed, axis=1, keepdims=True)
        facing = np.clip(((normals * sight).sum(1) - MIN_FACING) / (FULL_FACING - MIN_FACING), 0, 1)
        seen = facing * photo.seen(self.rasterizer, self.rig)
        v = self.face.vertices
        colour = photo.at(photo.pixels(photo.posed)[v][None])[0]
        inside = self.face.inside[tuple(np.clip(self.face.vertex_uv[v].astype(int), 0, SIDE - 1).T[::-1])]
        weight = seen[v] * (inside > 0.5)
        landmarks = photo.pixels(self.rig.landmarks(photo.posed))
        dark = is_dark(photo, landmarks)
        results = {n: light_of(colour, skin, normals[v], weight) for n, skin in self.at_vertices.items()
                   if ("dark" in n) == dark}
        best = min(results, key=lambda n: results[n][1])
        return self.paint(photo, self.skins[best], results[best][0], normals, seen), best, results[best][1]

    def paint(self, photo, skin, light, normals, seen):
        normal = self.face.spread(normals)
        normal /= np.maximum(np.linalg.norm(normal, axis=-1, keepdims=True), 1e-6)
        shade = np.maximum((basis(normal.reshape(-1, 3)) @ light).reshape(SIDE, SIDE, 3), 0)
        shade = np.maximum(shade, DARKEST * np.median(shade[self.face.inside > 0.5], axis=0))
        places = self.face.spread(photo.posed)
        places[self.face.triangle < 0] = (0, 0, -1)  # texels that no skin uses
        found = photo.at(photo.pixels(places.reshape(-1, 3)).reshape(SIDE, SIDE, 2)) / shade
        if photo.grey:
            found = skin * (found.mean(2, keepdims=True) / np.maximum(skin.mean(2, keepdims=True), 1e-3))
        share = self.face.inside * self.face.spread(seen[:, None])[..., 0] * (self.face.triangle >= 0)
        share = cv2.GaussianBlur(np.minimum(share, cv2.erode(share, np.ones((9, 9)))), (0, 0), 3)[..., None]
        other = np.minimum(share[:, ::-1], 1 - share)  # mirrored where only the other side is visible
        rest = 1 - share - other
        out = share * found + other * found[:, ::-1] + rest * skin
        return np.uint8(np.clip(out, 0, 1) ** (1 / 2.2) * 255 + 0.5)


def bake_share(job):
    """Writes the skins of some portraits. Returns their number, and the number of those whose light does not fit."""
    fits, rows, worker = job
    baker, refused = Baker(), 0
    for i in tqdm(rows, position=worker, mininterval=5):
        photo = Photograph(fits, i, baker.rig)
        texture, base, error = baker.bake(photo)
        if error > WORST_LIGHT:
            refused += 1
            continue
        path = cache() / "portrait_skins" / f"{base}+{photo.name.removesuffix('.jpg')}.jpg"
        cv2.imwrite(str(path), texture[..., ::-1], [cv2.IMWRITE_JPEG_QUALITY, 92])
    return len(rows), refused


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--most", type=int, help="maximum number of portraits")
    parser.add_argument("--workers", type=int, default=1)
    args = parser.parse_args()
    fits = dict(np.load(cache() / "portrait_skins/fits.npz"))
    eyes = fits["f_px"] / np.abs(fits["translation"][:, 2]) * EYES_CM
    seen = ~portrait_labels.of_names(fits["name"]).near_profile()
    good = np.flatnonzero((fits["residual"] < WORST_FIT) & (eyes > MIN_EYES) & seen)[:args.most]
    made = {path.stem.partition("+")[2] for path in (cache() / "portrait_skins").glob("*+*.jpg")}
    good = np.array([i for i in good if Path(str(fits["name"][i])).stem not in made], int)
    with Pool(args.workers) as pool:
        counts = pool.map(bake_share, [(fits, good[k::args.workers], k) for k in range(args.workers)])
    used, refused = np.sum(counts, 0)
    print(
        f"{used - refused} new skins of {len(fits['name'])} portraits: {used} are large enough and fit, {refused} of "
        "these have a light that does not fit")


if __name__ == "__main__":
    main()
