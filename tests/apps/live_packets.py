"""Independent decoders for packets of face protocols, based on their documentation.

Each function takes bytes and raises ValueError if the protocol does not permit them.
"""
import struct

ARKIT = """eyeBlinkLeft eyeLookDownLeft eyeLookInLeft eyeLookOutLeft eyeLookUpLeft eyeSquintLeft eyeWideLeft
eyeBlinkRight eyeLookDownRight eyeLookInRight eyeLookOutRight eyeLookUpRight eyeSquintRight eyeWideRight
jawForward jawLeft jawRight jawOpen mouthClose mouthFunnel mouthPucker mouthLeft mouthRight mouthSmileLeft mouthSmileRight
mouthFrownLeft mouthFrownRight mouthDimpleLeft mouthDimpleRight mouthStretchLeft mouthStretchRight mouthRollLower mouthRollUpper
mouthShrugLower mouthShrugUpper mouthPressLeft mouthPressRight mouthLowerDownLeft mouthLowerDownRight mouthUpperUpLeft
mouthUpperUpRight browDownLeft browDownRight browInnerUp browOuterUpLeft browOuterUpRight cheekPuff cheekSquintLeft
cheekSquintRight noseSneerLeft noseSneerRight tongueOut""".split()
VRM0 = "Joy Angry Sorrow Fun A I U E O Blink_L Blink_R".split()
VRM1 = "happy angry sad relaxed aa ih ou ee oh blinkLeft blinkRight".split()
PASCAL = [name[0].upper() + name[1:] for name in ARKIT]


def require(condition, what):
    if not condition:
        raise ValueError(what)


def osc_string(data, at):
    end = data.index(b"\0", at)
    following = (end // 4 + 1) * 4
    require(following <= len(data) and not any(data[end:following]), "string not padded with zeros")
    return data[at:end].decode(), following


def osc(data):
    """The messages of a packet: [(address, [arguments])]"""
    require(len(data) % 4 == 0, "size")
    if data.startswith(b"#bundle\0"):
        require(data[8:16] == bytes(7) + b"\1", "time tag")
        messages, at = [], 16
        while at < len(data):
            size, = struct.unpack_from(">i", data, at)
            require(0 < size <= len(data) - at - 4, "element size")
            messages += osc(data[at + 4:at + 4 + size])
            at += 4 + size
        return messages
    address, at = osc_string(data, 0)
    tags, at = osc_string(data, at)
    require(address.startswith("/") and tags.startswith(","), "address or type tags")
    arguments = []
    for tag in tags[1:]:
        if tag == "s":
            argument, at = osc_string(data, at)
        elif tag in "TF":
            argument = tag == "T"
        else:
            argument, = struct.unpack_from({"i": ">i", "f": ">f"}[tag], data, at)
            at += 4
        arguments.append(argument)
    require(at == len(data), "bytes after the arguments")
    return [(address, arguments)]


def vmc(packets):
    """{"ok", "t", "head", "blends"} of the datagrams of one frame"""
    frame = {"blends": {}, "head": None}
    messages = []
    for packet in packets:
        require(len(packet) <= 1500 and packet.startswith(b"#bundle\0"), "not a bundle of at most 1500 bytes")
        messages += osc(packet)
    require(messages[-1] == ("/VMC/Ext/Blend/Apply", []), "blends are not applied")
    for address, arguments in messages[:-1]:
        if address == "/VMC/Ext/OK":
            require(len(arguments) == 4 and all(isinstance(a, int) for a in arguments), "OK")
            frame["ok"] = arguments
        elif address == "/VMC/Ext/T":
            frame["t"], = arguments
        elif address == "/VMC/Ext/Bone/Pos":
            require(arguments[0] == "Head" and len(arguments) == 8, "bone")
            frame["head"] = arguments[1:]
        else:
            require(address == "/VMC/Ext/Blend/Val" and len(arguments) == 2, address)
            require(arguments[0] not in frame["blends"], "twice: " + arguments[0])
            frame["blends"][arguments[0]] = arguments[1]
    return frame


def vrchat(packets):
    """{"active": 3 booleans, "parameters": {name after v2/: value}, "native": {name: [values]}} of the datagrams of one frame"""
    frame = {"active": [], "parameters": {}, "native": {}}
    for packet in packets:
        require(len(packet) <= 1500 and packet.startswith(b"#bundle\0"), "not a bundle of at most 1500 bytes")
        for address, arguments in osc(packet):
            if address.startswith("/tracking/eye/"):
                require(all(isinstance(a, float) for a in arguments), address)
                frame["native"][address.rsplit("/", 1)[1]] = arguments
            elif address.endswith("TrackingActive"):
                require(isinstance(arguments[0], bool) and address.count("/") == 3, address)
                frame["active"] += arguments
            else:
                name = address.rsplit("/v2/", 1)[1]
                require(name not in frame["parameters"] and len(arguments) == 1 and isinstance(arguments[0], float), address)
                frame["parameters"][name], = arguments
    return frame


def live_link(packet):
    """{"device", "subject", "time_s", "values"}; 61 values or none"""
    at = 0

    def take(layout):
        nonlocal at
        values = struct.unpack_from(">" + layout, packet, at)
        at += struct.calcsize(">" + layout)
        return values
    require(take("B")[0] == 6, "version")
    device = take(f"{take('I')[0]}s")[0].decode("ascii")
    subject = take(f"{take('I')[0]}s")[0].decode()
    frame, part, rate, base = take("IfII")
    require(0 <= part < 1 and (rate, base) == (60, 1) and len(device) == 36, "frame time")
    count, = take("B")
    require(count in (0, 61), "count")
    values = take(f"{count}f")
    require(at == len(packet), "bytes after the values")
    return {"device": device, "subject": subject, "time_s": (frame + part) / 60, "values": values}


def ifacialmocap(packet, separator="-"):
    """{"values": {name: 0..100}, "head": 6, "rightEye": 3, "leftEye": 3}"""
    text = packet.decode("ascii")
    require(text.endswith("|"), "end")
    frame = {"values": {}}
    for field in text[:-1].split("|"):
        if "#" in field:
            name, numbers = field.lstrip("=").split("#")
            frame[name] = [float(n) for n in numbers.split(",")]
        else:
            name, value = field.split(separator)
            require(value.isdigit() and int(value) <= 100 and name not in frame["values"], field)
            frame["values"][name] = int(value)
    require([len(frame[k]) for k in ("head", "rightEye", "leftEye")] == [6, 3, 3], "turns")
    return frame


IFACIALMOCAP = [name if name.startswith(("jaw", "mouthLeft", "mouthRight")) else
                name[:-4] + "_L" if name.endswith("Left") else name[:-5] + "_R" if name.endswith("Right") else name for name in ARKIT]


def openseeface(packet):
    require(len(packet) == 1785, "size")
    names = ("time", "id", "size", "open", "success", "error", "quaternion", "euler", "translation", "confidence", "landmarks",
             "points", "features")
    layouts = ("d", "i", "2f", "2f", "B", "f", "4f", "3f", "3f", "68f", "136f", "210f", "14f")
    frame, at = {}, 0
    for name, layout in zip(names, layouts):
        values = struct.unpack_from("<" + layout, packet, at)
        frame[name] = values[0] if len(values) == 1 else values
        at += struct.calcsize("<" + layout)
    require(at == 1785, "layout")
    frame["landmarks"] = list(zip(*[iter(frame["landmarks"])] * 2))
    frame["points"] = list(zip(*[iter(frame["points"])] * 3))
    return frame


def opentrack(packet):
    require(len(packet) == 48, "size")
    return dict(zip(("x", "y", "z", "yaw", "pitch", "roll"), struct.unpack("<6d", packet)))
