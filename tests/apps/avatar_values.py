"""What avatars in VRChat and VTube Studio should get, computed from their documentation, independently of the program.

Unsupported controls count as 0. A value is absent if all its controls are unsupported.
"""
import math

from live_packets import ARKIT

FULL_LOOK = 0.485  # rad, of a gaze control at 1


class Value:
    def __init__(self, number, known):
        self.number, self.known = number, known

    def __add__(self, other):
        return Value(self.number + other.number, self.known or other.known)

    def __rmul__(self, factor):
        return Value(factor * self.number, self.known)

    def __sub__(self, other):
        return self + -1 * other

    def larger(self, other):
        return Value(max(self.number, other.number), self.known or other.known)


def constant(number):
    return Value(number, False)


def reader(frame):
    return lambda name: Value(frame["controls"].get(name, 0.0), name in frame["controls"])


def unified(frame):
    """The base shapes of Unified Expressions, by docs.vrcft.io's table for ARKit; * is Left or Right"""
    c, shapes = reader(frame), {}
    for side in "Left", "Right":
        for shape, control in (("EyeSquint", "eyeSquint*"), ("EyeWide", "eyeWide*"), ("BrowPinch", "browDown*"), ("BrowLowerer", "browDown*"),
                               ("BrowInnerUp", "browInnerUp"), ("BrowOuterUp", "browOuterUp*"), ("CheekSquint", "cheekSquint*"),
                               ("CheekPuff", "cheekPuff"), ("NoseSneer", "noseSneer*"), ("LipSuckUpper", "mouthRollUpper"),
                               ("LipSuckLower", "mouthRollLower"), ("LipFunnelUpper", "mouthFunnel"), ("LipFunnelLower", "mouthFunnel"),
                               ("LipPuckerUpper", "mouthPucker"), ("LipPuckerLower", "mouthPucker"), ("MouthUpperUp", "mouthUpperUp*"),
                               ("MouthUpperDeepen", "mouthUpperUp*"), ("MouthLowerDown", "mouthLowerDown*"), ("MouthUpper", "mouth*"),
                               ("MouthLower", "mouth*"), ("MouthCornerPull", "mouthSmile*"), ("MouthCornerSlant", "mouthSmile*"),
                               ("MouthFrown", "mouthFrown*"), ("MouthStretch", "mouthStretch*"), ("MouthDimple", "mouthDimple*"),
                               ("MouthPress", "mouthPress*"), ("Jaw", "jaw*"), ("EyeClosed", "eyeBlink*")):
            shapes[shape + side] = c(control.replace("*", side))
    for shape, control in (("JawOpen", "jawOpen"), ("JawForward", "jawForward"), ("MouthClosed", "mouthClose"), ("TongueOut", "tongueOut"),
                           ("MouthRaiserUpper", "mouthShrugUpper"), ("MouthRaiserLower", "mouthShrugLower")):
        shapes[shape] = c(control)
    return shapes


def vrchat(frame):
    """{name: value} of v2/, as VRCFaceTracking combines the base shapes"""
    s = unified(frame)
    combined = dict(s)

    def sides(name, formula, whole="mean"):
        left, right = formula("Left"), formula("Right")
        combined[name + "Left"], combined[name + "Right"] = left, right
        if whole and left.known and right.known:
            combined[name] = left.larger(right) if whole == "max" else 0.5 * (left + right)
    for name in ("BrowInnerUp", "BrowOuterUp", "CheekSquint", "NoseSneer", "LipSuckUpper", "LipSuckLower", "LipFunnelUpper", "LipFunnelLower",
                 "LipPuckerUpper", "LipPuckerLower", "MouthUpperUp", "MouthLowerDown", "MouthStretch", "MouthDimple", "MouthPress", "EyeClosed"):
        sides(name, lambda side, name=name: s[name + side])
    sides("EyeWide", lambda side: s["EyeWide" + side], "max")
    sides("EyeSquint", lambda side: s["EyeSquint" + side], "max")
    openness = lambda side: constant(1) - s["EyeClosed" + side]
    sides("EyeOpen", openness)
    sides("EyeLid", lambda side: 0.75 * openness(side) + 0.25 * s["EyeWide" + side])
    down = lambda side: 0.75 * s["BrowLowerer" + side] + 0.25 * s["BrowPinch" + side]
    sides("BrowDown", down)
    sides("BrowUp", lambda side: 0.6 * s["BrowOuterUp" + side] + 0.4 * s["BrowInnerUp" + side])
    sides("BrowExpression", lambda side: 0.5 * s["BrowInnerUp" + side] + 0.5 * s["BrowOuterUp" + side] - down(side))
    sides("CheekPuffSuck", lambda side: s["CheekPuff" + side])
    sides("LipPucker", lambda side: 0.5 * (s["LipPuckerUpper" + side] + s["LipPuckerLower" + side]))
    for lip in "Upper", "Lower":
        sides("LipSuckFunnel" + lip, lambda side, lip=lip: s["LipSuck" + lip + side] - s["LipFunnel" + lip + side])
    smile = lambda side: 0.8 * s["MouthCornerPull" + side] + 0.2 * s["MouthCornerSlant" + side]
    sad = lambda side: s["MouthFrown" + side].larger(s["MouthStretch" + side])
    sides("MouthSmile", smile, None)
    sides("MouthSad", sad, None)
    sides("MouthCornerY", lambda side: s["MouthCornerSlant" + side] - s["MouthFrown" + side])
    sides("SmileFrown", lambda side: smile(side) - s["MouthFrown" + side])
    sides("SmileSad", lambda side: smile(side) - sad(side))
    sides("MouthTightenerStretch", lambda side: constant(0) - s["MouthStretch" + side])
    combined["JawX"] = s["JawRight"] - s["JawLeft"]
    combined["JawZ"] = s["JawForward"]
    for name in "MouthUpper", "MouthLower":
        combined[name + "X"] = s[name + "Right"] - s[name + "Left"]
    combined["MouthX"] = 0.5 * (combined["MouthUpperX"] + combined["MouthLowerX"])
    four = [s[f"Mouth{lip}{side}"] for lip in ("UpperUp", "LowerDown") for side in ("Left", "Right")]
    combined["MouthOpen"] = 0.25 * (four[0] + four[1] + four[2] + four[3])
    combined["LipSuck"] = 0.5 * (s["LipSuckUpperLeft"] + s["LipSuckLowerLeft"])
    combined["LipFunnel"] = s["LipFunnelUpperLeft"]
    values = {name: value.number for name, value in combined.items() if value.known}
    return {**values, **gaze(frame)}


def looks(frame):
    """Radians up and to the subject's right, of the left and the right eye; nothing without any control of gaze"""
    c = lambda name: frame["controls"].get(name, 0.0)
    if not any(name.startswith("eyeLook") for name in frame["controls"]):
        return None
    up = [FULL_LOOK * (c("eyeLookUp" + side) - c("eyeLookDown" + side)) for side in ("Left", "Right")]
    right = [FULL_LOOK * (c("eyeLookInLeft") - c("eyeLookOutLeft")), FULL_LOOK * (c("eyeLookOutRight") - c("eyeLookInRight"))]
    return list(zip(up, right))


def gaze(frame):
    """1 at 45 degrees"""
    eyes = looks(frame)
    if not eyes:
        return {}
    (left_up, left_right), (right_up, right_right) = [[math.tan(angle) for angle in eye] for eye in eyes]
    return {"EyeLeftX": left_right, "EyeLeftY": left_up, "EyeRightX": right_right, "EyeRightY": right_up,
            "EyeX": (left_right + right_right) / 2, "EyeY": (left_up + right_up) / 2}


def native_eyes(frame):
    """Degrees down and to the right; closure"""
    values, eyes, c = {}, looks(frame), frame["controls"]
    if eyes:
        values["LeftRightPitchYaw"] = [math.degrees(angle) for up, right in eyes for angle in (-up, right)]
    if "eyeBlinkLeft" in c and "eyeBlinkRight" in c:
        values["EyesClosedAmount"] = [(c["eyeBlinkLeft"] + c["eyeBlinkRight"]) / 2]
    return values


def vts(frame):
    """{name: value} of VTube Studio's own and of the custom parameters"""
    c, values = reader(frame), {}
    if "head" in frame:
        head = frame["head"]
        values.update(FaceAngleX=-math.degrees(head["yaw_rad"]), FaceAngleY=-math.degrees(head["pitch_rad"]), FaceAngleZ=math.degrees(head["roll_rad"]))
    if "position_m" in frame:
        values.update(FacePositionX=-100 * frame["position_m"][0], FacePositionY=100 * frame["position_m"][1])
    half, inner = constant(0.5), c("browInnerUp")
    brow = lambda side: 0.5 * (0.5 * (inner + c("browOuterUp" + side)) - c("browDown" + side))
    own = {"MouthOpen": c("jawOpen") - c("mouthClose"), "MouthX": c("mouthLeft") - c("mouthRight"),
           "MouthSmile": half + 0.25 * (c("mouthSmileLeft") + c("mouthSmileRight") - c("mouthFrownLeft") - c("mouthFrownRight")),
           "Brows": half + 0.5 * (brow("Left") + brow("Right")), "BrowLeftY": half + brow("Left"), "BrowRightY": half + brow("Right"),
           "CheekPuff": c("cheekPuff"), "TongueOut": c("tongueOut"), "EyeLeftX": c("eyeLookInLeft") - c("eyeLookOutLeft"),
           "EyeRightX": c("eyeLookOutRight") - c("eyeLookInRight")}
    for side in "Left", "Right":
        own["EyeOpen" + side] = constant(1) - c("eyeBlink" + side)
        own[f"Eye{side}Y"] = c("eyeLookUp" + side) - c("eyeLookDown" + side)
    signed = ("MouthX", "EyeLeftX", "EyeLeftY", "EyeRightX", "EyeRightY")
    for name, value in own.items():
        if value.known:
            values[name] = min(max(value.number, -1 if name in signed else 0), 1)
    custom = {custom_name(name): value for name, value in frame["controls"].items() if name not in ("cheekPuff", "tongueOut")}
    return {**values, **custom}


def custom_name(control):
    return "Mien" + control[0].upper() + control[1:]


CUSTOM = [custom_name(name) for name in ARKIT if name not in ("cheekPuff", "tongueOut")]
