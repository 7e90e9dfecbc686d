"""Scenes: a figure (a look on an identity) with pose and expression, light and camera."""
from dataclasses import dataclass

import numpy as np

from mien_training.data.landmark_points import TEACHER
from mien_training.paths import cache
from mien_training.renderer import make_up, native, props
from mien_training.renderer.assets import overlay_rectangle, pack, picture, skin_file, worn
from mien_training.renderer.lighting import sphere
from mien_training.renderer.wrinkles import Folding, Skin

SKIN_TOLERANCE, IRIS_TOLERANCE = 0.5, 0.12  # cm that may lie in front of a landmark that counts as seen
IRIS_LANDMARKS = [i for i, teacher in enumerate(TEACHER) if teacher >= 468]


@dataclass
class Scene:
    figure: "Figure"
    vertices: np.ndarray      # f32 [26719,3] head frame, cm
    rotation: np.ndarray      # [3,3] head frame -> camera
    translation: np.ndarray   # [3] cm
    landmarks: np.ndarray     # [175,3] head frame, cm
    light: native.Light
    view: native.View
    background: np.ndarray    # uint8 [height,width,3]
    occluders: tuple = ()     # (vertices f32 [n,3] in camera space, triangles, linear colour)


def linear(srgb):
    return np.float32(np.clip(srgb, 0, 1)) ** 2.2


class Studio:
    """Rasterizer, rig and textures, shared by everything rendered in a process."""

    def __init__(self, rig):
        self.rig, self.rasterizer, self.textures = rig, native.Rasterizer(), {}
        skin = [rig.corner_position[slice(*rig.materials[name])] for name in ("M_Face", "M_BackHead")]
        self.edge = props.rim(np.concatenate(skin), rig.neutral)
        self.shoulder_corners = props.strips(len(props.SHOULDERS), len(self.edge))
        self.occlusion = self.vertex_occlusion()
        self.skin = Skin(rig.corner_position[slice(*rig.materials["M_Face"])], len(rig.neutral))
        self.make_up = make_up.pictures(rig)

    def texture(self, *parts, wrap=False):
        """Number of an image of the rig pack, or of any file."""
        if parts not in self.textures:
            self.textures[parts] = self.rasterizer.add_texture(picture(pack(*parts)), wrap)
        return self.textures[parts]

    def vertex_occlusion(self):
        """How open each vertex of the mean head is, computed once and kept."""
        path = cache() / f"head_occlusion_{native.rasterizer().stem}.npy"
        if not path.exists():
            shapes = Shapes()
            head = shapes.mesh(self.rig.neutral, self.rig.corner_position, pose=np.eye(3, 4, dtype=np.float32))
            for name in ("M_Face", "M_BackHead"):
                shapes.part(head, self.rig.materials[name], native.Material())
            # Fewer directions from below than above: the body and the ground are there.
            directions = sphere(400)
            directions = np.ascontiguousarray(directions[directions[:, 1] > -0.5])
            found = self.rasterizer.occlusion(shapes.scene(), directions, len(self.rig.neutral))
            fresh = path.with_name(f"{id(self)}.npy")
            np.save(fresh, found)
            fresh.rename(path)
        return np.load(path)

    def render(self, scene):
        """Image uint8 [height,width,3] and visibility uint8 [175] of the landmarks."""
        shapes = scene.figure.posed(scene)
        for vertices, triangles, colour in scene.occluders:
            mesh = shapes.mesh(np.float32(vertices), triangles, pose=np.eye(3, 4, dtype=np.float32))
            shapes.part(mesh, (0, len(triangles)), material(native.SOLID, colour=colour, specular=0.05, gloss=4),
                        cast=1)
        points = np.float32(scene.landmarks @ scene.rotation.T + scene.translation)
        tolerance = np.full(len(points), SKIN_TOLERANCE, np.float32)
        tolerance[IRIS_LANDMARKS] = IRIS_TOLERANCE
        light = scene.light
        light.centre[:] = points.mean(0)
        return self.rasterizer.render(shapes.scene(light, scene.view, scene.background), points, tolerance)


class Shapes:
    """Meshes, parts and materials of a scene, and the arrays they point to."""

    def __init__(self, other=None):
        self.meshes, self.parts, self.materials, self.keep = ([], [], [], []) if other is None else (
            list(other.meshes), list(other.parts), list(other.materials), list(other.keep))

    def mesh(self, vertices, corner_position, pose=None, uv=None, corner_uv=None, occlusion=None):
        uv = np.zeros((len(vertices), 2), np.float32) if uv is None else uv
        corner_uv = corner_position if corner_uv is None else corner_uv
        arrays = [vertices, uv, occlusion, corner_position, corner_uv, pose]
        self.keep.append(arrays)
        address = lambda a, dtype=np.float32: None if a is None else native.pointer(a, dtype)
        self.meshes.append(native.Mesh(address(vertices), address(occlusion), address(uv),
                                       address(corner_position, np.int32),
                                       address(corner_uv, np.int32), address(pose), len(vertices)))
        return len(self.meshes) - 1

    def part(self, mesh, span, made, stage=native.OPAQUE, cull=0, cast=0):
        self.materials.append(made)
        self.parts.append(native.Part(mesh, span[0], span[1] - span[0], len(self.materials) - 1, stage, cull, cast))

    def scene(self, light=None, view=None, background=None):
        fill = lambda kind, items: (kind * len(items))(*items)
        out = native.Scene(fill(native.Mesh, self.meshes), fill(native.Part, self.parts),
                           fill(native.Material, self.materials), len(self.meshes), len(self.parts))
        if light is not None:
            out.light, out.view = light, view
            out.background = native.pointer(background, np.uint8)
        return out


def material(mode, texture=-1, second=-1, mix=0.0, albedo=None, saturation=1.0, colour=(1, 1, 1), specular=0.0, gloss=4,
             param=(0, 0, 0, 0), overlays=()):
    made = native.Material(mode, (texture, second), mix, None if albedo is None else native.pointer(albedo), saturation)
    made.colour[:], made.specular, made.gloss, made.param[:] = colour, specular, gloss, param
    for k in range(native.OVERLAYS):
        made.overlay[k].texture = -1
    for k, (number, rectangle, tint, opacity) in enumerate(overlays):
        made.overlay[k] = native.Overlay(number, rectangle, tuple(tint), opacity)
    return made


BYTES = np.arange(256) / 255


def skin_albedo(look):
    """f32 [3,256] linear albedo of the skin's bytes."""
    return np.float32(np.clip((BYTES ** 2.2) ** look.contrast * look.tone[:, None], 0, 0.85))


def hair_albedo(colour, mean_luma):
    """f32 [3,256] linear albedo by luma: the colour, lighter and darker with the strands."""
    strands = np.minimum((BYTES / max(mean_luma, 0.03)) ** 0.55, 1.5)
    return linear(np.minimum(colour[:, None] * strands, 0.95))


def plain_albedo():
    return np.float32(np.repeat(BYTES[None] ** 2.2, 3, 0))


class Figure:
    """A look put on an identity; `head` f32 [26719,3] is the identity at rest."""

    def __init__(self, studio, look, head):
        self.studio, self.look, self.head, self.rig = studio, look, head, studio.rig
        self.albedo, self.plain = skin_albedo(look), plain_albedo()
        self.lid = float(head[self.rig.ibug68[36:48], 1].mean())
        self.folding = Folding(studio.skin, head, look.wrinkles)
        self.static = []  # (mesh arrays, parts) fixed to the skull
        self.skin_parts = self.make_skin()
        self.wear()

    def make_skin(self):
        look, texture = self.look, self.studio.texture
        first, second = look.skins
        hair = linear(look.hair_colour)
        overlays = []
        if look.brow:
            overlays.append((texture("brows", f"{look.brow}.png"), overlay_rectangle("brows"), hair * 0.7,
                             look.brow_opacity))
        if look.beard:
            overlays.append((texture("beards", f"{look.beard}.png"), overlay_rectangle("beards"), hair * 0.8, 0.95))
        overlays += [(texture(self.studio.make_up[m.region]), (0, 0, 1, 1), m.colour, m.opacity) for m in look.make_up]
        collar = -100 if "suit" in first else look.collar
        made = lambda tile, over, edge: material(
            native.SKIN, texture(skin_file(first, tile)), texture(skin_file(second, tile)), look.skin_mix,
            self.albedo, look.saturation, specular=look.shine, param=(*look.cloth_colour, edge), overlays=over)
        iris = texture("eyes", f"{look.iris}.jpg")
        sclera = texture("eyes", f"sclera_{look.sclera}.png")
        iris = material(native.EYE, iris, albedo=self.plain, colour=look.iris_gain, specular=0.6, gloss=7,
                        param=(self.lid, 0, 0, 0))
        white = material(native.EYE, sclera, albedo=self.plain, colour=(0.72, 0.69, 0.67), specular=0.5, gloss=7,
                         param=(self.lid, 1, 0, 0))
        parts = [("M_Face", made("face", overlays, -100), native.OPAQUE, 1, 1),
                 ("M_IrisLeft", iris, native.OPAQUE, 0, 0), ("M_IrisRight", iris, native.OPAQUE, 0, 0),
                 ("M_ScleraLeft", white, native.OPAQUE, 0, 0), ("M_ScleraRight", white, native.OPAQUE, 0, 0),
                 ("M_BackHead", made("back", (), collar), native.OPAQUE, 1, 1)]
        if look.lashes:
            lash = material(native.LASH, texture("eyes", "lashes_alpha.png"), colour=(0.012, 0.01, 0.008))
            parts.append(("M_EyeLashes", lash, native.FRINGE, 0, 0))
        return parts

    def wear(self):
        look, texture = self.look, self.studio.texture
        if look.hair:
            item = worn("hair", look.hair)
            mean = float(item.table.get("mean_luma", 0.3))
            self.hair_albedo = hair_albedo(look.hair_colour, mean)
            made = material(native.HAIR, texture("hair", str(item.table["texture"]), wrap=True),
                            albedo=self.hair_albedo, specular=0.06)
            self.add_static(item, [((0, len(item.corners)), made, native.OPAQUE, 1)])
        if look.hat:
            item = worn("hats", look.hat[0])
            made = material(native.SOLID, texture("hats", f"{look.hat[1]}.jpg"), albedo=self.plain, specular=0.02)
            self.add_static(item, [((0, len(item.corners)), made, native.OPAQUE, 1)])
        if look.glasses:
            item = worn("glasses", look.glasses)
            colour = linear(look.frame_colour if look.frame_colour is not None else item.table["default_rgb"][0] / 255)
            frame = material(native.SOLID, colour=colour, specular=0.4, gloss=6)
            lens = material(native.LENS, colour=(0.01, 0.01, 0.012), specular=0.5, gloss=8,
                            param=(look.lens_opacity, 0, 0, 0))
            self.add_static(item, [((0, item.frame_count), frame, native.OPAQUE, 1),
                                   ((item.frame_count, len(item.corners)), lens, native.BLENDED, 0)])

    def add_static(self, item, parts):
        vertices = np.float32(item.fit(self.rig.neutral, self.head))
        self.static.append((vertices, item.corners, item.uv, parts))

    def posed(self, scene):
        """Shapes of the figure with the scene's vertices and pose."""
        shapes, rig = Shapes(), self.rig
        pose = np.float32(np.concatenate([scene.rotation, scene.translation[:, None]], 1))
        head = shapes.mesh(scene.vertices, rig.corner_position, pose, rig.uv, rig.corner_uv, self.lit(scene.vertices))
        for name, made, stage, cull, cast in self.skin_parts:
            shapes.part(head, rig.materials[name], made, stage, cull, cast)
        for vertices, corners, uv, parts in self.static:
            mesh = shapes.mesh(vertices, corners, pose, uv)
            for span, made, stage, cast in parts:
                shapes.part(mesh, span, made, stage, 0, cast)
        self.add_mouth(shapes, head, scene.vertices)
        shoulders = shapes.mesh(props.body(scene.vertices[self.studio.edge]), self.studio.shoulder_corners, pose)
        shapes.part(shoulders, (0, len(self.studio.shoulder_corners)),
                    material(native.SOLID, colour=self.look.cloth_colour, specular=0.01))
        return shapes

    def lit(self, vertices):
        """How open every vertex is, f32 [26719]: wrinkles are in shadow."""
        return self.studio.occlusion * self.folding.openness(vertices)

    def add_mouth(self, shapes, head, vertices):
        """Teeth, gums and tongue, unless the lips are shut."""
        upper, lower = vertices[self.rig.ibug68[[61, 62, 63]]], vertices[self.rig.ibug68[[67, 66, 65]]]
        gap = float(np.linalg.norm(upper - lower, axis=1).max())
        if gap < 0.05:
            return
        for name, file in (("M_Teeth", "teeth.jpg"), ("M_GumsTongue", "gums_tongue.jpg")):
            made = material(native.INTERIOR, self.studio.texture("eyes", file), albedo=self.plain, specular=0.25,
                            gloss=5, param=(gap, 0, 0, 0))
            shapes.part(head, self.rig.materials[name], made, native.OPAQUE, 0, 0)
