"""Batches for phase 1: windows of portraits, renders and images without a face, with labels."""
from collections import namedtuple

import numpy as np
import torch
from PIL import Image

from mien_training.data import faces, head_pose
from mien_training.data.crop_sampler import sample
from mien_training.data.expressions import CONTROLS
from mien_training.data.expressions import MIRROR as CONTROL_MIRROR
from mien_training.data.faces import window
from mien_training.data.framing import BASENET
from mien_training.data.image_border import continued
from mien_training.data.landmark_points import MIRROR
from mien_training.data.sequences import crop_to_image, fit_crop, template, to_window
from mien_training.paths import cache, data
from mien_training.renderer.assets import names

# images f32 [n,3,height,width] in 0..1; landmarks [n,175,2] in crop coordinates; controls [n,52] and pose [n,9], the
# teacher's on portraits; has_landmarks, has_controls (true ones) bool [n]; visible [n,175]; trust in the teacher's
# controls [n,52]; face [n]: 1 a face well inside the crop, 0 none or misplaced; person int [n] of renders
Batch = namedtuple("Batch", "images landmarks controls pose visible has_landmarks has_controls trust face person")


# The teacher's other controls depend on identity: an encoder that learned them, too, followed the brows and pucker of a
# speaking person worse (docs/results/training_history.md).
LEARNED_FROM_TEACHER = ("eyeBlink", "eyeLook", "jawOpen", "mouthSmile")
NEAR_PROFILE_ODDS = 4  # turned heads are rare and difficult
FRONTAL = np.radians(23)


def rarity(controls):
    """How often to draw each face [n], from controls [n,52]: up to four times as often the further one of its controls
    is from usual."""
    usual, rare = np.median(controls, 0), np.percentile(controls, 99, 0)
    moved = (controls - usual) / np.maximum(rare - usual, 0.1)
    return 0.5 + 1.5 * np.clip(moved, 0, 1).max(1)


class Portraits:
    def __init__(self, split, framing=BASENET):
        folder = cache() / "faces" / framing.folder(split)
        self.images = np.load(folder / "images.npy", mmap_mode="r")
        labels = np.load(folder / "labels.npz")
        self.landmarks, self.crop = torch.from_numpy(labels["landmarks"]), torch.from_numpy(labels["crop"])
        self.trust = torch.from_numpy(labels["trust"])
        found = faces.Portraits(split)
        self.controls, self.camera = torch.from_numpy(found.labels.controls), faces.camera_labels(found, framing)
        self.camera["trust"] = torch.from_numpy(found.labels.control_trust)
        self.learned = torch.tensor([name.startswith(LEARNED_FROM_TEACHER) for name in CONTROLS])
        self.odds = np.cumsum(rarity(found.labels.controls)
                              * np.where(found.labels.near_profile(), NEAR_PROFILE_ODDS, 1))

    def distil(self, file):
        """Replaces the teacher's controls by those of a network (distil_controls.py). All that it supports are
        learned."""
        known = np.load(file)
        self.controls, self.learned = (torch.from_numpy(known[name]) for name in ("controls", "supported"))
        self.camera["trust"] = torch.ones_like(self.controls)

    def __len__(self):
        return len(self.images)

    def rows(self, rng, n):
        i = np.searchsorted(self.odds, rng.uniform(0, self.odds[-1], n))
        self.last = {name: value[i] for name, value in self.camera.items()}
        return self.images[i], self.landmarks[i], self.crop[i], self.controls[i], self.trust[i, None].expand(-1, 175)


class Rendered:
    """All existing shards; `refresh` adds new ones and drops deleted ones. `alike` images in a row are drawn
    together: stills of one person."""

    def __init__(self, *kinds, framing=BASENET, alike=1):
        self.kinds, self.window, self.alike = [framing.folder(k) for k in kinds], framing.window, alike
        self.known = {}
        self.refresh()

    def refresh(self):
        folders = [folder for kind in self.kinds for folder in sorted((cache() / "synthetic" / kind).glob("shard_*"))]
        self.known = {folder: self.known.get(folder) or self.load(folder) for folder in folders}
        self.shards = [shard for shard in self.known.values() if shard]

    @staticmethod
    def load(folder):
        """(images, labels); None if another process deletes the shard meanwhile."""
        try:
            return np.load(folder / "images.npy", mmap_mode="r"), dict(np.load(folder / "labels.npz"))
        except FileNotFoundError:
            return None

    def __len__(self):
        return sum(len(images) for images, _ in self.shards)

    def rows(self, rng, n):
        parts = []
        for images, labels in (self.shards[k] for k in rng.integers(0, len(self.shards), 4)):
            first = np.sort(rng.integers(0, len(images) // self.alike, n // (4 * self.alike) + 1))
            i = (first[:, None] * self.alike + np.arange(self.alike)).ravel()
            parts.append((
                images[i], {k: torch.from_numpy(v[i]).float() for k, v in labels.items() if len(v) == len(images)}))
        images = np.concatenate([p[0] for p in parts])[:n]
        labels = {k: torch.cat([p[1][k] for p in parts])[:n] for k in parts[0][1]}
        scale = self.window / labels["window"][:, None, 2:3]
        landmarks = (labels["landmarks"] - labels["window"][:, None, :2]) * scale + self.window / 2
        crop = to_window(labels["crop"], labels["window"], self.window)
        self.last = labels  # labels of the last rows, for pose targets
        return images, landmarks, crop, labels["controls"], labels["visibility"]


class Backgrounds:
    """Pieces of environments, those BaseNet took for a face, and portraits where the crop misses the face."""

    def __init__(self, count=3000, seed=7):
        self.rng = np.random.default_rng(seed)
        paths = [data() / f"environments/{name}.jpg" for name in names("environments")]
        # with the width of their border
        self.pictures = [continued(np.asarray(Image.open(p).convert("RGB")), 0.4) for p in paths]
        self.plain, middle = self.pieces(count), torch.tensor(BASENET.middle).expand(count, -1)
        self.mistaken, self.mistaken_crop, self.mistakes = self.plain.copy(), middle.clone(), 0
        self.misplaced = np.load(cache() / "faces/misplaced.npy", mmap_mode="r")

    def pieces(self, count):
        images = np.empty((count, BASENET.window, BASENET.window, 3), np.uint8)
        for k in range(count):
            picture, margin = self.pictures[self.rng.integers(len(self.pictures))]
            side = np.exp(self.rng.uniform(np.log(60), np.log(400)))
            inside = np.array(picture.shape[1::-1]) - 2 * margin
            images[k] = window(picture, margin + self.rng.uniform(0, 1, 2) * inside, side)
        return images

    @torch.no_grad()
    def aligned(self, network, alignments, count=1500):
        """Lets the network align itself on new pieces, as the tracker does: images, crops and log-odds of a face
        before the first alignment and after each."""
        network.eval()
        images = self.pieces(count)
        crop = torch.tensor(BASENET.middle).expand(count, -1)
        for _ in range(alignments + 1):
            out = network((sample(images, crop, BASENET) * 2 - 1).to(next(network.parameters()).device))
            yield images, crop, out["face"].cpu()
            crop = fit_crop(template(), crop_to_image(crop, out["landmarks"].cpu()))
        network.train()

    def mine(self, network, alignments=2, believed=0.15):
        """Keeps pieces that the network accepts as a face."""
        for images, crop, face in self.aligned(network, alignments):
            self.remember(images, crop, (torch.sigmoid(face) > believed) & within(crop))

    def log_odds(self, network, alignments=3):
        """Of a face on aligned pieces; -99 where the crop has left the piece."""
        last = [list(self.aligned(network, alignments))[-1] for _ in range(4)]
        return torch.cat([face.masked_fill(~within(crop), -99) for _, crop, face in last])

    def remember(self, images, crop, chosen):
        """The newest false positives replace the oldest."""
        for i in torch.nonzero(chosen)[:, 0].tolist():
            slot = self.mistakes % len(self.mistaken)
            self.mistaken[slot], self.mistaken_crop[slot] = images[i], crop[i]
            self.mistakes += 1

    def rows(self, rng, n):
        """A third each of plain pieces, mistakes and misplaced crops."""
        a = rng.integers(0, len(self.plain), n // 3)
        b = rng.integers(0, max(1, min(self.mistakes, len(self.mistaken))), n // 3)
        c = rng.integers(0, len(self.misplaced), n - 2 * (n // 3))
        images = np.concatenate([self.plain[a], self.mistaken[b], self.misplaced[np.sort(c)]])
        middle = lambda k: torch.tensor(BASENET.middle).expand(k, -1)
        crop = torch.cat([middle(len(a)), self.mistaken_crop[b], middle(len(c))])
        return images, torch.zeros(n, 175, 2), crop, torch.zeros(n, len(CONTROLS)), torch.zeros(n, 175)


def within(crop):
    """Whether crops are still inside their windows."""
    window = BASENET.window
    away = (crop[:, :2] - window / 2).abs().amax(1) + crop[:, 2] / 2
    return (away < 0.65 * window) & (crop[:, 2] > 0.3 * window)


def jitter(crop, generator, roughness=1.0, wide_share=0.2):
    """Crops as in the tracker: mostly almost correct, sometimes as rough as a detection. All of it times
    `roughness`."""
    n = len(crop)
    wide = (torch.rand(n, 1, generator=generator) < wide_share).float()
    normal = torch.randn(n, 4, generator=generator) * torch.tensor([0.035, 0.035, 0.06, 0.08])
    rough = (torch.rand(n, 4, generator=generator) * 2 - 1) * torch.tensor([0.14, 0.14, 0.28, 0.5])
    d = torch.lerp(normal, rough, wide) * roughness
    return torch.stack([crop[:, 0] + d[:, 0] * crop[:, 2], crop[:, 1] + d[:, 1] * crop[:, 2],
                        crop[:, 2] * torch.exp(d[:, 2]), crop[:, 3] + d[:, 3]], 1)


def looseness(rotation):
    """Roughness [n,1] of crops, relative to frontal faces: fits to landmarks of turned heads are less exact."""
    yaw = torch.atan2(rotation[:, 0, 2].abs(), rotation[:, 2, 2])
    return 1 + ((yaw - FRONTAL) / FRONTAL).clamp(0, 1)[:, None]


def misplace(crop, generator):
    """Crops that show a face badly: shifted by half a side, or much too wide or too close."""
    n = len(crop)
    angle = torch.rand(n, generator=generator) * 6.2832
    away = torch.empty(n).uniform_(0.5, 0.75, generator=generator)
    shifted = torch.rand(n, generator=generator) < 0.6
    scale = torch.where(torch.rand(n, generator=generator) < 0.5, 0.42, 2.3)
    d = torch.where(shifted, away, 0.25 * away) * crop[:, 2]
    return torch.stack([crop[:, 0] + d * torch.cos(angle), crop[:, 1] + d * torch.sin(angle),
                        torch.where(shifted, crop[:, 2], crop[:, 2] * scale), crop[:, 3]], 1)


def to_crop(crop, points):
    return head_pose.rotate(points - crop[:, None, :2], -crop[:, None, 3]) / crop[:, None, 2:3] + 0.5


def mirror(batch, generator):
    """Flips half of the images, with everything that has a left and a right."""
    flip = torch.rand(len(batch.images), generator=generator) < 0.5
    choose = lambda a, b: torch.where(flip.view(-1, *[1] * (a.dim() - 1)), a, b)
    pose_signs = torch.tensor([1.0, -1, -1, -1, 1, 1, -1, 1, 1])
    return batch._replace(
        images=batch.images.index_put((flip,), batch.images[flip].flip(3)),
        landmarks=choose(torch.tensor([1.0, 0]) + batch.landmarks[:, MIRROR] * torch.tensor([-1.0, 1]),
                         batch.landmarks),
        controls=choose(batch.controls[:, CONTROL_MIRROR], batch.controls),
        trust=choose(batch.trust[:, CONTROL_MIRROR], batch.trust),
        pose=choose(batch.pose * pose_signs, batch.pose),
        visible=choose(batch.visible[:, MIRROR], batch.visible))


class Mixture:
    """Draws batches: shares of portraits, renders and, for BaseNet, backgrounds and misplaced faces."""

    def __init__(self, framing, portraits, rendered, backgrounds, seed, real_share=0.45, background_share=0.1,
                 roughness=1.0):
        self.framing = framing
        self.portraits, self.rendered, self.backgrounds = portraits, rendered, backgrounds
        self.rng, self.generator = np.random.default_rng(seed), torch.Generator().manual_seed(seed)
        self.real_share, self.background_share, self.roughness = real_share, background_share, roughness

    def batch(self, size, misplaced_share=0.04):
        n_background = int(size * self.background_share) if self.backgrounds else 0
        misplaced_share *= self.backgrounds is not None
        n_real = size - n_background if not len(self.rendered) else int(size * self.real_share)
        n_rendered = size - n_background - n_real
        parts = [self.part(self.portraits, n_real, misplaced_share)]
        if n_rendered:
            parts.append(self.part(self.rendered, n_rendered, misplaced_share))
        if n_background:
            parts.append(self.part(self.backgrounds, n_background, 0))
        whole = Batch(*(torch.cat(values) for values in zip(*parts)))
        return mirror(whole, self.generator)

    def part(self, source, n, misplaced_share):
        images, landmarks, crop, controls, visible = source.rows(self.rng, n)
        face, rendered = source is not self.backgrounds, isinstance(source, Rendered)
        bad = torch.rand(n, generator=self.generator) < misplaced_share
        roughness = self.roughness * self.framing.looseness
        if face:
            roughness = roughness * looseness(source.last["rotation"])
        used = torch.where(bad[:, None], misplace(crop, self.generator), jitter(crop, self.generator, roughness))
        good = ~bad & face
        pose = self.pose_targets(source.last, used) if face else torch.zeros(n, 9)
        trust = source.last["trust"] if source is self.portraits else torch.ones(n, len(CONTROLS))
        person = source.last["identity"].long() if rendered else torch.full((n,), -1)
        return Batch(sample(images, used, self.framing), to_crop(used, landmarks), controls, pose, visible, good,
                     good & rendered, trust, good.float(), person)

    def pose_targets(self, labels, crop):
        """Pose of rows as seen in these crops (window pixels -> camera pixels first)."""
        scale = labels["window"][:, 2:3] / self.framing.window
        camera = torch.cat([(crop[:, :2] - self.framing.window / 2) * scale + labels["window"][:, :2],
                            crop[:, 2:3] * scale, crop[:, 3:]], 1)
        return head_pose.to_crop(labels["rotation"], labels["translation"], labels["f_px"], labels["camera_wh"], camera)
