"""Random facial expressions: control vectors of stills and sequences.

A face is the sum of independent regions (mouth, cheeks and nose, brows, eyelids, gaze). Each is drawn from a mixture of
single units, sparse combinations and familiar expressions; `legalise` then removes impossible combinations. A sequence
moves each region from pose to pose with minimum-jerk easing, and adds blinks, saccades, speech and recorded curves. All
functions take a numpy Generator and are deterministic.
"""
import re

import numpy as np

from mien_training.data import recordings

CONTROLS = """
eyeBlinkLeft eyeLookDownLeft eyeLookInLeft eyeLookOutLeft eyeLookUpLeft eyeSquintLeft eyeWideLeft
eyeBlinkRight eyeLookDownRight eyeLookInRight eyeLookOutRight eyeLookUpRight eyeSquintRight eyeWideRight
jawForward jawLeft jawRight jawOpen mouthClose mouthFunnel mouthPucker mouthLeft mouthRight
mouthSmileLeft mouthSmileRight mouthFrownLeft mouthFrownRight mouthDimpleLeft mouthDimpleRight
mouthStretchLeft mouthStretchRight mouthRollLower mouthRollUpper mouthShrugLower mouthShrugUpper
mouthPressLeft mouthPressRight mouthLowerDownLeft mouthLowerDownRight mouthUpperUpLeft mouthUpperUpRight
browDownLeft browDownRight browInnerUp browOuterUpLeft browOuterUpRight
cheekPuff cheekSquintLeft cheekSquintRight noseSneerLeft noseSneerRight tongueOut
""".split()
NAMES = tuple(CONTROLS)
INDEX = {name: i for i, name in enumerate(CONTROLS)}
SWAPPED = {"Left": "Right", "Right": "Left"}
MIRROR = [INDEX[re.sub("(Left|Right)$", lambda m: SWAPPED[m[0]], n)] for n in CONTROLS]  # of a mirrored face
PAIRED = [n[:-4] for n in CONTROLS if n.endswith("Left") and n[:-4] + "Right" in INDEX]
PAIRED_LEFT, PAIRED_RIGHT = ([INDEX[n + side] for n in PAIRED] for side in ("Left", "Right"))

LEANING = [[u for u in PAIRED if u.startswith(region)] for region in ("mouth", "brow", "cheek", "nose")] + [
    ["eyeBlink", "eyeWide", "eyeSquint"]]  # pairs that lean to one side together

# Units are drawn by weight; a sided one (jaw, mouth) counts twice because each side gets half of its draws.
MOUTH_UNITS = {
    "jawOpen": 1.2, "jawForward": 1.5, "jaw": 3.2, "mouth": 3.2, "mouthClose": 1.5, "mouthFunnel": 1.2,
    "mouthPucker": 1.2, "mouthSmile": 1.5, "mouthFrown": 1.4, "mouthDimple": 1.5, "mouthStretch": 1.2,
    "mouthRollLower": 1.2, "mouthRollUpper": 1.5, "mouthShrugLower": 1.2, "mouthShrugUpper": 1.3,
    "mouthPress": 1.2, "mouthLowerDown": 1.4, "mouthUpperUp": 1.2, "cheekPuff": 1.4, "tongueOut": 1.5,
}
ALONE = 0.25  # share of sequences in which one unit moves at a time
# shares of lessons that follow the phone's recordings, and that go from still face to still face
PHONE, POSED = 0.15, 0.25
LEANING_SHARE, APART_SHARE = 0.6, 0.4  # of those still faces
SIDED = {"jaw", "mouth"}
UPPER_UNITS = ["cheekSquint", "noseSneer"]
BROW_UNITS = ["browDown", "browInnerUp", "browOuterUp"]
LID_UNITS = ["eyeBlink", "eyeWide", "eyeSquint"]
GAZE_UNITS = [unit for unit in PAIRED if unit.startswith("eyeLook")]
# regions, and how often one of each moves
APART = [(list(MOUTH_UNITS), 0.75), (UPPER_UNITS, 0.35), (BROW_UNITS, 0.5), (LID_UNITS, 0.45)]
ONE_SIDED, ONE_EYED = 0.65, 0.4  # share of paired units, and of gazes, of faces whose units move apart

# Familiar expressions: unit -> (low, high) of its amplitude.
EXPRESSIONS = {
    "smile": dict(mouthSmile=(.3, 1), cheekSquint=(.1, .9), eyeSquint=(0, .6), mouthDimple=(0, .4)),
    "laugh": dict(mouthSmile=(.5, 1), jawOpen=(.2, .8), cheekSquint=(.4, 1), eyeSquint=(.2, .9),
                  mouthUpperUp=(.1, .6), mouthLowerDown=(0, .5)),
    "surprise": dict(browInnerUp=(.4, 1), browOuterUp=(.4, 1), eyeWide=(.3, 1), jawOpen=(.15, .8)),
    "anger": dict(browDown=(.4, 1), noseSneer=(.1, .8), mouthPress=(.1, .8), eyeSquint=(.1, .7), mouthFrown=(0, .5)),
    "disgust": dict(noseSneer=(.4, 1), mouthUpperUp=(.3, .9), browDown=(.2, .8), cheekSquint=(.1, .7),
                    mouthShrugLower=(0, .6)),
    "sad": dict(browInnerUp=(.4, 1), mouthFrown=(.3, 1), mouthShrugLower=(.1, .8), eyeSquint=(0, .4)),
    "fear": dict(browInnerUp=(.4, 1), browOuterUp=(.1, .6), eyeWide=(.4, 1), mouthStretch=(.3, 1), jawOpen=(.05, .5)),
    "contempt": dict(mouthDimple=(.3, 1), mouthPress=(.1, .6)),
    "doubt": dict(mouthShrugLower=(.3, 1), mouthShrugUpper=(.2, .9), browOuterUp=(.2, .9), mouthPress=(0, .4)),
    "kiss": dict(mouthPucker=(.4, 1), mouthFunnel=(0, .4), jawForward=(0, .3)),
    "puff": dict(cheekPuff=(.4, 1), mouthPress=(.1, .6), mouthPucker=(0, .3)),
    "snarl": dict(mouthUpperUp=(.4, 1), noseSneer=(.3, 1), mouthLowerDown=(.1, .7), jawOpen=(0, .4)),
    "scream": dict(jawOpen=(.5, 1), mouthStretch=(.2, .8), eyeSquint=(.2, .8), browDown=(.2, .9)),
    "tongue": dict(tongueOut=(.3, 1), jawOpen=(.45, .8)),
    "lip bite": dict(mouthRollLower=(.4, 1), mouthRollUpper=(0, .6), mouthPress=(0, .4)),
}
# Shapes of the mouth while speaking, in the same form.
VISEMES = [
    dict(jawOpen=(.2, .6), mouthLowerDown=(0, .4), mouthUpperUp=(0, .25)),           # a
    dict(jawOpen=(.08, .3), mouthStretch=(.05, .5), mouthSmile=(0, .35), mouthLowerDown=(0, .4)),  # e, i
    dict(jawOpen=(.12, .4), mouthFunnel=(.2, .8)),                                   # o
    dict(jawOpen=(.04, .2), mouthPucker=(.3, .9), mouthFunnel=(0, .4)),              # u, w
    dict(jawOpen=(.02, .25), mouthClose=(.02, .25), mouthPress=(.1, .6), mouthRollLower=(0, .5),
         mouthRollUpper=(0, .5)),                                                    # m, b, p
    dict(jawOpen=(.02, .15), mouthRollLower=(.15, .6), mouthUpperUp=(.05, .4)),      # f, v
    dict(jawOpen=(.02, .12), mouthShrugUpper=(.05, .4), mouthStretch=(0, .3), mouthLowerDown=(.05, .4)),  # s
    dict(jawOpen=(.03, .2), mouthFunnel=(.15, .6), mouthShrugUpper=(0, .3), jawForward=(0, .3)),   # sh
    dict(jawOpen=(.05, .25)),                                                        # t, d, n, l
    dict(),                                                                          # pause
]


def zeros():
    return np.zeros(len(CONTROLS), np.float32)


def amplitude(rng):
    """Amplitude of a unit: uniform over the range, with extra weight on clear activations."""
    return rng.uniform(0.02, 1) if rng.random() < 0.5 else rng.uniform(0.35, 1)


def asymmetry(rng):
    """Gains (left, right): mostly nearly equal, but clearly unequal or one-sided often enough for networks to
    distinguish sides."""
    kind = rng.random()
    if kind < 0.6:
        return 1 - rng.uniform(0, 0.08, 2)
    weak = rng.uniform(0.3, 0.9) if kind < 0.75 else rng.uniform(0, 0.15)
    return (1.0, weak) if rng.random() < 0.5 else (weak, 1.0)


def add_unit(out, rng, unit, value):
    """Raises a unit in `out`: both sides of a paired one, one random side of jaw and mouth."""
    if unit in SIDED:
        out[INDEX[unit + rng.choice(["Left", "Right"])]] = value
    elif unit in PAIRED:
        left, right = asymmetry(rng)
        for side, gain in (("Left", left), ("Right", right)):
            out[INDEX[unit + side]] = max(out[INDEX[unit + side]], value * gain)
    else:
        out[INDEX[unit]] = max(out[INDEX[unit]], value)


def from_ranges(rng, ranges):
    out = zeros()
    gain = rng.uniform(0.5, 1) if rng.random() < 0.4 else 1.0
    for unit, (low, high) in ranges.items():
        add_unit(out, rng, unit, gain * rng.uniform(low, high))
    return out


def sparse_mouth(rng, units):
    """A few random mouth units; opens the jaw for those that need it."""
    names, weights = list(MOUTH_UNITS), np.array(list(MOUTH_UNITS.values()))
    out = zeros()
    for unit in rng.choice(names, units, replace=False, p=weights / weights.sum()):
        value = amplitude(rng)
        add_unit(out, rng, unit, value)
        if unit == "tongueOut":
            add_unit(out, rng, "jawOpen", rng.uniform(0.45, 0.9))
        if unit == "mouthClose":
            add_unit(out, rng, "jawOpen", min(1.0, value * rng.uniform(1.0, 1.4)))
    return out


def sample_viseme(rng):
    return from_ranges(rng, VISEMES[rng.integers(len(VISEMES))])


def sample_expression(rng):
    return from_ranges(rng, EXPRESSIONS[rng.choice(list(EXPRESSIONS))])


def sample_mouth(rng):
    kind = rng.random()
    if kind < 0.08:
        return zeros()
    if kind < 0.17:
        return sample_viseme(rng)
    return sparse_mouth(rng, rng.choice([1, 2, 3, 4], p=[.12, .2, .3, .38]))


def sample_upper(rng):
    """Cheeks, nose and brows."""
    out = zeros()
    for unit in UPPER_UNITS:
        if rng.random() < 0.16:
            add_unit(out, rng, unit, amplitude(rng))
    for unit in BROW_UNITS:
        if rng.random() < 0.24:
            add_unit(out, rng, unit, amplitude(rng))
    return out


def sample_lids(rng):
    """Lids that are open, half or fully closed, wide or squinting; sometimes a wink."""
    out = zeros()
    kind = rng.random()
    if kind < 0.22:
        add_unit(out, rng, "eyeBlink", rng.uniform(0.8, 1))
    elif kind < 0.40:
        add_unit(out, rng, "eyeBlink", rng.uniform(0.05, 0.8))
    elif kind < 0.58:
        add_unit(out, rng, "eyeWide", amplitude(rng))
    if rng.random() < 0.22:
        add_unit(out, rng, "eyeSquint", amplitude(rng))
    return out


def gaze(horizontal, vertical):
    """Both eyes turned the same way; horizontal -1..1 to the subject's left, vertical -1..1 up."""
    out = zeros()
    outer, inner = ("Left", "Right") if horizontal > 0 else ("Right", "Left")
    out[INDEX["eyeLookOut" + outer]] = out[INDEX["eyeLookIn" + inner]] = abs(horizontal)
    for side in ("Left", "Right"):
        out[INDEX[("eyeLookUp" if vertical > 0 else "eyeLookDown") + side]] = abs(vertical)
    return out


def sample_gaze(rng):
    if rng.random() < 0.25:
        return zeros()
    horizontal, vertical = rng.uniform(-1, 1, 2) * rng.choice([[0.9, 0.9], [0.9, 0.2], [0.2, 0.9]])
    return gaze(horizontal, vertical)


def weaken(c, names, factor):
    for name in names:
        c[..., INDEX[name]] *= factor


def both(stem):
    return stem + "Left", stem + "Right"


def legalise(c):
    """Removes impossible combinations; c f32[..., 52]. Each rule is continuous, so curves stay smooth."""
    c = np.clip(c, 0, 1)
    get = lambda name: c[..., INDEX[name]].copy()
    opposites = [("jawLeft", "jawRight"), ("mouthLeft", "mouthRight")]
    for side in ("Left", "Right"):
        opposites += [("eyeLookIn" + side, "eyeLookOut" + side), ("eyeLookUp" + side, "eyeLookDown" + side),
                      ("mouthSmile" + side, "mouthFrown" + side), ("eyeWide" + side, "eyeSquint" + side)]
        weaken(c, ["eyeWide" + side], 1 - get("eyeBlink" + side))
        # The rig closes the lid when the eye looks down, so both at once would close it twice.
        weaken(c, ["eyeLookDown" + side], 1 - 0.85 * get("eyeBlink" + side))
        weaken(c, ["browOuterUp" + side], 1 - 0.6 * get("browDown" + side))
    for a, b in opposites:
        common = np.minimum(get(a), get(b))
        c[..., INDEX[a]] -= common
        c[..., INDEX[b]] -= common
    rounded = np.maximum(get("mouthPucker"), get("mouthFunnel"))
    weaken(c, both("mouthSmile") + both("mouthStretch") + both("mouthDimple"), 1 - 0.75 * rounded)
    weaken(c, both("mouthLowerDown") + ("mouthFunnel",), 1 - 0.8 * get("mouthRollLower"))
    weaken(c, both("mouthUpperUp"), 1 - 0.8 * get("mouthRollUpper"))
    weaken(c, ("jawOpen", "tongueOut", "mouthFunnel"), 1 - 0.85 * get("cheekPuff"))
    weaken(c, both("mouthPress"), 1 - 0.8 * np.maximum(get("jawOpen") - get("mouthClose"), 0))
    tongue = np.clip((get("jawOpen") - 0.35) / 0.05, 0, 1) * get("tongueOut")
    out = np.clip(tongue / 0.1, 0, 1)
    c[..., INDEX["tongueOut"]] = tongue
    c[..., INDEX["jawOpen"]] -= out * np.maximum(get("jawOpen") - 0.9, 0)
    weaken(c, ("mouthClose", "mouthRollLower", "mouthRollUpper", "mouthPucker", "mouthShrugLower"), 1 - 0.9 * out)
    c[..., INDEX["mouthClose"]] = np.minimum(get("mouthClose"), get("jawOpen"))
    return np.clip(c, 0, 1).astype(np.float32)


def add_solo(out, rng, unit, value, one_sided):
    """Raises one unit in `out`, with no other but the jaw where it needs it; a paired one on one side alone in a share
    of cases."""
    if unit in PAIRED and unit not in SIDED and rng.random() < one_sided:
        out[INDEX[unit + rng.choice(["Left", "Right"])]] = value
        return
    add_unit(out, rng, unit, value)
    if unit == "tongueOut":
        add_unit(out, rng, "jawOpen", rng.uniform(0.45, 0.9))
    if unit == "mouthClose":
        add_unit(out, rng, "jawOpen", value)


def sample_solo(rng):
    """One unit through its whole range on an otherwise neutral face, a paired one as often on one side as on both."""
    unit = rng.choice(list(MOUTH_UNITS) + UPPER_UNITS + BROW_UNITS + LID_UNITS + ["gaze"])
    value = rng.uniform(0, 1)
    if unit == "gaze":
        return sample_gaze(rng)
    out = zeros()
    add_solo(out, rng, unit, value, 0.5)
    return out


def sample_apart(rng):
    """At most one unit of each region, mostly on one side, sometimes the gaze of one eye."""
    out = zeros()
    for units, share in APART:
        if rng.random() < share:
            add_solo(out, rng, rng.choice(units), amplitude(rng), ONE_SIDED)
    if rng.random() < ONE_EYED:
        out[INDEX[rng.choice(GAZE_UNITS) + rng.choice(["Left", "Right"])]] = amplitude(rng)
        return legalise(out)
    return legalise(out + sample_gaze(rng))


def sample_still(rng):
    """A random expression, f32[52]."""
    kind = rng.random()
    if kind < 0.08:
        return zeros()
    if kind < 0.18:
        return legalise(sample_solo(rng))
    face = sample_expression(rng) if kind < 0.28 else sample_mouth(rng) + sample_upper(rng)
    return legalise(np.maximum(face, sample_lids(rng)) + sample_gaze(rng))


def lean(rng, face):
    """The same face mostly on one side, in some of its regions."""
    face = face.copy()
    for region in LEANING:
        if rng.random() < 0.6:
            weak = rng.choice(["Left", "Right"])
            weaken(face, [unit + weak for unit in region], rng.uniform(0, 0.4))
    return face


def sample_stills(rng, count, leaning=0, apart=0):
    """Random expressions f32[count,52]; of a share the units move apart, and of the others a share leans to one
    side."""
    faces = []
    for _ in range(count):
        if apart and rng.random() < apart:
            faces.append(sample_apart(rng))
            continue
        face = sample_still(rng)
        faces.append(lean(rng, face) if leaning and rng.random() < leaning else face)
    return np.stack(faces)


def min_jerk(n):
    """n values of the minimum-jerk step from 0 (exclusive) to 1 (inclusive)."""
    t = np.arange(1, n + 1) / n
    return t ** 3 * (10 - 15 * t + 6 * t ** 2)


def ease_through(rng, frames, sample_pose, hold, ease, rest=0.0):
    """Curve f32[frames,52] that eases from pose to pose; `hold`, `ease` = (least, most) frames.

    After a pose the next one is neutral with probability `rest`.
    """
    pose = sample_pose(rng) if rng.random() < 0.5 else zeros()
    rows, count = [], 0
    while count < frames:
        rows.append(np.repeat(pose[None], rng.integers(*hold, endpoint=True), 0))
        target = zeros() if rng.random() < rest else sample_pose(rng)
        step = min_jerk(rng.integers(*ease, endpoint=True))[:, None]
        rows.append(pose + step * (target - pose))
        count += len(rows[-2]) + len(rows[-1])
        pose = target
    start = rng.integers(count - frames + 1)
    return np.concatenate(rows)[start:start + frames].astype(np.float32)


def blinks(rng, frames, fps):
    """Blinks f32[frames,52]: 2-4 frames to close, 3-6 to open, every 1-6 s; some long, some winks."""
    curve = np.zeros((frames, len(CONTROLS)), np.float32)
    at = int(rng.uniform(0, 3) * fps)
    while at < frames:
        held = rng.integers(6, 30) if rng.random() < 0.12 else rng.integers(0, 3)
        lid = np.concatenate([min_jerk(rng.integers(2, 5)), np.ones(held), 1 - min_jerk(rng.integers(3, 7))])
        end = min(frames, at + len(lid))
        depth = rng.uniform(0.85, 1) if rng.random() < 0.85 else rng.uniform(0.3, 0.85)
        wink = rng.random() < 0.12
        gains = [(1, 0.02), (0.02, 1)][rng.integers(2)] if wink else 1 - rng.uniform(0, 0.05, 2)
        for side, gain in zip(("Left", "Right"), gains):
            curve[at:end, INDEX["eyeBlink" + side]] = depth * gain * lid[:end - at]
        at = end + int(rng.uniform(0.3, 1) * fps if rng.random() < 0.2 else rng.uniform(1, 6) * fps)
    return curve


def micro_motion(rng, frames):
    """Slow tremor, standard deviation 0.005, on every control."""
    window = np.hanning(17)[1:-1]
    window /= np.sqrt((window ** 2).sum())
    noise = rng.normal(size=(frames + len(window) - 1, len(CONTROLS)))
    smooth = [np.convolve(column, window, "valid") for column in noise.T]
    return (0.005 * np.stack(smooth, 1)).astype(np.float32)


def in_turn(rng, frames):
    """Units one after the other, with rest between about half of them."""
    return ease_through(rng, frames, sample_solo, (1, 12), (4, 16), rest=0.5)


def sample_sequence(rng, frames, fps=30, phone=0.0):
    """A random performance, f32[frames,52]; a share `phone` of them uses recordings of an iPhone, including the eyes.
    """
    if phone and rng.random() < phone and recordings.phone_takes(NAMES):
        return legalise(recordings.of_phone(rng, frames, fps, NAMES, MIRROR) + micro_motion(rng, frames))
    if rng.random() < ALONE:
        return legalise(np.maximum(in_turn(rng, frames), blinks(rng, frames, fps)) + micro_motion(rng, frames))
    kind = rng.random()
    if kind < 0.25 and recordings.grid_clips(NAMES):
        face = recordings.of_grid(rng, frames, fps, NAMES)
        if rng.random() < 0.5:
            face = np.maximum(face, ease_through(rng, frames, sample_upper, (5, 40), (3, 20), rest=0.5))
    elif kind < 0.45:
        speech = ease_through(rng, frames, sample_viseme, (0, 1), (3, 6))
        mood = ease_through(rng, frames, sample_expression, (20, 60), (6, 20), rest=0.5)
        face = speech + rng.uniform(0.2, 0.8) * mood
    elif kind < 0.60:
        face = ease_through(rng, frames, sample_expression, (2, 30), (3, 20), rest=0.4)
    else:
        face = ease_through(rng, frames, sample_mouth, (1, 15), (3, 16), rest=0.1)
        face = face + ease_through(rng, frames, sample_upper, (2, 40), (3, 20), rest=0.3)
    if rng.random() < 0.45:
        face = np.maximum(face, ease_through(rng, frames, sample_lids, (3, 40), (3, 15), rest=0.6))
    face = np.maximum(face, blinks(rng, frames, fps))
    if kind >= 0.25 or rng.random() < 0.4:
        face = face + ease_through(rng, frames, sample_gaze, (4, 45), (1, 3))
    return legalise(face + micro_motion(rng, frames))


def sample_posed(rng, frames, fps=30):
    """A performance between still faces; many of these lean to one side or move one unit of each region."""
    face = ease_through(rng, frames, lambda rng: sample_stills(rng, 1, LEANING_SHARE, APART_SHARE)[0], (2, 25), (3, 16),
                        rest=0.25)
    return legalise(np.maximum(face, blinks(rng, frames, fps)) + micro_motion(rng, frames))


def sample_lesson(rng, frames, fps=30):
    """A random performance of any kind for training decoders, f32[frames,52]."""
    if rng.random() < POSED:
        return sample_posed(rng, frames, fps)
    return sample_sequence(rng, frames, fps, PHONE)
