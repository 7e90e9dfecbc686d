"""The type of a row of track_file, with the names and units of `mien track`'s CSV. Type checkers need it written out."""

from __future__ import annotations

from typing import Literal, TypedDict


class _Facts(TypedDict):
    frame: int
    t_ms: float
    status: Literal["searching", "tracking", "lost"]
    face_id: int
    face_prob: float
    lod: int
    vad: float
    x: float
    y: float
    w: float
    h: float
    pitch_rad: float
    yaw_rad: float
    roll_rad: float
    tx_m: float
    ty_m: float
    tz_m: float
    # Controls that every level of detail predicts.
    eyeBlinkLeft: float
    eyeBlinkRight: float
    jawOpen: float
    mouthClose: float
    mouthFunnel: float
    mouthPucker: float
    mouthLeft: float
    mouthRight: float
    mouthSmileLeft: float
    mouthSmileRight: float
    mouthStretchLeft: float
    mouthStretchRight: float
    mouthRollLower: float
    mouthShrugLower: float
    mouthPressLeft: float
    mouthPressRight: float
    mouthLowerDownLeft: float
    mouthLowerDownRight: float
    mouthUpperUpLeft: float
    mouthUpperUpRight: float
    browDownLeft: float
    browDownRight: float
    browInnerUp: float
    browOuterUpLeft: float
    browOuterUpRight: float
    cheekPuff: float
    noseSneerLeft: float
    noseSneerRight: float
    tongueOut: float


class Row(_Facts, total=False):
    """A frame. Controls, 0..1, that the level of detail does not predict are absent; box and pose are NaN without a face.

    Units are in the names: ms, radians, metres; x, y, w and h are pixels of the upright image; face_prob and vad are 0..1.
    """

    eyeLookDownLeft: float
    eyeLookInLeft: float
    eyeLookOutLeft: float
    eyeLookUpLeft: float
    eyeSquintLeft: float
    eyeWideLeft: float
    eyeLookDownRight: float
    eyeLookInRight: float
    eyeLookOutRight: float
    eyeLookUpRight: float
    eyeSquintRight: float
    eyeWideRight: float
    jawForward: float
    jawLeft: float
    jawRight: float
    mouthFrownLeft: float
    mouthFrownRight: float
    mouthDimpleLeft: float
    mouthDimpleRight: float
    mouthRollUpper: float
    mouthShrugUpper: float
    cheekSquintLeft: float
    cheekSquintRight: float
