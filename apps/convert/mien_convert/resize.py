"""Resize and Upsample: a map in another size."""
import math

import numpy as np

from .errors import Refused, require, require_room
from .operands import constant

SAMPLINGS = {"round_prefer_floor": "round_half_down", "round_prefer_ceil": "round_half_up", "floor": "floor",
             "ceil": "ceil"}


def upsample(t, node):
    """Until opset 9."""
    scales = constant(node.inputs[1], "scales") if len(node.inputs) > 1 else node.attributes["scales"]
    return [resized(t, node, node.inputs[0], scales, None, "asymmetric", "floor")]


def resize(t, node):
    inputs, given = [*node.inputs, None, None], node.attributes
    if t.opset < 11:
        return [resized(t, node, inputs[0], constant(inputs[1], "scales"), None, "asymmetric", "floor")]
    require(not given.get("antialias", 0), "antialias; export the model without it")
    scales, sizes = constant(inputs[2], "scales"), constant(inputs[3], "sizes")
    scales = scales if scales is not None and scales.size else None
    grid = given.get("coordinate_transformation_mode", "half_pixel")
    nearest = given.get("nearest_mode", "round_prefer_floor")
    if grid == "tf_half_pixel_for_nn":  # half a pixel further
        require(nearest == "floor", f"{grid} with the nearest_mode {nearest!r}; floor is possible")
        grid, nearest = "half_pixel", "round_prefer_ceil"
    return [resized(t, node, inputs[0], scales, sizes, grid, nearest)]


def resized(t, node, x, scales, sizes, grid, nearest):
    mode, rank = node.attributes.get("mode", "nearest"), len(x.shape)
    require(mode in ("nearest", "linear", "bilinear"), f"the mode {mode!r}; nearest and linear are possible")
    require(rank in (3, 4), f"it resizes {list(x.shape)}; maps of rows and columns are possible")
    axes = [axis % rank for axis in node.attributes.get("axes", range(rank))]
    shape = list(x.shape)
    for axis, size in zip(axes, wanted_sizes(node, [x.shape[axis] for axis in axes], scales, sizes, grid)):
        shape[axis] = size
    require(shape[:2] == list(x.shape[:2]), f"it resizes {list(x.shape)} to {shape}; rows and columns are possible")
    require_room(*shape)
    if tuple(shape) == x.shape:
        return x
    h, w = shape[2:] if rank == 4 else (1, shape[2])
    layer = t.as_map(x if rank == 4 else x.moved(lambda part: part[:, :, None, :]))
    sampling = SAMPLINGS[nearest] if mode == "nearest" else "bilinear"
    y = t.layer("resize", [layer], (h, w, layer.shape[2]), height=h, width=w, grid=grid_of(grid, layer.shape, (h, w)),
                sampling=sampling)
    return t.whole(y, len(x.at)).moved(lambda part: part.reshape(shape))


def wanted_sizes(node, old, scales, sizes, grid):
    policy = node.attributes.get("keep_aspect_ratio_policy", "stretch")
    if sizes is not None and sizes.size:
        new = [int(n) for n in sizes.reshape(-1)]
        require(len(new) == len(old) and min(new) > 0, f"sizes {new} for {old}")
        if policy != "stretch":
            scale = (min if policy == "not_larger" else max)(b / a for a, b in zip(old, new))
            new = [int(math.floor(a * scale + 0.5)) for a in old]
            require(all(abs(a * scale - b) < 1e-6 for a, b in zip(old, new)),
                    f"keep_aspect_ratio_policy {policy!r} that rounds {old} to {new}")
        return new
    require(scales is not None, "neither scales nor sizes")
    scales = np.asarray(scales, np.float64).reshape(-1)
    require(len(scales) == len(old) and (scales > 0).all(), f"scales {scales.tolist()} for {old}")
    new = [int(math.floor(a * scale + 1e-6)) for a, scale in zip(old, scales)]
    exact = all(abs(a * scale - b) < 1e-4 for a, b, scale in zip(old, new, scales))
    require(min(new) > 0 and (exact or grid == "align_corners"),
            f"scales {scales.tolist()} of {old}, whose products are not integers; give sizes, or another input size "
            "(--shape)")
    return new


def grid_of(name, old, new):
    """The engine defines grids by sizes, so ONNX's symmetric half pixels are the same."""
    if name == "half_pixel_symmetric":
        return "half_pixel"
    if name == "pytorch_half_pixel":  # the first sample if there is only one, otherwise half pixels
        alone = [a != b and b == 1 for a, b in zip(old, new)]
        require(not any(alone) or all(b == 1 for b in new), f"{name} of {list(old[:2])} to {list(new)}")
        return "asymmetric" if any(alone) else "half_pixel"
    if name not in ("half_pixel", "asymmetric", "align_corners"):
        raise Refused(
            f"the coordinate_transformation_mode {name!r}; half_pixel, asymmetric and align_corners are possible")
    return name
