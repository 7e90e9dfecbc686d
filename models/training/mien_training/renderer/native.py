"""ctypes mirror of scene.h, and the rasterizer as a Python object."""
import ctypes
import functools
from ctypes import POINTER, Structure, c_float, c_int32, c_void_p
from pathlib import Path

import numpy as np

from mien_training.native_build import library

OVERLAYS = 6
BLOCK = 64  # numbers of a shape that lie together (blend.h)
SKIN, INTERIOR, EYE, HAIR, SOLID, LENS, LASH = range(7)
OPAQUE, FRINGE, BLENDED = range(3)


class Mesh(Structure):
    _fields_ = [(n, c_void_p) for n in ("position", "occlusion", "uv", "corner_position", "corner_uv", "pose")]
    _fields_ += [("vertices", c_int32)]


class Part(Structure):
    _fields_ = [(n, c_int32) for n in ("mesh", "first", "count", "material", "stage", "cull", "casts_shadow")]


class Overlay(Structure):
    _fields_ = [("texture", c_int32), ("rect", c_float * 4), ("colour", c_float * 3), ("opacity", c_float)]


class Material(Structure):
    _fields_ = [("mode", c_int32), ("texture", c_int32 * 2), ("mix", c_float), ("albedo", c_void_p),
                ("saturation", c_float), ("overlay", Overlay * OVERLAYS), ("colour", c_float * 3), ("specular",
                                                                                                    c_float),
                ("gloss", c_int32), ("param", c_float * 4)]


class Light(Structure):
    _fields_ = [("irradiance", c_float * 30), ("lamps", c_int32), ("direction", c_float * 9), ("colour", c_float * 9),
                ("shadow", c_int32), ("centre", c_float * 3), ("exposure", c_float)]


class View(Structure):
    _fields_ = [(n, c_float) for n in ("f_px", "centre_x", "centre_y", "x0", "y0", "scale")]
    _fields_ += [("width", c_int32), ("height", c_int32)]


class Scene(Structure):
    _fields_ = [("meshes", POINTER(Mesh)), ("parts", POINTER(Part)), ("materials", POINTER(Material)),
                ("mesh_count", c_int32), ("part_count", c_int32), ("light", Light), ("view", View),
                ("background", c_void_p)]


class Folds(Structure):
    _fields_ = [(n, c_void_p)
                for n in ("first", "second", "at", "to", "square", "along", "scale", "start", "neighbour", "shade",
                                        "vertex")]
    _fields_ += [("edges", c_int32), ("skin", c_int32), ("begins", c_float), ("deepest", c_float)]


def pointer(array, dtype=np.float32):
    """Address of a contiguous array; the caller keeps the array alive."""
    assert array.dtype == dtype and array.flags.c_contiguous, (array.dtype, array.flags)
    return array.ctypes.data


@functools.lru_cache
def rasterizer():
    """Path of the compiled rasterizer."""
    here = Path(__file__).resolve().parent
    return library(here / "rasterizer.cpp", sorted(here.glob("*.h")))


@functools.lru_cache
def load():
    lib = ctypes.CDLL(str(rasterizer()))
    lib.renderer_create.restype = c_void_p
    return lib


def blend_shapes(weights, basis):
    """f32 [rows,blocks * BLOCK]: weights [rows,shapes] times shapes that lie as basis [blocks,shapes,BLOCK]."""
    weights = np.ascontiguousarray(weights, np.float32)
    blocks, shapes, _ = basis.shape
    out = np.empty((len(weights), blocks * BLOCK), np.float32)
    load().renderer_blend_shapes(c_void_p(pointer(weights)), c_void_p(pointer(basis)), len(weights), shapes, blocks,
                                 c_void_p(pointer(out)))
    return out


def folds(ints, floats, begins, deepest):
    """Folds of int32 arrays (first, second, at, to, start, neighbour, vertex) and f32 ones (square, along, scale,
    shade), which it keeps."""
    first, second, at, to, start, neighbour, vertex = (pointer(a, np.int32) for a in ints)
    square, along, scale, shade = map(pointer, floats)
    made = Folds(first, second, at, to, square, along, scale, start, neighbour, shade, vertex, len(ints[0]),
                 len(ints[-1]), begins, deepest)
    made.keep = ints, floats
    return made


def darkened(made, posed, openness):
    """Openness f32 [vertices] minus the shade of the folds of a posed head f32 [vertices,3], in place."""
    load().renderer_darken(ctypes.byref(made), c_void_p(pointer(posed)), c_void_p(pointer(openness)))
    return openness


class Rasterizer:
    def __init__(self):
        self.lib = load()
        self.handle = c_void_p(self.lib.renderer_create())

    def add_texture(self, rgba, wrap=False):
        rgba = np.ascontiguousarray(rgba, np.uint8)
        height, width = rgba.shape[:2]
        return self.lib.renderer_add_texture(self.handle, c_void_p(rgba.ctypes.data), width, height, int(wrap))

    def render(self, scene, points, tolerance):
        """Image uint8 [height,width,3], and visibility uint8 [n] of points f32 [n,3] (camera space, cm)."""
        image = np.empty((scene.view.height, scene.view.width, 3), np.uint8)
        visible = np.empty(len(points), np.uint8)
        self.lib.renderer_render(self.handle, ctypes.byref(scene), c_void_p(image.ctypes.data),
                                 c_void_p(pointer(points)),
                                 c_void_p(pointer(tolerance)), len(points), c_void_p(visible.ctypes.data))
        return image, visible

    def occlusion(self, scene, directions, vertices):
        """Openness f32 [vertices] of the first mesh to directions f32 [n,3]."""
        out = np.empty(vertices, np.float32)
        self.lib.renderer_occlusion(self.handle, ctypes.byref(scene), c_void_p(pointer(directions)), len(directions),
                                    c_void_p(out.ctypes.data))
        return out
