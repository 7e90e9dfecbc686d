#!/usr/bin/env python3
"""How networks in PyTorch follow one person on film, beside the teacher: a quick look at checkpoints that are not exported.

usage: probe_film.py --basenet E.pt [--hifinet H.pt] [--decoders D.pt] [--every 3]
Films of GRID's speaker s1, faces placed by the program. Beside every control: what a line through the features of that frame
reaches on films that it was not fitted to, which is what decoders could make of them. That speaker is also one of the clips of the
evaluation: to choose between networks and to look for what is wrong, not to report.
"""
import argparse
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "train"))
import numpy as np  # noqa: E402
import torch  # noqa: E402

import metrics  # noqa: E402
import sequences as seq  # noqa: E402
import teacher  # noqa: E402
from expressions import CONTROLS  # noqa: E402
from networks import ControlsDecoder  # noqa: E402
from paths import ROOT, cache, data  # noqa: E402
from program import Program  # noqa: E402
from shown import shown  # noqa: E402
from whole_files import whole  # noqa: E402

FRAMES = 75         # of a film
SIZE = (288, 360)   # height, width
RIDGE = 3e-2        # of the features' variance
FOLDS = 5


def frames_of(path):
    """uint8 [FRAMES,360,360,3]: the film with a black bar below."""
    command = ["ffmpeg", "-v", "error", "-i", str(path), "-f", "rawvideo", "-pix_fmt", "rgb24", "-"]
    film = np.frombuffer(subprocess.check_output(command), np.uint8).reshape(-1, *SIZE, 3)[:FRAMES]
    return np.pad(film, ((0, 0), (0, SIZE[1] - SIZE[0]), (0, 0), (0, 0)))


def landmarks_of(program, path):
    """[FRAMES,175,2] pixels, as the program follows the face at level 4; kept, for all networks are shown the same crops."""
    kept = cache() / "evaluation/films" / f"{path.stem}.npy"
    if not kept.exists():
        kept.parent.mkdir(parents=True, exist_ok=True)
        landmarks = program.track(path, 4).landmarks[:FRAMES]
        with whole(kept) as out:
            np.save(out, landmarks)
    return np.load(kept)


def films(every):
    """(Sequences, teacher's controls [films,FRAMES,52] with nan where it has none) of every so manieth film that was found whole."""
    source = np.load(data() / "av/curves.npz")
    names, row = [str(n) for n in source["blendshape_names"]], {str(c): i for i, c in enumerate(source["clip"])}
    program, template = Program(ROOT / "build/release/apps/mien/mien", ROOT / "models"), seq.template()
    images, crops, controls = [], [], []
    for path in sorted((data() / "av/video").glob("*.mp4"))[::every]:
        first, last = source["offset"][row[path.stem]:row[path.stem] + 2]
        points = landmarks_of(program, path)
        if last - first < FRAMES or len(points) < FRAMES or not np.isfinite(points).all():
            continue
        images.append(frames_of(path))
        crops.append(seq.fit_crop(template, torch.from_numpy(points).float()))
        known = {n: source["blendshapes"][first:first + FRAMES, names.index(n)] for n in CONTROLS if n in names}
        controls.append(np.stack([known.get(n, np.full(FRAMES, np.nan)) for n in CONTROLS], 1))
    crops = torch.stack(crops)
    window = torch.tensor([SIZE[1] / 2, SIZE[1] / 2, SIZE[1]]).expand(*crops.shape[:2], 3)
    return seq.Sequences(images, {"crop": crops, "window": window}), np.stack(controls).astype(np.float32)


def features_of(view, sequences, stride):
    rows = torch.arange(len(sequences))
    parts = [seq.track(view, sequences, part, seq.untouched, torch.Generator().manual_seed(1), stride)[0] for part in rows.split(16)]
    return torch.cat(parts)


def line_through(features, controls):
    """What ridge regression on other films makes of each film's features, [films,FRAMES,52]."""
    fold, answers = np.arange(len(features)) % FOLDS, np.zeros_like(controls)
    for k in range(FOLDS):
        x, y = features[fold != k].flatten(0, 1).double(), torch.from_numpy(controls[fold != k]).flatten(0, 1).double()
        mean, middle = x.mean(0), y.mean(0)
        square = (x - mean).T @ (x - mean)
        weight = torch.linalg.solve(square + RIDGE * square.diagonal().mean() * torch.eye(len(square)), (x - mean).T @ (y - middle))
        answers[fold == k] = ((features[fold == k].double() - mean) @ weight + middle).float().numpy()
    return answers


def controls_decoder(path):
    decoder = ControlsDecoder()
    decoder.load_state_dict(torch.load(path, map_location="cpu")["controls_decoder"])
    return decoder.eval()


def decoded(decoder, features):
    with torch.no_grad():
        return shown(decoder(features.float())[0]).numpy()


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--basenet", type=Path, required=True, help="checkpoint of the encoder")
    parser.add_argument("--hifinet", type=Path, help="checkpoint of the encoder, when it is HiFiNet that is looked at")
    parser.add_argument("--decoders", type=Path, nargs="*", default=[])
    parser.add_argument("--every", type=int, default=3, help="films there are, to look at")
    args = parser.parse_args()
    torch.set_num_threads(1)
    sequences, truth = films(args.every)
    view = seq.BaseNetView(args.basenet)
    if args.hifinet:
        view = seq.HiFiNetView(view, args.hifinet)
    seen = {f"stride {stride}": features_of(view, sequences, stride) for stride in (1, 2)}
    columns = {"line": line_through(seen["stride 1"], np.nan_to_num(truth))}
    for path in args.decoders:
        decoder = controls_decoder(path)
        columns |= {f"{path.stem}, {mode}": decoded(decoder, features) for mode, features in seen.items()}
    known = [i for i in range(len(CONTROLS)) if np.isfinite(truth[..., i]).all() and truth[..., i].std() >= teacher.MOVES]
    table = {name: metrics.correlations(answer[..., known], truth[..., known]) for name, answer in columns.items()}
    print("control".ljust(22) + "  ".join(name.rjust(8) for name in table))
    for k, i in enumerate(known):
        print(CONTROLS[i].ljust(22) + "  ".join(f"{values[k]:.2f}".rjust(max(8, len(name))) for name, values in table.items()))
    print("mean".ljust(22) + "  ".join(f"{np.nan_to_num(values).mean():.3f}".rjust(max(8, len(name))) for name, values in table.items()))


if __name__ == "__main__":
    main()
