"""Rendered sequences, and features as the tracker computes them.

A shard is a folder of `images.npy` (uint8 [n,window,window,3], a square around the face) and `labels.npz`. `track`
follows faces as the tracker does: the landmarks of one frame align the crop of the next.
"""
from pathlib import Path

import numpy as np
import torch

from mien_training.data import head_pose
from mien_training.data import landmark_points as lp
from mien_training.data.augment import OfSequence
from mien_training.data.expressions import CONTROLS, MIRROR
from mien_training.data.framing import BASENET, HIFINET
from mien_training.data.video_codec import some_coded
from mien_training.networks.architectures import FACE_NETWORKS, BaseNet, HiFiNet, folded

CODED = 0.4  # share of sequences


class Sequences:
    """Sequences of one length: images is a list of uint8 [frames,window,window,3], labels are tensors
    [s,frames,...]."""

    def __init__(self, images, labels):
        self.images, self.labels, self.frames = images, labels, len(images[0])
        self.window = images[0].shape[1]

    @classmethod
    def load(cls, folders):
        """All complete sequences of some shards; images stay on disk until they are read."""
        images, tables = [], []
        for folder in folders:
            stored = np.load(Path(folder) / "images.npy", mmap_mode="r")
            labels = dict(np.load(Path(folder) / "labels.npz"))
            count = int(labels["frame"].max()) + 1
            starts = np.flatnonzero(labels["frame"] == 0)
            starts = [i for i in starts if np.array_equal(labels["frame"][i:i + count], np.arange(count))]
            images += [stored[i:i + count] for i in starts]
            rows = np.add.outer(np.array(starts, int), np.arange(count))
            tables.append({k: v[rows] for k, v in labels.items()})
        return cls(images, {k: torch.from_numpy(np.concatenate([t[k] for t in tables])) for k in tables[0]})

    def held(self, frames):
        """Every image of these sequences as a face that holds still for some frames."""
        images = [np.broadcast_to(i, (frames, *i.shape)) for sequence in self.images for i in sequence]
        hold = lambda v: v.flatten(0, 1).unsqueeze(1).expand(-1, frames, *v.shape[2:])
        return Sequences(images, {k: hold(v) for k, v in self.labels.items()})

    def coded(self, rows, seed):
        """The same with a share of the sequences `rows` as a video codec leaves them."""
        images = list(self.images)
        for i, shown in zip(rows, some_coded([images[i] for i in rows], CODED, np.random.default_rng(seed))):
            images[i] = shown
        return Sequences(images, self.labels)

    def __len__(self):
        return len(self.images)

    def frame(self, rows, t):
        """Images f32 [n,3,window,window] in 0..1 of frame t."""
        images = torch.from_numpy(np.stack([self.images[i][t] for i in rows]))
        return images.permute(0, 3, 1, 2).float() / 255

    def label(self, name, rows=slice(None), t=slice(None)):
        return self.labels[name][rows][:, t].float()


def template():
    return torch.tensor(lp.template(), dtype=torch.float32)


def fit_crop(template, points):
    """Least-squares similarity of the template [p,2] (crop coordinates) to points [n,p,2]: crop [n,4]."""
    source = torch.view_as_complex((template - 0.5).contiguous())
    target = torch.view_as_complex(points.contiguous())
    source_mean, target_mean = source.mean(), target.mean(-1, keepdim=True)
    s = source - source_mean
    a = (s.conj() * (target - target_mean)).sum(-1) / (s.abs() ** 2).sum()
    centre = target_mean[:, 0] - a * source_mean
    return torch.stack([centre.real, centre.imag, a.abs(), a.angle()], -1)


def crop_to_image(crop, points):
    """Points [n,p,2] in crop coordinates -> image pixels."""
    return head_pose.rotate(points - 0.5, crop[:, None, 3]) * crop[:, None, 2:3] + crop[:, None, :2]


def to_window(crop, window, pixels):
    """A crop [n,4] in camera pixels -> in pixels of the stored window [n,3] (cx, cy, side), which has `pixels` a
    side."""
    scale = pixels / window[:, 2:3]
    return torch.cat([(crop[:, :2] - window[:, :2]) * scale + pixels / 2, crop[:, 2:3] * scale, crop[:, 3:]], 1)


def sample_crops(images, crop, framing=BASENET, taps=None):
    """Approximate crops [n,4] of the networks (pixels of images f32 [n,3,h,w]); large ones are means of taps x taps."""
    h, w = images.shape[-2:]
    taps = taps or int(np.clip(np.ceil(float(crop[:, 2].max()) / framing.pixels_per_crop / 1.5), 1, 8))
    rows, columns = framing.height * taps, framing.width * taps
    along = lambda n: ((torch.arange(n) + 0.5 - n / 2) / taps) / framing.pixels_per_crop + 0.5
    grid = torch.stack(torch.meshgrid(along(columns), along(rows), indexing="xy"), -1).view(1, -1, 2)
    pixels = crop_to_image(crop, grid.expand(len(crop), -1, -1))
    grid = (2 * pixels / torch.tensor([w, h]) - 1).view(-1, rows, columns, 2)
    out = torch.nn.functional.grid_sample(images, grid, padding_mode="border", align_corners=False)
    return torch.nn.functional.avg_pool2d(out, taps) if taps > 1 else out


def jittered(crop, spread, generator):
    """A detector's crop: centre off by `spread` of the side, size by as much in log, no roll."""
    noise = spread * torch.randn(len(crop), 3, generator=generator)
    centre = crop[:, :2] + noise[:, :2] * crop[:, 2:3]
    return torch.cat([centre, crop[:, 2:3] * torch.exp(noise[:, 2:]), torch.zeros(len(crop), 1)], 1)


def lost(crop, truth):
    """Whether a tracked crop has left the face."""
    away = (crop[:, :2] - truth[:, :2]).norm(dim=1) / truth[:, 2]
    return (away > 0.3) | ((crop[:, 2] / truth[:, 2]).log().abs() > 0.45)


def faster(encoder):
    return folded(encoder).to(memory_format=torch.channels_last)


def run(encoder, pictures):
    return encoder((pictures * 2 - 1).contiguous(memory_format=torch.channels_last))


class BaseNetView:
    """BaseNet's output for a crop, as `track` needs it."""

    def __init__(self, checkpoint):
        net = load(checkpoint, BaseNet())
        self.encoder, self.landmarks, self.template = faster(net.encoder), net.landmarks, template()

    def look(self, images, crop, spoil):
        """Features [n,256] and landmarks [n,175,2] in crop coordinates."""
        features = run(self.encoder, spoil(sample_crops(images, crop)))
        return features, self.landmarks(features).unflatten(1, (-1, 2))


class HiFiNetView:
    """BaseNet places HiFiNet's crop on the same frame; the features are HiFiNet's, the landmarks BaseNet's."""

    def __init__(self, basenet, checkpoint):
        self.basenet, self.template = basenet, basenet.template
        self.encoder = faster(load(checkpoint, HiFiNet()).encoder)

    def look(self, images, crop, spoil):
        shape = self.basenet.look(images, crop, spoil)[1]
        return self.close(images, crop_to_image(crop, shape), spoil), shape

    def close(self, images, points, spoil):
        """Features of the face with landmarks [n,175,2] in pixels."""
        crop = fit_crop(self.template, points)
        return run(self.encoder, spoil(sample_crops(images, crop, HIFINET)))


def load(checkpoint, network):
    network.load_state_dict(torch.load(checkpoint, map_location="cpu")["average"])
    return network.eval()


def for_inference(name, encoder, decoders):
    """A network that outputs controls of still faces, from checkpoints of its encoder and of its decoders."""
    network = load(encoder, FACE_NETWORKS[name]())
    network.use_decoders(torch.load(decoders, map_location="cpu"))
    return folded(network)


class Mirrored:
    """The view of mirrored faces; its landmarks are mirrored back."""

    def __init__(self, view):
        self.view, self.template = view, view.template

    def look(self, images, crop, spoil):
        flipped = torch.cat([images.shape[3] - crop[:, :1], crop[:, 1:3], -crop[:, 3:]], 1)
        features, points = self.view.look(images.flip(3), flipped, spoil)
        return features, (points * torch.tensor([-1.0, 1]) + torch.tensor([1.0, 0]))[:, lp.MIRROR]


@torch.no_grad()
def track(view, sequences, rows, spoil, generator, stride=1):
    """Tracks sequences `rows` with the encoder on every `stride`-th frame.

    view: its `look` returns features and landmarks, like BaseNetView's.
    spoil: callable (f32 [n,3,height,width] in 0..1, frame number) -> the same.
    Returns features [n,frames,256], crops [n,frames,4] the features come from, landmarks [n,frames,175,2] in
    camera pixels, and the number of lost faces.
    """
    history, losses = [], 0
    for t in range(sequences.frames):
        if t % stride == 0:
            truth = sequences.label("crop", rows, t)
            crop = found = jittered(truth, 0.06, generator)
            if t > 0:
                crop = fit_crop(view.template, history[-1][2])
                gone = lost(crop, truth)
                crop = torch.where(gone[:, None], found, crop)
                losses += int(gone.sum())
            inside = to_window(crop, sequences.label("window", rows, t), sequences.window)
            feature, shape = view.look(sequences.frame(rows, t), inside, lambda x: spoil(x, t))
            frame = feature, crop, crop_to_image(crop, shape)
        history.append(frame)
    features, crops, points = (torch.stack(h, 1) for h in zip(*history))
    return features, crops, points, losses


def pose_targets(sequences, rows, crops):
    """Targets of the pose decoder for these crops, [n,frames,9]."""
    label = lambda name: sequences.label(name, rows)
    return head_pose.to_crop(label("rotation"), label("translation"), label("f_px"), label("camera_wh"), crops)


def visible(sequences, rows):
    """Visible controls, f32 [n,frames,52]; those of an eye need most of its lids' landmarks."""
    points = sequences.label("visibility", rows)
    out = torch.ones(*points.shape[:2], len(CONTROLS))
    for side in ("Left", "Right"):
        lids = [i for i, (name, _) in enumerate(lp.named_points()) if name.startswith(side.lower() + "_eye_")]
        eye = [i for i, name in enumerate(CONTROLS) if name.startswith("eye") and name.endswith(side)]
        out[..., eye] = (points[..., lids].mean(-1, keepdim=True) > 0.5).float()
    return out


def landmark_error(predicted, truth):
    """Mean point distance over the outer eye corner distance, [n,frames]."""
    a, b = lp.OUTER_EYE_CORNERS
    eyes = (truth[..., a, :] - truth[..., b, :]).norm(dim=-1)
    return (predicted - truth).norm(dim=-1).mean(-1) / eyes


def targets(sequences, rows, crops, mirror):
    """Labels of tracks: pose [n,frames,9], controls and visible [n,frames,52]."""
    pose, controls = pose_targets(sequences, rows, crops), sequences.label("controls", rows)
    seen = visible(sequences, rows)
    if mirror:
        pose = pose * torch.tensor([1.0, -1, -1, -1, 1, 1, -1, 1, 1])
        controls, seen = controls[..., MIRROR], seen[..., MIRROR]
    return {"pose": pose, "controls": controls, "visible": seen}


def untouched(x, frame):
    return x


def extract(view, sequences, seed, stride=1, plain=False, mirrored=False, batch=32):
    """Tracks each sequence, or its mirror image, with the encoder on every `stride`-th frame.

    Returns tensors with one row per track: features fp16 [m,frames,256], pose [m,frames,9], controls and visible
    [m,frames,52], crop [m,frames,4], stride [m], landmark_error [m,frames]. `plain` adds no camera effects.
    """
    tracks, losses = [], 0
    view = Mirrored(view) if mirrored else view
    for start in range(0, len(sequences), batch):
        rows = torch.arange(start, min(start + batch, len(sequences)))
        key = (seed * 2 + stride) * 1000000 + start
        spoil = untouched if plain else OfSequence(len(rows), key)
        shown = sequences if plain else sequences.coded(rows, key)
        features, crops, points, again = track(view, shown, rows, spoil, torch.Generator().manual_seed(key), stride)
        losses += again
        tracks.append({"features": features.half(), "crop": crops, "stride": torch.full((len(rows),), stride),
                       "landmark_error": landmark_error(points, sequences.label("landmarks", rows)),
                       **targets(sequences, rows, crops, mirrored)})
    out = {k: torch.cat([t[k] for t in tracks]) for k in tracks[0]}
    print(f"stride {stride}: {len(out['stride'])} tracks, landmark error {out['landmark_error'].mean():.4f}, "
          f"faces found again {losses}", flush=True)
    return out
