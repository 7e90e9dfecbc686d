"""Head pose in the camera to and from the prediction of the pose decoder, relative to the crop.

Camera space: x right, y up, z towards the viewer; the camera looks along -z, principal point at the image centre. A
crop is (cx, cy, s, theta): p_image = s Rot(theta) (p_crop - 0.5) + (cx, cy), pixels, y down. Prediction [9]: first two
columns of R_crop (Zhou et al. 2019, "On the Continuity of Rotation Representations in Neural Networks"), the projected
head origin minus 0.5 in crop coordinates [2], log(f_px / Z * 0.2 m / s). R_camera = R_ray Rz(-theta) R_crop, R_ray the
shortest rotation from (0,0,-1) to the ray through (cx, cy).
"""
import torch

REFERENCE_M = 0.2  # a head of this size at the scale of the crop has log scale 0


def rotate(xy, theta):
    """Rotates points [...,2] by theta [...], from x towards y."""
    c, s = torch.cos(theta), torch.sin(theta)
    return torch.stack([c * xy[..., 0] - s * xy[..., 1], s * xy[..., 0] + c * xy[..., 1]], -1)


def rotation_z(angle):
    c, s, zero = torch.cos(angle), torch.sin(angle), torch.zeros_like(angle)
    rows = [c, -s, zero, s, c, zero, zero, zero, torch.ones_like(angle)]
    return torch.stack(rows, -1).unflatten(-1, (3, 3))


def ray_rotation(centre, f_px, camera_wh):
    """Shortest rotation [n,3,3] taking the optical axis (0,0,-1) to the ray through pixel `centre` [n,2]."""
    xy = (centre - camera_wh / 2) / f_px[..., None]
    ray = torch.stack([xy[..., 0], -xy[..., 1], -torch.ones_like(f_px)], -1)
    x, y, z = torch.nn.functional.normalize(ray, dim=-1).unbind(-1)
    # Rodrigues' formula for the axis (0,0,-1) x ray = (y,-x,0), cosine = -z > 0.
    k = 1 / (1 - z)
    rows = [1 - k * x * x, -k * x * y, -x, -k * x * y, 1 - k * y * y, -y, x, y, -z]
    return torch.stack(rows, -1).unflatten(-1, (3, 3))


def orthonormalise(six):
    """Rotation [...,3,3] from its first two columns [...,6] by Gram-Schmidt."""
    a = torch.nn.functional.normalize(six[..., :3], dim=-1)
    b = six[..., 3:] - (a * six[..., 3:]).sum(-1, keepdim=True) * a
    b = torch.nn.functional.normalize(b, dim=-1)
    return torch.stack([a, b, torch.cross(a, b, dim=-1)], -1)


def to_crop(rotation, translation, f_px, camera_wh, crop):
    """Camera pose -> prediction [n,9]. rotation [n,3,3], translation [n,3] m, f_px [n], camera_wh [n,2], crop [n,4]."""
    centre, side, theta = crop[..., :2], crop[..., 2], crop[..., 3]
    frame = ray_rotation(centre, f_px, camera_wh) @ rotation_z(-theta)
    r = frame.transpose(-1, -2) @ rotation
    x, y, distance = translation[..., 0], translation[..., 1], -translation[..., 2]
    pixel = camera_wh / 2 + torch.stack([x, -y], -1) * (f_px / distance)[..., None]
    offset = rotate(pixel - centre, -theta) / side[..., None]
    log_scale = torch.log(f_px / distance * REFERENCE_M / side)
    return torch.cat([r[..., :, 0], r[..., :, 1], offset, log_scale[..., None]], -1)


def angle_between(a, b):
    """Angle [...] in radians of the rotation between rotations [...,3,3]."""
    trace = (a * b).sum((-1, -2))
    return torch.acos(((trace - 1) / 2).clamp(-1, 1))
