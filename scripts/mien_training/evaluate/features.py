"""Features of the rendered test sequences with the shipped networks, cached in $MIEN_CACHE/evaluation."""
import hashlib
from pathlib import Path

import torch

from mien_convert.atomic_files import whole
from mien_training.data import augment
from mien_training.data import sequences as seq
from mien_training.data.framing import FRAMINGS
from mien_training.evaluate.inputs import Missing
from mien_training.paths import cache

SEED = 7


def shards(network):
    """Folders of the test sequences in a network's framing."""
    framing = FRAMINGS[network]
    found = sorted((cache() / "synthetic" / framing.folder("test_sequences")).glob("shard_*"))
    if not found:
        option = "" if network == "basenet" else f" --framing {network}"
        raise Missing(
            f"no synthetic test sequences: make_synthetic.py --split test --kind sequences --count 66{option}")
    return found


def digest(paths):
    content = hashlib.sha256()
    for path in paths:
        content.update(path.read_bytes())
    return content.hexdigest()[:12]


def of(setting, network, plain):
    """Features of the test sequences: as rendered (`plain`), or with the effects of a poor camera."""
    encoders = [setting.checkpoint("basenet")[0]] + ([setting.checkpoint("hifinet")[0]] if network == "hifinet" else [])
    folders = shards(network)
    made_by = encoders if plain else [*encoders, Path(augment.__file__)]  # which defines the poor camera
    name = f"{network}_{digest(made_by)}_{len(folders)}_{'plain' if plain else 'spoiled'}.pt"
    path = cache() / "evaluation" / name
    if not path.exists():
        view = seq.BaseNetView(encoders[0])
        if network == "hifinet":
            view = seq.HiFiNetView(view, encoders[1])
        path.parent.mkdir(parents=True, exist_ok=True)
        found = seq.extract(view, seq.Sequences.load(folders), 1, SEED, plain=plain)
        with whole(path) as out:
            torch.save(found, out)
    return torch.load(path)
