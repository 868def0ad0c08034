#!/usr/bin/env python3
"""Compares what the library makes of glTF files, vertex by vertex, with an evaluator of its own.

    gltf_reference.py --program PATH FILE...   compares these files
    gltf_reference.py --program PATH --cases   compares the files of gltf_cases.py

PATH is gltf_poses, which prints the triangles and the posed vertices of a file. The evaluator below follows the
text of glTF 2.0 (sections 3.5 to 3.7 and 3.11, appendix C) in plain Python, and shares no code with the library.
Corners of corresponding triangles must agree in every pose within TOLERANCE of the file's size, and in winding.

Exit codes: 0 all agree, 1 one differs, 2 bad arguments, 77 the files are not there.
"""

import argparse
import base64
import bisect
import json
import math
import os
import pathlib
import struct
import subprocess
import sys
import tempfile
import urllib.parse

import gltf_cases

SKIPPED = 77
TOLERANCE = 1e-5  # of the diagonal of the file's bounding box

COMPONENTS = {5120: ("b", 127), 5121: ("B", 255), 5122: ("h", 32767), 5123: ("H", 65535), 5125: ("I", 1),
              5126: ("f", 1)}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}
IDENTITY = [1.0, 0, 0, 0, 0, 1.0, 0, 0, 0, 0, 1.0, 0]  # 3x4, by rows


# ---- 3x4 matrices --------------------------------------------------------------------------------------------------


def product(a, b):
    rows = []
    for r in (0, 4, 8):
        for c in range(4):
            rows.append(a[r] * b[c] + a[r + 1] * b[4 + c] + a[r + 2] * b[8 + c] + (a[r + 3] if c == 3 else 0.0))
    return rows


def from_columns(m):
    """The upper rows of a glTF matrix."""
    return [m[c * 4 + r] for r in range(3) for c in range(4)]


def from_parts(t, q, s):
    x, y, z, w = q
    n = math.sqrt(x * x + y * y + z * z + w * w)
    x, y, z, w = x / n, y / n, z / n, w / n
    return [(1 - 2 * (y * y + z * z)) * s[0], 2 * (x * y - z * w) * s[1], 2 * (x * z + y * w) * s[2], t[0],
            2 * (x * y + z * w) * s[0], (1 - 2 * (x * x + z * z)) * s[1], 2 * (y * z - x * w) * s[2], t[1],
            2 * (x * z - y * w) * s[0], 2 * (y * z + x * w) * s[1], (1 - 2 * (x * x + y * y)) * s[2], t[2]]


def determinant(m):
    return (m[0] * (m[5] * m[10] - m[6] * m[9]) - m[1] * (m[4] * m[10] - m[6] * m[8])
            + m[2] * (m[4] * m[9] - m[5] * m[8]))


# ---- A file --------------------------------------------------------------------------------------------------------


class Gltf:
    def __init__(self, path):
        self.folder = os.path.dirname(path)
        with open(path, "rb") as stream:
            content = stream.read()
        self.binary = None
        if content[:4] == b"glTF":
            length = struct.unpack_from("<I", content, 12)[0]
            if len(content) > 20 + length:
                size = struct.unpack_from("<I", content, 20 + length)[0]
                self.binary = content[28 + length:28 + length + size]
            content = content[20:20 + length]
        self.json = json.loads(content)
        self.nodes = self.json.get("nodes", [])
        self.parent = {child: i for i, node in enumerate(self.nodes) for child in node.get("children", [])}
        self.buffers, self.accessors = {}, {}

    def buffer(self, i):
        if i not in self.buffers:
            uri = self.json["buffers"][i].get("uri")
            if uri is None:
                self.buffers[i] = self.binary
            elif uri.startswith("data:"):
                self.buffers[i] = base64.b64decode(uri.split(",", 1)[1])
            else:
                with open(os.path.join(self.folder, urllib.parse.unquote(uri)), "rb") as stream:
                    self.buffers[i] = stream.read()
        return self.buffers[i]

    def raw(self, view, offset, component, width, count):
        view = self.json["bufferViews"][view]
        code = f"<{width}{COMPONENTS[component][0]}"
        stride = view.get("byteStride", struct.calcsize(code))
        start = view.get("byteOffset", 0) + offset
        data = self.buffer(view["buffer"])
        return [struct.unpack_from(code, data, start + i * stride) for i in range(count)]

    def accessor(self, i):
        """Elements as tuples of real numbers."""
        if i in self.accessors:
            return self.accessors[i]
        accessor = self.json["accessors"][i]
        component, width, count = accessor["componentType"], WIDTHS[accessor["type"]], accessor["count"]
        if "bufferView" in accessor:
            elements = self.raw(accessor["bufferView"], accessor.get("byteOffset", 0), component, width, count)
        else:
            elements = [(0,) * width] * count
        if sparse := accessor.get("sparse"):
            where, what = sparse["indices"], sparse["values"]
            indices = self.raw(where["bufferView"], where.get("byteOffset", 0), where["componentType"], 1,
                               sparse["count"])
            values = self.raw(what["bufferView"], what.get("byteOffset", 0), component, width, sparse["count"])
            for (at,), value in zip(indices, values):
                elements[at] = value
        if accessor.get("normalized"):
            largest = COMPONENTS[component][1]
            elements = [tuple(max(number / largest, -1.0) for number in element) for element in elements]
        self.accessors[i] = elements
        return elements


# ---- Animation (appendix C) ----------------------------------------------------------------------------------------


def slerp(a, b, u):
    cosine = sum(x * y for x, y in zip(a, b))
    if cosine < 0:
        b, cosine = [-x for x in b], -cosine
    angle = math.acos(min(cosine, 1.0))
    if angle < 1e-6:
        return [x + u * (y - x) for x, y in zip(a, b)]
    return [(math.sin((1 - u) * angle) * x + math.sin(u * angle) * y) / math.sin(angle) for x, y in zip(a, b)]


def sampled(gltf, sampler, path, time, width):
    """Value of a sampler, a list of `width` numbers."""
    times = [t for t, in gltf.accessor(sampler["input"])]
    numbers = [number for element in gltf.accessor(sampler["output"]) for number in element]
    spline = sampler.get("interpolation", "LINEAR") == "CUBICSPLINE"

    def part(key, which):
        start = ((3 * key + which) if spline else key) * width
        return numbers[start:start + width]

    def value(key):
        return part(key, 1 if spline else 0)

    after = bisect.bisect_right(times, time)
    if after == 0:
        return value(0)
    if after == len(times):
        return value(after - 1)
    before = after - 1
    span = times[after] - times[before]
    u = (time - times[before]) / span
    if sampler.get("interpolation") == "STEP":
        return value(before)
    if spline:
        result = [(2 * u**3 - 3 * u**2 + 1) * v0 + span * (u**3 - 2 * u**2 + u) * b0
                  + (3 * u**2 - 2 * u**3) * v1 + span * (u**3 - u**2) * a1
                  for v0, b0, a1, v1 in zip(value(before), part(before, 2), part(after, 0), value(after))]
        if path == "rotation":
            length = math.sqrt(sum(x * x for x in result))
            result = [x / length for x in result]
        return result
    if path == "rotation":
        return slerp(value(before), value(after), u)
    return [x + u * (y - x) for x, y in zip(value(before), value(after))]


# ---- Poses ---------------------------------------------------------------------------------------------------------


class Pose:
    """A file at a time of one of its animations; clip -1 is the file at rest."""

    def __init__(self, gltf, clip, time):
        self.gltf = gltf
        self.moved = {}
        if clip >= 0:
            animation = gltf.json["animations"][clip]
            for channel in animation["channels"]:
                target = channel["target"]
                width = {"rotation": 4, "weights": self.target_count(target["node"])}.get(target["path"], 3)
                self.moved[target["node"], target["path"]] = sampled(
                    gltf, animation["samplers"][channel["sampler"]], target["path"], time, width)
        self.globals = {}

    def target_count(self, node):
        mesh = self.gltf.nodes[node].get("mesh")
        return 0 if mesh is None else len(self.gltf.json["meshes"][mesh]["primitives"][0].get("targets", []))

    def local(self, node):
        values = self.gltf.nodes[node]
        if "matrix" in values:
            return from_columns(values["matrix"])
        parts = [self.moved.get((node, path), values.get(path, default)) for path, default in (
            ("translation", (0, 0, 0)), ("rotation", (0, 0, 0, 1)), ("scale", (1, 1, 1)))]
        return from_parts(*parts)

    def matrix(self, node):
        chain = []
        while node is not None and node not in self.globals:
            chain.append(node)
            node = self.gltf.parent.get(node)
        for node in reversed(chain):
            parent = self.gltf.parent.get(node)
            self.globals[node] = product(IDENTITY if parent is None else self.globals[parent], self.local(node))
        return self.globals[chain[0]] if chain else self.globals[node]

    def weights(self, node):
        values = self.gltf.nodes[node]
        mesh = self.gltf.json["meshes"][values["mesh"]]
        default = values.get("weights", mesh.get("weights", [0.0] * self.target_count(node)))
        return self.moved.get((node, "weights"), default)

    def vertices(self, node, primitive):
        """World positions of a primitive's vertices, and whether the map of each mirrors."""
        gltf, values = self.gltf, self.gltf.nodes[node]
        positions = gltf.accessor(primitive["attributes"]["POSITION"])
        for weight, target in zip(self.weights(node), primitive.get("targets", [])):
            if weight and "POSITION" in target:
                positions = [tuple(a + weight * b for a, b in zip(p, d))
                             for p, d in zip(positions, gltf.accessor(target["POSITION"]))]
        if "skin" in values:
            maps = self.skinned_maps(gltf.json["skins"][values["skin"]], primitive["attributes"], len(positions))
        else:
            maps = [self.matrix(node)] * len(positions)
        return [(m[0] * x + m[1] * y + m[2] * z + m[3], m[4] * x + m[5] * y + m[6] * z + m[7],
                 m[8] * x + m[9] * y + m[10] * z + m[11]) for m, (x, y, z) in zip(maps, positions)], maps

    def skinned_maps(self, skin, attributes, count):
        joints = [self.matrix(joint) for joint in skin["joints"]]
        if "inverseBindMatrices" in skin:
            inverse = self.gltf.accessor(skin["inverseBindMatrices"])
            joints = [product(joint, from_columns(m)) for joint, m in zip(joints, inverse)]
        pairs = [[] for _ in range(count)]
        for i in range(len(attributes)):
            if f"JOINTS_{i}" in attributes:
                for pair, js, ws in zip(pairs, self.gltf.accessor(attributes[f"JOINTS_{i}"]),
                                        self.gltf.accessor(attributes[f"WEIGHTS_{i}"])):
                    pair.extend((j, w) for j, w in zip(js, ws) if w > 0)
        maps = []
        for pair in pairs:
            total = sum(w for _, w in pair)
            m = [0.0] * 12
            for j, w in pair:
                w /= total
                m = [a + w * b for a, b in zip(m, joints[j])]
            maps.append(m)
        return maps

    def triangles(self):
        """Corners of all triangles of the scene, in the file's order."""
        gltf, result = self.gltf, []
        for node in drawn_nodes(gltf):
            if "mesh" not in gltf.nodes[node]:
                continue
            for primitive in gltf.json["meshes"][gltf.nodes[node]["mesh"]]["primitives"]:
                mode = primitive.get("mode", 4)
                if mode < 4:
                    continue
                x, maps = self.vertices(node, primitive)
                corners = [i for i, in gltf.accessor(primitive["indices"])] if "indices" in primitive \
                    else list(range(len(x)))
                for a, b, c in corners_of_triangles(corners, mode):
                    if determinant(maps[a]) < 0:
                        b, c = c, b
                    result.append((x[a], x[b], x[c]))
        return result


def drawn_nodes(gltf):
    """Nodes of the scene, parents before children."""
    open_nodes = list(reversed(gltf.json["scenes"][gltf.json.get("scene", 0)]["nodes"]))
    while open_nodes:
        node = open_nodes.pop()
        yield node
        open_nodes.extend(reversed(gltf.nodes[node].get("children", [])))


def corners_of_triangles(corners, mode):
    if mode == 4:
        return [tuple(corners[i:i + 3]) for i in range(0, len(corners), 3)]
    if mode == 5:
        return [(corners[i], corners[i + 1 + i % 2], corners[i + 2 - i % 2]) for i in range(len(corners) - 2)]
    return [(corners[i + 1], corners[i + 2], corners[0]) for i in range(len(corners) - 2)]


# ---- Comparison ----------------------------------------------------------------------------------------------------


def far(a, b):
    return max(abs(x - y) for x, y in zip(a, b))


def same_triangle(found, expected, tolerance):
    """Equal corners in the same sense of rotation, in every pose."""
    for turn in range(3):
        if all(far(f[(k + turn) % 3], e[k]) <= tolerance for f, e in zip(found, expected) for k in range(3)):
            return True
    return False


def has_coincident_corners(triangle, tolerance):
    return any(far(triangle[k], triangle[(k + 1) % 3]) <= tolerance for k in range(3))


def compare(program, path):
    """What differs, or None."""
    output = subprocess.run([program, path], capture_output=True, text=True, check=False)
    if output.returncode != 0:
        return f"refused: {output.stdout}{output.stderr}"
    lines = iter(output.stdout.splitlines())
    vertex_count, triangle_count, pose_count = map(int, next(lines).split())
    corners = [tuple(map(int, next(lines).split())) for _ in range(triangle_count)]
    gltf, found, expected = Gltf(path), [], []
    for _ in range(pose_count):
        clip, time = next(lines).split()
        x = [tuple(map(float, next(lines).split())) for _ in range(vertex_count)]
        found.append([tuple(x[v] for v in t) for t in corners])
        expected.append(Pose(gltf, int(clip), float(time)).triangles())

    points = [corner for triangle in expected[0] for corner in triangle]
    size = math.dist(*[[pick(p[axis] for p in points) for axis in range(3)] for pick in (min, max)])
    tolerance = TOLERANCE * size
    at = 0
    for i, triangle in enumerate(zip(*expected)):
        if at < triangle_count and same_triangle([pose[at] for pose in found], triangle, tolerance):
            at += 1
        elif not has_coincident_corners(triangle[0], tolerance):  # the library drops triangles without area
            what = [pose[at] for pose in found] if at < triangle_count else "nothing"
            return f"triangle {i} is {what}, expected {triangle}"
    if at < triangle_count:
        return f"{triangle_count - at} triangles too many"
    print(f"{os.path.basename(path)}: {at} triangles agree in {pose_count} poses")
    return None


def main():
    parser = argparse.ArgumentParser(description="Compares posed glTF files with an evaluator of its own.")
    parser.add_argument("--program", required=True)
    parser.add_argument("--cases", action="store_true")
    parser.add_argument("files", nargs="*")
    arguments = parser.parse_args()
    missing = [file for file in arguments.files if not os.path.isfile(file)]
    if missing:
        print(f"SKIPPED: no {', no '.join(missing)}; set TOILE_DATA_DIR to the folder of data")
        return SKIPPED
    with tempfile.TemporaryDirectory() as folder:
        files = arguments.files + (gltf_cases.write_all(pathlib.Path(folder)) if arguments.cases else [])
        differences = [f"{file}: {what}" for file in files if (what := compare(arguments.program, file))]
    print("\n".join(differences))
    return 1 if differences else 0


if __name__ == "__main__":
    sys.exit(main())
