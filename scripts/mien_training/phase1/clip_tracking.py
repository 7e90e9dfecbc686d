"""Tracks the faces of the evaluation clips with one network, to select checkpoints. Clips are never used for training.

The landmarks of a frame align the crop of the next; the teacher's landmarks start a clip, and restart it when the crop
has left the face. mien_training.evaluate measures the whole tracker.
"""
import subprocess

import numpy as np
import torch

from mien_training.data import landmark_points as lp
from mien_training.data.expressions import CONTROLS
from mien_training.data.sequences import crop_to_image, fit_crop, landmark_error, lost, sample_crops, template
from mien_training.paths import data

WATCHED = ("jawOpen", "eyeBlinkLeft", "eyeBlinkRight", "mouthSmileLeft", "mouthPucker", "browInnerUp", "browDownLeft")


class Clip:
    """Frames uint8 [n,h,w,3]; the teacher's landmarks [n,175,2] in pixels, found [n], controls [n,52] (nan where it has
    none)."""

    def __init__(self, labels_path):
        labels = np.load(labels_path)
        self.name = labels_path.name.split(".")[0]
        path = next(p for p in labels_path.parent.glob(self.name + ".*") if p.suffix != ".npz")
        w, h = video_size(path)
        command = ["ffmpeg", "-v", "error", "-i", str(path), "-f", "rawvideo", "-pix_fmt", "rgb24", "-"]
        frames = np.frombuffer(subprocess.check_output(command), np.uint8).reshape(-1, h, w, 3)
        n = min(len(frames), len(labels["found"]))
        self.frames, self.found = frames[:n], torch.from_numpy(labels["found"][:n].astype(bool))
        points = labels["landmarks"][:n, lp.TEACHER, :2] * np.array([w, h])
        self.landmarks = torch.from_numpy(points.astype(np.float32))
        names = [str(name) for name in labels["blendshape_names"]]
        self.controls = torch.full((n, len(CONTROLS)), float("nan"))
        for i, control in enumerate(CONTROLS):
            if control in names:
                self.controls[:,
                              i] = torch.from_numpy(labels["blendshapes"][:n, names.index(control)].astype(np.float32))

    def __len__(self):
        return len(self.frames)

    def frame(self, t):
        """f32 [1,3,h,w] in 0..1"""
        return torch.from_numpy(self.frames[t].copy()).permute(2, 0, 1)[None].float() / 255


def video_size(path):
    command = ["ffprobe", "-v", "error", "-select_streams", "v:0", "-show_entries", "stream=width,height", "-of",
               "csv=p=0", str(path)]
    return [int(v) for v in subprocess.check_output(command, text=True).strip().strip(",").split(",")[:2]]


def load():
    return [Clip(path) for path in sorted((data() / "clips").glob("*.mediapipe.npz"))]


@torch.no_grad()
def follow(network, clip):
    """(landmarks [n,175,2] in pixels, face probability [n], controls [n,52], times the face was lost)."""
    shape, crop, losses, rows = template(), None, 0, []
    device = next(network.parameters()).device
    for t in range(len(clip)):
        truth = fit_crop(shape, clip.landmarks[t:t + 1])
        if crop is None or (clip.found[t] and lost(crop, truth)):
            losses += crop is not None
            crop = truth
        out = {k: v.cpu()
               for k, v in network(sample_crops(clip.frame(t), crop, network.framing).to(device) * 2 - 1).items()}
        points = crop_to_image(crop, out["landmarks"])
        rows.append((points[0], torch.sigmoid(out["face"])[0], out["controls"][0]))
        crop = fit_crop(shape, points)
    return (*(torch.stack(column) for column in zip(*rows)), losses)


def apertures(points):
    """Opening of the eyes and of the mouth, and height of the brows [n,3], of landmarks [n,175,2], in eye distances."""
    gap = lambda a, b: (points[:, lp.POSITION[a]] - points[:, lp.POSITION[b]]).norm(dim=1)
    eyes = gap(33, 263)
    return torch.stack([gap(159, 145) + gap(386, 374), gap(13, 14), gap(105, 159) + gap(334, 386)], 1) / eyes[:, None]


def correlation(pairs):
    """Of columns pooled over clips, every clip's mean removed, because levels differ from person to person."""
    a, b = (torch.cat([x - x.mean(0) for x in column]) for column in zip(*pairs))
    return (a * b).sum(0) / (a.norm(dim=0) * b.norm(dim=0)).clamp(min=1e-6)


def evaluate(network, clips):
    """{clip: landmark error in outer eye corner distances}, and how well openings and controls go with the
    teacher's."""
    network.eval()
    report, openings, controls, losses, faces = {}, [], [], 0, []
    for clip in clips:
        points, face, answers, lost_count = follow(network, clip)
        rows = clip.found
        report[clip.name] = float(landmark_error(points, clip.landmarks)[rows].mean())
        openings.append((apertures(points[rows]), apertures(clip.landmarks[rows])))
        controls.append((answers[rows], clip.controls[rows]))
        faces.append(face[rows])
        losses += lost_count
    errors = list(report.values())
    report.update(mean=sum(errors) / len(errors), worst=max(errors), losses=losses,
                  face=float((torch.cat(faces) > 0.5).float().mean()))
    report.update(zip(("eyes", "mouth", "brows"), correlation(openings).tolist()))
    r = correlation(controls)
    report.update({name: float(r[CONTROLS.index(name)]) for name in WATCHED})
    network.train()
    return report
