"""Head poses, crops, and tracking of rendered sequences."""
import unittest

import numpy as np
import torch

from mien_training.data import head_pose
from mien_training.data.crop_sampler import sample
from mien_training.data.framing import BASENET, FRAMINGS
from mien_training.data.head_pose import REFERENCE_M, orthonormalise, ray_rotation, rotate, rotation_z, to_crop
from mien_training.data.sequences import Sequences, crop_to_image, fit_crop, sample_crops, track, untouched
from mien_training.data.video_codec import some_coded, through_h264
from mien_training.renderer.wrinkles import Folding, Skin, Wrinkles


def to_camera(prediction, f_px, camera_wh, crop):
    """The inverse of to_crop: prediction [n,9] -> (rotation [n,3,3], translation [n,3] m)."""
    centre, side, theta = crop[..., :2], crop[..., 2], crop[..., 3]
    frame = ray_rotation(centre, f_px, camera_wh) @ rotation_z(-theta)
    rotation = frame @ orthonormalise(prediction[..., :6])
    distance = f_px * REFERENCE_M / (side * torch.exp(prediction[..., 8]))
    pixel = rotate(prediction[..., 6:8], theta) * side[..., None] + centre
    xy = (pixel - camera_wh / 2) * (distance / f_px)[..., None]
    return rotation, torch.stack([xy[..., 0], -xy[..., 1], -distance], -1)


class HeadPose(unittest.TestCase):
    def test_crop_and_camera_poses_agree(self):
        n = 1000
        torch.manual_seed(0)
        double = dict(dtype=torch.float64)
        rotation = orthonormalise(torch.randn(n, 6, **double))
        camera_wh = torch.tensor([640.0, 480.0], **double).expand(n, 2)
        f_px = 300 + 600 * torch.rand(n, **double)
        xyz = torch.rand(n, 3, **double) * 2 - 1
        distance = 0.3 + 1.5 * torch.rand(n, **double)
        translation = torch.stack([0.3 * xyz[:, 0], 0.3 * xyz[:, 1], -distance], -1)
        crop = torch.stack([camera_wh[:, 0] * torch.rand(n, **double), camera_wh[:, 1] * torch.rand(n, **double),
                            50 + 200 * torch.rand(n, **double), 2 * torch.rand(n, **double) - 1], -1)
        again = to_camera(to_crop(rotation, translation, f_px, camera_wh, crop), f_px, camera_wh, crop)
        assert (again[0] - rotation).abs().max() < 1e-9 and (again[1] - translation).abs().max() < 1e-9
        # R_ray is a rotation and sends the optical axis to the ray.
        ray = ray_rotation(crop[:, :2], f_px, camera_wh)
        assert (ray @ ray.transpose(1, 2) - torch.eye(3)).abs().max() < 1e-12
        axis = ray @ torch.tensor([0.0, 0, -1], **double)
        pixel = camera_wh / 2 + torch.stack([axis[:, 0], -axis[:, 1]], -1) * (f_px / -axis[:, 2])[:, None]
        assert (pixel - crop[:, :2]).abs().max() < 1e-8
        # A head looking at the camera from the crop's centre, rolled with the crop, has R_crop = identity.
        frame = ray @ rotation_z(-crop[:, 3])
        assert (to_crop(frame, translation, f_px, camera_wh, crop)[:, [0, 4]] - 1).abs().max() < 1e-12


class CropSampler(unittest.TestCase):
    def test_it_samples_like_the_layers_of_pytorch(self):
        rng, generator = np.random.default_rng(1), torch.Generator().manual_seed(1)
        for framing in FRAMINGS.values():
            windows = rng.integers(0, 256, (7, framing.window, framing.window, 3), np.uint8)
            windows[:, 1:] = windows[:, 1:] // 4 + windows[:, :-1] // 4 * 3
            crop = torch.tensor(framing.middle) + torch.randn(7, 4,
                                                              generator=generator) * torch.tensor([20.0, 20, 9, 0.5])
            floats = torch.from_numpy(windows.transpose(0, 3, 1, 2).copy()).float() / 255
            assert float((sample(windows, crop, framing)
                          - sample_crops(floats, crop, framing, taps=1)).abs().max()) < 0.01


class SequencesTest(unittest.TestCase):
    def test_tracking_recovers_known_crops(self):
        """An image whose colours are the true crop coordinates lets an exact "network" prove the geometry of
        tracking."""
        torch.manual_seed(0)
        n, frames = 6, 20
        template = torch.rand(175, 2) * 0.8 + 0.1
        crop = torch.tensor([[300.0, 200, 150, 0.2]]) + torch.randn(n, 4) * torch.tensor([40, 40, 20, 0.2])
        drift = torch.randn(n, 1, 4) * torch.tensor([2, 2, 1, 0.01]) * torch.arange(frames).view(1, -1, 1)
        crops = (crop[:, None] + drift).flatten(0, 1)
        pixels = BASENET.window
        window = torch.cat([crops[:, :2] + 3, BASENET.window_crops * crops[:, 2:3]], 1)
        at = (torch.arange(pixels) + 0.5) / pixels
        grid = torch.stack(torch.meshgrid(at, at, indexing="xy"), -1).view(1, -1, 2) - 0.5
        camera = grid * window[:, None, 2:3] + window[:, None, :2]
        local = head_pose.rotate(camera - crops[:, None, :2], -crops[:, None, 3]) / crops[:, None, 2:3]
        colours = torch.cat([0.5 + local / 2.5, torch.zeros_like(local[..., :1])], -1)
        images = (colours * 255).round().clamp(0, 255).byte().view(n, frames, pixels, pixels, 3)
        made = Sequences(list(images.numpy()), {"crop": crops.view(n, frames, 4), "window": window.view(n, frames, 3)})

        def read(x):
            local = (x[:, :2, 16:49, 16:49] - 0.5) * 2.5 + 0.5
            at = (torch.arange(16, 49) + 0.5) / BASENET.width
            here = torch.stack(torch.meshgrid(at, at, indexing="xy"), -1).view(-1, 2)
            design = torch.cat([local.flatten(2).transpose(1, 2), torch.ones(len(x), len(here), 1)], 2)
            solution = torch.linalg.lstsq(design, here.expand(len(x), -1, -1)).solution
            return torch.zeros(len(x), 256), torch.cat([template, torch.ones(175, 1)], 1) @ solution

        class View:
            def look(self, images, crop, spoil):
                return read(spoil(sample_crops(images, crop)))

        view = View()
        view.template = template
        truth = crop_to_image(crops, template.expand(len(crops), -1, -1)).view(n, frames, 175, 2)
        assert (fit_crop(template, truth.flatten(0, 1)) - crops).abs().max() < 1e-2
        for stride in (1, 2):
            _, used, points, losses = track(view, made, torch.arange(n), untouched, torch.Generator(), stride)
            error = (points - truth)[:, ::stride].norm(dim=-1).max()
            assert losses == 0 and error < 0.5, f"{losses} faces lost, {error} pixels off"
            assert (used[:, stride::stride] - made.labels["crop"][:, :-stride:stride]).abs().max() < 1.0


class VideoCodec(unittest.TestCase):
    def test_quality_and_motion(self):
        """Coarser is worse, fine is close, and a moving disc stays where it is in every frame."""
        y, x = np.mgrid[0:64, 0:96]
        frames = np.stack([np.where((x - 20 - 3 * t) ** 2 + (y - 32) ** 2 < 144, 220, 60 + x // 2) for t in range(12)])
        frames = np.repeat(frames[..., None], 3, 3).astype(np.uint8)
        error = lambda quality: np.abs(through_h264(frames, quality).astype(float) - frames).mean()
        assert error(18) < 3 < error(44), (error(18), error(44))
        shown = through_h264(frames, 30)[..., 0] > 150
        middles = [np.nonzero(f)[1].mean() for f in shown]
        assert np.abs(np.array(middles) - (20 + 3 * np.arange(12))).max() < 1.5, middles
        rng = np.random.default_rng(1)
        kept = some_coded([frames, frames[:2]], 1.0, rng)
        assert not np.array_equal(kept[0], frames) and kept[1].base is frames


class WrinklesTest(unittest.TestCase):
    def test_skin_folds_across_the_compression(self):
        """A sheet that is compressed along y has folds across y, deepest at the waves; one at rest or stretched has
        none."""
        y, x = np.mgrid[0:30, 0:30].astype(np.float32) * 0.3
        rest = np.stack([x.ravel(), y.ravel(), np.zeros(900, np.float32)], 1)
        corner = (np.arange(29)[:, None] * 30 + np.arange(29)).ravel()
        triangles = np.concatenate([corner[:, None] + [0, 1, 30], corner[:, None] + [1, 31, 30]])
        folding = Folding(Skin(triangles, 900), rest, Wrinkles(1.0, 1.2, np.zeros(2, np.float32), 0.0))
        posed = lambda sx, sy: rest * np.float32([sx, sy, 1])
        assert np.abs(folding.openness(rest) - 1).max() < 1e-5
        assert np.abs(folding.openness(posed(1.2, 1.1)) - 1).max() < 1e-5
        shade = folding.openness(posed(1.0, 0.7)).reshape(30, 30)[5:-5, 5:-5]
        assert shade.min() < 0.75 and shade.std(0).mean() > 5 * shade.std(1).mean()
        across = folding.openness(posed(0.7, 1.0)).reshape(30, 30)[5:-5, 5:-5]
        assert across.min() < 0.75 and across.std(1).mean() > 5 * across.std(0).mean()


if __name__ == "__main__":
    unittest.main()
