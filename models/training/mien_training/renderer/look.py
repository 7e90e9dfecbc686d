"""Appearance of a person, drawn at random within a split."""
from dataclasses import dataclass

import numpy as np

from mien_training.renderer import make_up, wrinkles
from mien_training.renderer.assets import names, portrait_skins, skin_table

HAIR_COLOURS = np.array([[28, 22, 20], [45, 30, 22], [74, 48, 32], [104, 70, 44], [146, 104, 62], [190, 150, 96],
                         [150, 148, 146], [200, 196, 190], [112, 52, 30]]) / 255  # sRGB
DARK, GREY = slice(0, 3), slice(6, 8)
IDENTITY_SPREAD = 0.75  # standard deviation of identity coefficients
LIGHT_SKIN, DARK_SKIN = np.array([0.55, 0.30, 0.21]), np.array([0.14, 0.06, 0.035])  # linear
PHOTOGRAPHED = 0.65  # share of training faces with the skin of a portrait
# Relative frequency of these portraits' skins; 1 for the others.
GROUP_SHARE = {"members of Congress": 1.5, "sfhq": 1.5, "cc0": 0.5, "GRID": 0.2}
# Mean log lightness added to the skin of the pack that continues a portrait's skin: the pack has only pale and dark
# skins.
GROUP_LIGHTNESS = {"Indian": -0.5, "Southeast Asian": -0.35, "Latino Hispanic": -0.3, "Middle Eastern": -0.2,
                   "East Asian": -0.05}
DARK_HAIRED = ("Indian", "Southeast Asian", "East Asian", "Middle Eastern", "Black", "Latino Hispanic")
EYE_HIDING = ("bob01", "bob02", "short03")  # their fringe covers one eye


@dataclass
class Look:
    identity: np.ndarray                 # f32 [100]
    group: str = ""                      # of the portrait whose skin this is
    skins: tuple = ()                    # two names of skins
    skin_mix: float = 0.0                # share of the second
    tone: np.ndarray = None              # gain of linear red, green, blue [3]
    contrast: float = 1.0                # exponent of the linear albedo
    saturation: float = 1.0
    shine: float = 0.1                   # specular strength of skin
    wrinkles: object = None              # wrinkles.Wrinkles
    make_up: tuple = ()                  # make_up.MakeUp
    brow: str = None
    brow_opacity: float = 0.9
    beard: str = None
    hair_colour: np.ndarray = None       # sRGB [3]
    iris: str = None
    iris_gain: np.ndarray = None
    sclera: str = "natural"
    lashes: bool = True
    hair: str = None
    hat: tuple = None                    # mesh, texture
    glasses: str = None
    frame_colour: np.ndarray = None      # sRGB [3]
    lens_opacity: float = 0.06
    cloth_colour: np.ndarray = None      # linear [3]
    collar: float = -16.0                # y of the cloth's edge at z = 0, cm

    def skin_colour(self):
        """Roughly the skin's linear colour [3]."""
        first, second = (DARK_SKIN if "dark" in name else LIGHT_SKIN for name in self.skins)
        return (first + self.skin_mix * (second - first)) * self.tone


def sample_skin(look, rng, split):
    """Skins are mixed half of the time; tone, contrast and saturation spread them further."""
    choice = names("skins", split)
    plain = [n for n in choice if "suit" not in n]
    if split == "train" and portrait_skins() and rng.random() < PHOTOGRAPHED:
        groups = list(portrait_skins())
        share = np.array([GROUP_SHARE.get(group, 1.0) for group in groups])
        look.group = str(rng.choice(groups, p=share / share.sum()))
        choice = portrait_skins()[look.group]
    first = choice[rng.integers(len(choice))]
    look.skins = (first, plain[rng.integers(len(plain))])
    look.skin_mix = 0.0 if "suit" in first or "+" in first or rng.random() < 0.4 else rng.uniform(0.15, 0.85)
    usual = 0.15 if "dark" in first else GROUP_LIGHTNESS.get(look.group, 0.0)
    lightness = np.exp(rng.normal(usual, 0.25))
    look.tone = lightness * np.exp(rng.normal(0, 0.05, 3) + rng.normal(0, 0.05) * np.array([1, 0, -1]))
    look.contrast, look.saturation = rng.uniform(0.85, 1.2), rng.uniform(0.6, 1.2)
    look.shine = rng.uniform(0.02, 0.35)


def sample_hair_colour(rng, skin, group):
    if rng.random() < 0.05:
        return rng.uniform(0.05, 0.8, 3)
    pool = HAIR_COLOURS
    if "old" in skin and rng.random() < 0.7:
        pool = HAIR_COLOURS[GREY]
    elif ("dark" in skin or group in DARK_HAIRED) and rng.random() < 0.85:
        pool = HAIR_COLOURS[DARK]
    return np.clip(pool[rng.integers(len(pool))] * np.exp(rng.normal(0, 0.15)) + rng.normal(0, 0.015, 3), 0.02, 0.9)


def sample_hair(look, rng, split):
    kind = rng.random()
    if "suit" in look.skins[0] or kind < 0.15:
        return
    if kind < 0.20:
        look.hat = (rng.choice(names("hats")),
                    rng.choice(["fedora_texture", "fedora_texture_black", "fedora_texture_grey"]))
        return
    choice = names("hair", split)
    weight = np.array([0.3 if n.removesuffix("_mirror") in EYE_HIDING else 1.0 for n in choice])
    look.hair = rng.choice(choice, p=weight / weight.sum())


def sample_face_hair(look, rng):
    """Brows and beards, unless they are painted on the skin."""
    skin = look.skins[0]
    if "+" in skin:
        return
    if "suit" not in skin:
        look.brow, look.brow_opacity = rng.choice(names("brows")), rng.uniform(0.45, 1)
    if skin_table()[skin]["sex"] == "male" and rng.random() < 0.4:
        look.beard = rng.choice(names("beards"))


def sample_eyes(look, rng):
    irises = names("irises")
    if ("dark" in look.skins[0] or look.group in DARK_HAIRED) and rng.random() < 0.9:
        irises = [n for n in irises if "brown" in n or "hazel" in n]
    look.iris = rng.choice(irises)
    look.iris_gain = rng.uniform(0.6, 1.3) * np.exp(rng.normal(0, 0.05, 3))
    look.sclera = rng.choice(["white", "natural", "bloodshot"])
    look.lashes = rng.random() < 0.85


def sample_glasses(look, rng):
    if rng.random() >= 0.2:
        return
    look.glasses = rng.choice(names("glasses"))
    if rng.random() < 0.6:
        look.frame_colour = rng.uniform(0.02, 0.25, 3) if rng.random() < 0.7 else rng.uniform(0.1, 0.8, 3)
    look.lens_opacity = rng.uniform(0.7, 0.95) if rng.random() < 0.15 else rng.uniform(0, 0.12)


def sample_identity(rng):
    """Coefficients of a face's shape, f32 [100]."""
    return np.float32(np.clip(rng.standard_normal(100), -2, 2) * IDENTITY_SPREAD)


def sample(rng, split):
    """A random Look from the assets of split 'train', 'val' or 'test'."""
    look = Look(identity=sample_identity(rng))
    sample_skin(look, rng, split)
    look.hair_colour = sample_hair_colour(rng, look.skins[0], look.group)
    sample_face_hair(look, rng)
    sample_eyes(look, rng)
    sample_hair(look, rng, split)
    sample_glasses(look, rng)
    look.wrinkles = wrinkles.sample(rng, "old" in look.skins[0])
    look.make_up = make_up.sample(rng, skin_table()[look.skins[0].partition("+")[0]]["sex"])
    look.cloth_colour = rng.uniform(0.01, 0.7) * np.exp(rng.normal(0, 0.5, 3))
    look.collar = rng.uniform(-19, -12.5)
    return look
