"""An independent parser for pages of `mien track --report`, based on docs/cli.md."""
import base64
import hashlib
import html.parser
import json
import re
import struct
import zlib


class Blocks(html.parser.HTMLParser):
    """The script and style elements of the page by id, and every attribute of the page."""

    def __init__(self, text):
        super().__init__(convert_charrefs=True)
        self.blocks, self.attributes, self.inside, self.policy = {}, [], None, ""
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        self.attributes += [(tag, name, value) for name, value in attributes.items()]
        if tag in ("script", "style"):
            self.inside = attributes.get("id", tag)
            self.blocks[self.inside] = ""
        if attributes.get("http-equiv") == "Content-Security-Policy":
            self.policy = attributes["content"]

    def handle_endtag(self, tag):
        self.inside = None if tag in ("script", "style") else self.inside

    def handle_data(self, text):
        if self.inside:
            self.blocks[self.inside] += text


def unpack(block):
    return zlib.decompress(base64.b64decode(block, validate=True)) if block.strip() else b""


def summed(differences, bits):
    values, value = [], 0
    for difference in differences:
        value = (value + difference) & ((1 << bits) - 1)
        values.append(value - (1 << bits) if value >> (bits - 1) else value)
    return values


class Report:
    def __init__(self, path):
        with open(path, encoding="utf-8") as file:
            self.page = Blocks(file.read())
        self.data = json.loads(self.page.blocks["data"])
        self.columns, at, packed = {}, 0, base64.b64decode(self.page.blocks["columns"], validate=True)
        for column in self.data["columns"]:
            size, count = column["bytes"], column["count"]
            steps = summed(struct.unpack_from(f"<{count}{'hi'[size == 4]}", packed, at), 8 * size)
            self.columns[column["name"]] = [None if size == 2 and step == -32768 else step * column["unit"] for step in steps]
            at += size * count
        assert at == len(packed), "bytes without a column"

    def frames(self):
        return len(self.columns["t_ms"])

    def landmarks(self):
        """[frame][point] in pixels; None without a face."""
        packed, count, unit = unpack(self.page.blocks["landmarks"]), self.frames(), self.data["landmark_unit"]
        coordinates = [summed(struct.unpack_from(f"<{count}h", packed, 2 * count * i), 16) for i in range(2 * self.data["landmarks"])]
        return [[None if x[i] == -32768 else (x[i] * unit, y[i] * unit) for x, y in zip(coordinates[::2], coordinates[1::2])]
                for i in range(count)]

    def export(self, name):
        if name == "gltf" and "export-gltf" not in self.page.blocks:
            return self.gltf_of(self.export("glb"))
        return unpack(self.page.blocks["export-" + name])

    @staticmethod
    def gltf_of(glb):
        """The file with its binary chunk as text."""
        length = struct.unpack_from("<I", glb, 12)[0]
        uri = b"data:application/octet-stream;base64," + base64.b64encode(glb[28 + length:])
        return glb[20:20 + length].rstrip().removesuffix(b"}]}") + b',"uri":"' + uri + b'"}]}\n'

    def allowed(self, kind):
        """The hashes of scripts or styles in the page's policy."""
        return re.findall(r"'(sha256-[^']*)'", re.search(kind + r"-src ([^;]*)", self.page.policy)[1])


def hash_of(text):
    return "sha256-" + base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()
