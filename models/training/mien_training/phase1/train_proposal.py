"""Trains P-Net and R-Net (Zhang et al. 2016, the first two stages) to detect the square of the crop.

usage: python3 -m mien_training.phase1.train_proposal [--samples N] [--resume]
Writes $MIEN_CACHE/runs/proposal/{pnet,rnet}.pt. Stage 1 trains P-Net on windows of portraits, renders
and environments, runs it on some of these images, and continues with its detections, correct or not. Stage 2 trains
R-Net on the proposals of P-Net.
"""
import argparse
import itertools
import json

import numpy as np
import torch
import torch.nn.functional as F
from PIL import Image
from tqdm import tqdm

from mien_convert.atomic_files import whole
from mien_training.data import augment
from mien_training.data import proposal_data as data
from mien_training.data.faces import Portraits, leaves
from mien_training.data.image_border import continued
from mien_training.networks.architectures import PNet, RNet
from mien_training.paths import cache
from mien_training.renderer.assets import environment_picture, names

CANVAS = 160           # side of the square the tracker searches, pixels
PYRAMID_FACTOR = 0.709
PNET_THRESHOLD = 0.4   # low: R-Net is there to refuse
BATCH, SEED = 512, 1
STRANGE = 0.15         # share of windows in strange light


def to_tensor(windows):
    return torch.from_numpy(windows).permute(0, 3, 1, 2).float() / 127.5 - 1


def augmented(x, generator):
    """Photometric variety per window: gain, offset, per-channel tint, grey, strange light, blur, noise."""
    n = len(x)
    uniform = lambda low, high, *shape: torch.empty(n, *shape).uniform_(low, high, generator=generator)
    grey = x.mean(1, keepdim=True)
    x = torch.where(uniform(0, 1, 1, 1, 1) < 0.25, grey.expand_as(x), x)
    x = x * uniform(0.5, 1.4, 1, 1, 1) * uniform(0.85, 1.15, 3, 1, 1) + uniform(-0.4, 0.4, 1, 1, 1)
    x = augment.share_of(x, generator, STRANGE, lambda y, g: augment.strange_light((y.clamp(-1, 1) + 1) / 2, g) * 2 - 1)
    blurred = F.avg_pool2d(F.pad(x, (1, 1, 1, 1), mode="replicate"), 3, 1)
    x = torch.lerp(x, blurred, uniform(0, 1, 1, 1, 1) * (uniform(0, 1, 1, 1, 1) < 0.3))
    x = x + torch.randn(x.shape, generator=generator) * uniform(0, 0.12, 1, 1, 1)
    return x.clamp(-1, 1)


def loss_of(logit, box, kind, target):
    """Cross entropy on the hardest 70 % of faces and non-faces (OHEM); smooth L1 on faces and parts."""
    judged = kind != data.PART
    entropy = F.binary_cross_entropy_with_logits(logit[judged], (kind[judged] == data.POSITIVE).float(),
                                                 reduction="none")
    hardest = entropy.topk(max(1, int(0.7 * len(entropy)))).values.mean()
    boxed = kind != data.NEGATIVE
    return hardest + 4 * F.smooth_l1_loss(box[boxed], target[boxed], beta=0.1)


class Windows:
    """A set of windows in memory, served in class-balanced random batches."""

    def __init__(self, windows, kind, target):
        self.windows, self.target = windows, torch.from_numpy(target)
        self.kind = torch.from_numpy(kind.astype(np.int64))
        self.by_kind = [np.flatnonzero(kind == k) for k in (data.NEGATIVE, data.POSITIVE, data.PART)]

    def __add__(self, other):
        return Windows(np.concatenate([self.windows, other.windows]), torch.cat([self.kind, other.kind]).numpy(),
                       torch.cat([self.target, other.target]).numpy())

    def batch(self, rng, size):
        rows = np.concatenate([rng.choice(rows, int(size * share))
                               for rows, share in zip(self.by_kind, (0.5, 0.25, 0.25)) if len(rows)])
        return to_tensor(self.windows[rows]), self.kind[rows], self.target[rows]


def mirrored(x, target, generator):
    flip = torch.rand(len(x), generator=generator) < 0.5
    x = torch.where(flip[:, None, None, None], x.flip(3), x)
    return x, torch.where(flip[:, None], target * torch.tensor([-1.0, 1.0, 1.0]), target)


def train(network, windows, samples, side, seed):
    generator, rng = torch.Generator().manual_seed(seed), np.random.default_rng(seed)
    steps = samples // BATCH
    optimizer = torch.optim.AdamW(network.parameters(), 3e-3, weight_decay=1e-4)
    schedule = torch.optim.lr_scheduler.OneCycleLR(optimizer, 4e-3, steps)
    network.train()
    for _ in tqdm(range(steps), desc=type(network).__name__):
        x, kind, target = windows.batch(rng, BATCH)
        x, target = mirrored(augmented(x, generator), target, generator)
        logit, box = network(F.adaptive_avg_pool2d(x, side) if side != data.WINDOW else x)
        loss = loss_of(logit.flatten(), box.flatten(1), kind, target)
        optimizer.zero_grad()
        loss.backward()
        optimizer.step()
        schedule.step()
    network.eval()


def with_surroundings(image, box):
    """Tight images end at the chin, which no camera's do: these get a blurred border."""
    if not leaves(image, box[:2], 1.3 * box[2]):
        return image, box
    image, margin = continued(image)
    return image, box + [margin, margin, 0]


def pictures(rng, portrait_limit=None):
    """(image, box or None): portraits with their box, environments without a face."""
    found = Portraits("train")
    order = rng.permutation(len(found))[:portrait_limit]
    for i in tqdm(order, desc="pictures", mininterval=5):
        yield with_surroundings(*found[i])
    for name in names("environments"):
        image = environment_picture(name)
        for _ in range(6):
            x, y = rng.integers(0, image.shape[1] - 256), rng.integers(0, image.shape[0] - 256)
            yield image[y:y + 256, x:x + 256], None


def rendered(rng, limit):
    """Windows of rendered faces: the stored image is a square of 1.5 crop sides around the crop's centre."""
    shards = sorted((cache() / "synthetic/train_stills").glob("shard_*"))
    for shard in shards[:max(1, limit // 2000)]:
        images = np.load(shard / "images.npy", mmap_mode="r")
        for image in images:
            centre = image.shape[0] / 2
            yield np.asarray(image), np.array([centre, centre, image.shape[0] / 1.5])


def collect(parts):
    windows, kind, target = zip(*parts)
    return Windows(np.concatenate(windows), np.concatenate(kind), np.concatenate(target))


def first_windows(rng):
    parts = []
    for image, box in pictures(rng):
        parts.append(data.windows_of_background(rng, image, 40) if box is None
                     else data.windows_of_face(rng, image, box))
    for image, box in rendered(rng, 8000):
        parts.append(data.windows_of_face(rng, image, box, around=6, negatives=0))
    return collect(parts)


def pyramid(image):
    """The levels the tracker searches: the image in a square canvas, made smaller again and again."""
    height, width = image.shape[:2]
    scale = CANVAS / max(height, width)
    while scale * max(height, width) >= 12:
        size = max(12, round(width * scale)), max(12, round(height * scale))
        yield np.asarray(Image.fromarray(image).resize(size, Image.BOX)), scale
        scale *= PYRAMID_FACTOR


@torch.no_grad()
def propose(pnet, image, threshold=PNET_THRESHOLD):
    """Detections of P-Net, regressed squares [n,3]."""
    boxes = []
    for level, scale in pyramid(image):
        logit, box = pnet(to_tensor(level[None].copy()))
        probability = torch.sigmoid(logit[0, 0])
        ys, xs = torch.nonzero(probability > threshold, as_tuple=True)
        d = box[0, :, ys, xs].T.numpy()
        cells = np.column_stack([xs * 2 + 6, ys * 2 + 6, np.full(len(xs), 12.0)])
        moved = np.column_stack([cells[:, :2] + d[:, :2] * 12, 12 * np.exp(np.clip(d[:, 2], -1, 1))])
        boxes.append(moved / scale)
    return np.vstack(boxes)


def second_windows(rng, pnet, most=24, portrait_limit=None):
    parts = []
    for image, box in pictures(rng, portrait_limit):
        found = propose(pnet, image)
        found = found[rng.permutation(len(found))[:most]]
        if box is None:
            parts.append((data.cut(image, found), np.zeros(len(found), np.int8), np.zeros((len(found), 3), np.float32)))
            continue
        windows = np.vstack([found, data.near(rng, box, 8)])
        kind = data.kinds(data.iou(windows, box))
        keep = kind >= 0
        parts.append((data.cut(image, windows[keep]), kind[keep].astype(np.int8), data.regression(windows[keep], box)))
    for image, box in rendered(rng, 8000):
        parts.append(data.windows_of_face(rng, image, box, around=6, negatives=0))
    return collect(parts)


def evaluate(pnet, rnet, split):
    """Share of held-out portraits whose best box overlaps the true one, per stage."""
    hits = {"pnet": [], "rnet": []}
    counts = []
    for image, box in itertools.starmap(with_surroundings, Portraits(split)):
        found = propose(pnet, image)
        counts.append(len(found))
        hits["pnet"].append(bool(len(found)) and data.iou(found, box).max() > 0.5)
        best = refine(rnet, image, found)
        hits["rnet"].append(best is not None and data.iou(best[None], box)[0] > 0.5)
    return {"portraits": len(counts), "proposals_per_picture": float(np.mean(counts)),
            **{f"{stage}_recall": float(np.mean(h)) for stage, h in hits.items()}}


@torch.no_grad()
def refine(rnet, image, boxes):
    """The regressed box with the highest score of R-Net; None without a box."""
    if not len(boxes):
        return None
    logit, d = rnet(to_tensor(data.cut(image, boxes)))
    i = int(logit.flatten().argmax())
    dx, dy, dlog = d.flatten(1)[i].tolist()
    cx, cy, side = boxes[i]
    return np.array([cx + dx * side, cy + dy * side, side * np.exp(np.clip(dlog, -1, 1))])


def train_pnet(pnet, samples):
    """Twice: on random windows, then also on its own detections."""
    rng = np.random.default_rng(SEED)
    windows = first_windows(rng)
    train(pnet, windows, samples // 2, 12, SEED)
    windows = windows + second_windows(rng, pnet, portrait_limit=3000)
    train(pnet, windows, samples // 2, 12, SEED + 7)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--samples", type=int, default=1_500_000, help="windows shown to each network")
    parser.add_argument("--resume", action="store_true", help="keep a P-Net that is there")
    options = parser.parse_args()
    torch.set_num_threads(1)
    torch.manual_seed(SEED)
    run = cache() / "runs/proposal"
    run.mkdir(parents=True, exist_ok=True)
    pnet, rnet = PNet(), RNet()
    if options.resume and (run / "pnet.pt").exists():
        pnet.load_state_dict(torch.load(run / "pnet.pt"))
        pnet.eval()
    else:
        train_pnet(pnet, options.samples)
        with whole(run / "pnet.pt") as out:
            torch.save(pnet.state_dict(), out)
    train(rnet, second_windows(np.random.default_rng(SEED + 1), pnet), options.samples, 24, SEED + 1)
    with whole(run / "rnet.pt") as out:
        torch.save(rnet.state_dict(), out)
    result = evaluate(pnet, rnet, "test")
    (run / "metrics.json").write_text(json.dumps(result, indent=1) + "\n")
    print(result)


if __name__ == "__main__":
    main()
