"""Fits the rig to the teacher's landmarks of the training portraits, all portraits at once.

usage: python3 -m mien_training.renderer.portrait_fit
Writes $MIEN_CACHE/portrait_skins/fits.npz: name [n]; identity [n,100]; controls [n,52]; rotation [n,3,3] and
translation [n,3] (cm) in camera space; f_px [n]; residual [n], mean distance of the landmarks relative to that of the
outer eye corners. Least squares on the 175 points with Gaussian priors: the rig's own for identity (Blanz and Vetter
1999), the teacher's blendshapes for controls.
"""
import numpy as np
import torch

from mien_convert.atomic_files import whole
from mien_training.data import landmark_points as lp
from mien_training.data.faces import Portraits
from mien_training.data.head_pose import orthonormalise
from mien_training.paths import cache
from mien_training.renderer.rig import Rig

DISTANCE = 150.0        # cm to the camera: portraits are taken from some way off
IDENTITY_PRIOR, CONTROL_PRIOR = 4e-4, 2e-3
STEPS, RATE = 500, 0.02


class Model:
    """The rig's landmarks as linear functions of identity and controls."""

    def __init__(self, rig):
        self.neutral = torch.from_numpy(rig.landmarks(rig.neutral))
        self.identity, self.controls = (torch.from_numpy(rig.landmark_shapes(s))
                                        for s in (rig.identity_shapes, rig.control_shapes))

    def points(self, identity, controls):
        return self.neutral + torch.einsum("nk,kpc->npc", identity, self.identity) + \
            torch.einsum("nk,kpc->npc", controls, self.controls)


def project(points, rotation, shift, scale):
    """Pixels relative to the centre of the image; `scale` is pixels per cm at the origin of the head."""
    turned = points @ rotation.transpose(1, 2)
    near = DISTANCE / (DISTANCE - turned[..., 2:])
    return (turned[..., :2] * torch.tensor([1.0, -1.0]) * scale[:, None, None] + shift[:, None]) * near


def fit(model, target, teacher):
    """Parameters that put the rig's landmarks on `target` [n,175,2] (pixels from the centre of the image)."""
    n = len(target)
    eyes = (target[:, lp.OUTER_EYE_CORNERS[0]] - target[:, lp.OUTER_EYE_CORNERS[1]]).norm(dim=1)
    six = torch.tensor([1.0, 0, 0, 0, 1, 0]).repeat(n, 1).requires_grad_()
    log_scale = (eyes / 9.5).log().requires_grad_()
    shift = torch.zeros(n, 2, requires_grad=True)  # of the middle of the points, in eye distances
    identity = torch.zeros(n, 100, requires_grad=True)
    controls = teacher.clone().requires_grad_()
    parameters = [six, log_scale, shift, identity, controls]
    optimiser = torch.optim.Adam([{"params": parameters[:3]}, {"params": parameters[3:], "lr": 2 * RATE}], RATE)
    schedule = torch.optim.lr_scheduler.CosineAnnealingLR(optimiser, STEPS)
    middle = target.mean(1)
    for _ in range(STEPS):
        found = project(model.points(identity, controls.clamp(0, 1)), orthonormalise(six),
                        middle + shift * eyes[:, None], log_scale.exp())
        gap = (found - target) / eyes[:, None, None]
        data_term = torch.nn.functional.huber_loss(gap, torch.zeros_like(gap), delta=0.02,
                                                   reduction="none").mean((1, 2))
        prior = IDENTITY_PRIOR * identity.square().mean(1) + CONTROL_PRIOR * (controls - teacher).square().mean(1)
        optimiser.zero_grad()
        (data_term * 100 + prior * 100 / 10).sum().backward()
        optimiser.step()
        schedule.step()
    with torch.no_grad():
        return dict(identity=identity, controls=controls.clamp(0, 1), rotation=orthonormalise(six),
                    scale=log_scale.exp(), shift=middle + shift * eyes[:, None], residual=gap.norm(dim=-1).mean(1))


def camera_pose(found):
    """Translation [n,3] and focal length [n] equivalent to the perspective of `project`."""
    f_px = found["scale"] * DISTANCE
    xy = found["shift"] * torch.tensor([1.0, -1.0]) / found["scale"][:, None]
    return torch.cat([xy, torch.full((len(xy), 1), -DISTANCE)], 1), f_px


def main():
    photographs = Portraits("train")
    target = torch.from_numpy(photographs.points - photographs.size_wh[:, None] / 2)
    teacher = torch.from_numpy(photographs.labels.controls)
    found = fit(Model(Rig()), target, teacher)
    translation, f_px = camera_pose(found)
    out = cache() / "portrait_skins"
    out.mkdir(parents=True, exist_ok=True)
    with whole(out / "fits.npz") as file:
        np.savez(file, name=photographs.names, translation=translation.numpy(), f_px=f_px.numpy(),
                 size_wh=photographs.size_wh,
                 **{k: found[k].detach().numpy() for k in ("identity", "controls", "rotation", "residual")})
    r = found["residual"]
    print(
        f"{len(target)} portraits, residual median {100 * r.median():.2f} %, 95th percentile "
        f"{100 * r.quantile(0.95):.2f} %")
    print("identity rms", found["identity"].square().mean().sqrt().item(),
          "controls moved", (found["controls"] - teacher).abs().mean().item())


if __name__ == "__main__":
    main()
