#!/usr/bin/env python3
"""The renderer's rasterizer on squares with known images: their positions, order and visibility."""
import os
import tempfile
import unittest

import numpy as np

os.environ.setdefault("MIEN_CACHE", tempfile.mkdtemp())
from mien_training.renderer import native

SIZE, FOCAL = 64, 64.0
BLUE = np.array([0, 0, 1], np.float32)
RED = np.array([1, 0, 0], np.float32)
BACKGROUND = np.full((SIZE, SIZE, 3), 50, np.uint8)
CORNERS = np.array([[0, 1, 2], [0, 2, 3]], np.int32)
UPRIGHT = np.eye(3, 4, dtype=np.float32)


def square(left, bottom, right, top, depth):
    """Vertices f32 [4,3] of a square that faces the camera; edges in pixels right and up of the centre of the image."""
    plane = [[left, bottom], [right, bottom], [right, top], [left, top]]
    return np.array([[x * depth / FOCAL, y * depth / FOCAL, -depth] for x, y in plane], np.float32)


def render(squares, points=np.zeros((0, 3), np.float32), tolerance=0.5):
    """Image and visibility of (vertices, colour) squares under even light."""
    unused = np.zeros((4, 2), np.float32)
    address = native.pointer
    meshes = [native.Mesh(address(v), None, address(unused), address(CORNERS, np.int32), address(CORNERS, np.int32),
                          address(UPRIGHT), 4) for v, _ in squares]
    materials = []
    for _, colour in squares:
        made = native.Material(native.SOLID, (-1, -1), 0, None, 1)
        made.colour[:], made.gloss = colour, 4
        for overlay in made.overlay:
            overlay.texture = -1
        materials.append(made)
    parts = [native.Part(k, 0, 2, k, native.OPAQUE, 0, 0) for k in range(len(squares))]
    fill = lambda kind, items: (kind * len(items))(*items)
    scene = native.Scene(fill(native.Mesh, meshes), fill(native.Part, parts), fill(native.Material, materials),
                         len(squares), len(squares))
    for colour in range(3):
        scene.light.irradiance[10 * colour + 9] = 1.0
    scene.light.exposure = 1.0
    scene.view = native.View(FOCAL, SIZE / 2, SIZE / 2, 0, 0, 1, SIZE, SIZE)
    scene.background = address(BACKGROUND, np.uint8)
    points = np.ascontiguousarray(points, np.float32)
    return native.Rasterizer().render(scene, points, np.full(len(points), tolerance, np.float32))


def covered(image):
    return (image != BACKGROUND).any(2)


class Rasterizer(unittest.TestCase):
    def test_a_square_covers_its_pixels(self):
        image, _ = render([(square(-10, -5, 20, 15, 50), RED)])
        wanted = np.zeros((SIZE, SIZE), bool)
        wanted[32 - 15:32 + 5, 32 - 10:32 + 20] = True
        np.testing.assert_array_equal(covered(image), wanted)
        inside = image[wanted]
        self.assertTrue((inside == inside[0]).all(), "even light on an even colour")
        self.assertGreater(inside[0, 0], 100)
        self.assertLess(inside[0, 2], 20)

    def test_half_a_pixel_is_half_covered(self):
        image, _ = render([(square(-10.5, -10, 10, 10, 50), RED)])
        edge, inside = image[32, 32 - 11].astype(int), image[32, 32].astype(int)
        self.assertTrue(50 < edge[0] < inside[0], (edge, inside))

    def test_the_nearer_square_hides_the_other_in_any_order(self):
        near, far = (square(-10, -10, 10, 10, 40), RED), (square(-20, -20, 20, 20, 60), BLUE)
        first, second = render([near, far])[0], render([far, near])[0]
        np.testing.assert_array_equal(first, second)
        self.assertGreater(first[32, 32, 0], first[32, 32, 2])
        self.assertGreater(first[32, 32 - 15, 2], first[32, 32 - 15, 0])

    def test_points_behind_are_not_seen(self):
        points = [[0, 0, -39.0], [0, 0, -40.3], [0, 0, -45], [40.0 * 20 / FOCAL, 0, -45]]
        _, seen = render([(square(-10, -10, 10, 10, 40), RED)], points)
        self.assertEqual(seen.tolist(), [1, 1, 0, 1], "in front, within the tolerance, behind, beside")

    def test_what_is_behind_the_camera_or_beside_the_picture_leaves_it_alone(self):
        behind = square(-10, -10, 10, 10, 40) * np.array([1, 1, -1], np.float32)
        image, _ = render([(behind, RED), (square(500, 0, 600, 50, 40), RED), (square(-10, -600, 10, -500, 40), RED)])
        np.testing.assert_array_equal(image, BACKGROUND)


if __name__ == "__main__":
    unittest.main()
