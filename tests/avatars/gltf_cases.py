"""Small glTF files, one for each thing that the specification allows and readers get wrong."""

import base64
import json
import math
import struct

CODES = {5120: "b", 5121: "B", 5122: "h", 5123: "H", 5125: "I", 5126: "f"}
BYTE, UNSIGNED_BYTE, SHORT, UNSIGNED_SHORT, UNSIGNED_INT, FLOAT = CODES
WIDTHS = {"SCALAR": 1, "VEC3": 3, "VEC4": 4, "MAT4": 16}
RINGS, RADIUS, HEIGHT = 6, 0.1, 1.2


class Sample:
    """A glTF file under construction: a square column along Y, of RINGS rings of four vertices."""

    def __init__(self):
        self.data = bytearray()
        self.json = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [], "meshes": [],
                     "accessors": [], "bufferViews": [], "buffers": []}
        self.levels = [HEIGHT * ring / (RINGS - 1) for ring in range(RINGS) for _ in range(4)]
        corners = [(-1, -1), (-1, 1), (1, 1), (1, -1)]
        self.points = [(RADIUS * corners[i % 4][0], y, RADIUS * corners[i % 4][1])
                       for i, y in enumerate(self.levels)]
        self.corners = [0, 3, 2, 0, 2, 1]  # the floor; then sides, then the top
        for ring in range(RINGS - 1):
            for i in range(4):
                a, b = 4 * ring + i, 4 * ring + (i + 1) % 4
                self.corners += [a, b, b + 4, a, b + 4, a + 4]
        top = 4 * (RINGS - 1)
        self.corners += [top, top + 1, top + 2, top, top + 2, top + 3]

    def view(self, content, **properties):
        self.data += bytes(-len(self.data) % 4)
        self.json["bufferViews"].append({"buffer": 0, "byteOffset": len(self.data), "byteLength": len(content)}
                                        | properties)
        self.data += content
        return len(self.json["bufferViews"]) - 1

    def add(self, elements, component, kind, stride=None, **properties):
        """A new accessor; elements are tuples or numbers."""
        rows = [struct.pack(f"<{WIDTHS[kind]}{CODES[component]}", *(e if isinstance(e, tuple) else (e,)))
                for e in elements]
        if stride:
            view = self.view(b"".join(row.ljust(stride, b"\xaa") for row in rows), byteStride=stride)
        else:
            view = self.view(b"".join(rows))
        self.json["accessors"].append({"bufferView": view, "componentType": component, "count": len(rows),
                                       "type": kind} | properties)
        return len(self.json["accessors"]) - 1

    def add_sparse(self, count, indices, values, kind="VEC3"):
        """An accessor without a view: zero but for some elements."""
        where = self.view(struct.pack(f"<{len(indices)}H", *indices))
        what = self.view(b"".join(struct.pack(f"<{WIDTHS[kind]}f", *value) for value in values))
        self.json["accessors"].append({
            "componentType": FLOAT, "count": count, "type": kind,
            "sparse": {"count": len(indices), "indices": {"bufferView": where, "componentType": UNSIGNED_SHORT},
                       "values": {"bufferView": what}}})
        return len(self.json["accessors"]) - 1

    def node(self, **properties):
        self.json["nodes"].append(properties)
        return len(self.json["nodes"]) - 1

    def primitive(self, **attributes):
        if "POSITION" not in attributes:
            attributes["POSITION"] = self.add(self.points, FLOAT, "VEC3")
        return {"attributes": attributes, "indices": self.add(self.corners, UNSIGNED_SHORT, "SCALAR")}

    def mesh(self, *primitives, **properties):
        self.json["meshes"].append({"primitives": list(primitives)} | properties)
        return len(self.json["meshes"]) - 1

    def skin(self, joints, inverse=None):
        self.json.setdefault("skins", []).append({"joints": joints})
        if inverse:
            self.json["skins"][-1]["inverseBindMatrices"] = self.add(inverse, FLOAT, "MAT4")
        return len(self.json["skins"]) - 1

    def bend_weights(self, joints=(0, 1)):
        """JOINTS_0 and WEIGHTS_0: from the first joint at the floor to the second at the top."""
        share = [y / HEIGHT for y in self.levels]
        return {"JOINTS_0": self.add([(*joints, 0, 0)] * len(share), UNSIGNED_BYTE, "VEC4"),
                "WEIGHTS_0": self.add([(1 - s, s, 0, 0) for s in share], FLOAT, "VEC4")}

    def skinned_column(self, inverse=True, **mesh_node):
        """Nodes 0 (mesh), 1 and 2: the joints at the floor and at half height."""
        self.node(mesh=self.mesh(self.primitive(**self.bend_weights())), skin=0, **mesh_node)
        self.node(name="foot", children=[2])
        self.node(name="tip", translation=[0, HEIGHT / 2, 0])
        self.skin([1, 2], [translation(0, 0, 0), translation(0, -HEIGHT / 2, 0)] if inverse else None)
        self.json["scenes"][0]["nodes"] = [0, 1]
        return self

    def animate(self, name, *channels):
        """Channels are (node, path, interpolation, times, values)."""
        samplers, targets = [], []
        for node, path, interpolation, times, values in channels:
            kind = {"rotation": "VEC4", "weights": "SCALAR"}.get(path, "VEC3")
            samplers.append({"input": self.add(times, FLOAT, "SCALAR"), "interpolation": interpolation,
                             "output": values if isinstance(values, int) else self.add(values, FLOAT, kind)})
            targets.append({"sampler": len(samplers) - 1, "target": {"node": node, "path": path}})
        self.json.setdefault("animations", []).append({"name": name, "samplers": samplers, "channels": targets})
        return self

    def write(self, path):
        if path.suffix == ".glb":
            self.json["buffers"] = [{"byteLength": len(self.data)}]
            text = json.dumps(self.json).encode()
            text += b" " * (-len(text) % 4)
            binary = bytes(self.data) + bytes(-len(self.data) % 4)
            path.write_bytes(struct.pack("<4sIIII", b"glTF", 2, 28 + len(text) + len(binary), len(text), 0x4E4F534A)
                             + text + struct.pack("<II", len(binary), 0x004E4942) + binary)
            return
        uri = "data:application/octet-stream;base64," + base64.b64encode(bytes(self.data)).decode()
        self.json["buffers"] = self.json["buffers"] or [{"byteLength": len(self.data), "uri": uri}]
        path.write_text(json.dumps(self.json))


def translation(x, y, z):
    return (1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, x, y, z, 1)


def about_z(degrees):
    half = math.radians(degrees) / 2
    return (0, 0, math.sin(half), math.cos(half))


BEND = (2, "rotation", "LINEAR", [0, 0.5, 1.5], [about_z(0), about_z(70), about_z(20)])


def plain():
    return Sample().skinned_column().animate("bend", BEND)


def no_inverse_bind_matrices():
    return Sample().skinned_column(inverse=False).animate("bend", BEND)


def skinned_node_moves():
    """Neither the transform of a skinned mesh's node nor its parent's matters, nor the skin's skeleton."""
    sample = Sample().skinned_column(translation=[5, 5, 5], scale=[2, 3, -4])
    sample.node(translation=[9, 0, 0], children=[0])
    sample.json["scenes"][0]["nodes"] = [3, 1]
    sample.json["skins"][0]["skeleton"] = 2
    return sample.animate("bend", BEND, (0, "translation", "LINEAR", [0, 1], [(0, 0, 0), (7, 7, 7)]))


def same_names():
    sample = Sample().skinned_column().animate("bend", BEND)
    for node in sample.json["nodes"]:
        node["name"] = "Bone"
    return sample.animate("bend", (1, "translation", "LINEAR", [0, 1], [(0, 0, 0), (0, 0, 1)]))


def integer_weights(component, largest):
    sample = Sample().skinned_column().animate("bend", BEND)
    share = [round(largest * y / HEIGHT) for y in sample.levels]
    sample.json["meshes"][0]["primitives"][0]["attributes"]["WEIGHTS_0"] = sample.add(
        [(largest - s, s, 0, 0) for s in share], component, "VEC4", normalized=True)
    return sample


def eight_influences():
    """Two sets, of joints that are 16 bits wide, with weights whose sum is 3."""
    sample = Sample()
    shares = [y / HEIGHT for y in sample.levels]
    attributes = {}
    for part in (0, 1):
        attributes[f"JOINTS_{part}"] = sample.add([tuple(range(4 * part, 4 * part + 4))] * len(shares),
                                                  UNSIGNED_SHORT, "VEC4")
        attributes[f"WEIGHTS_{part}"] = sample.add(
            [tuple(3 * math.comb(7, k) * s**k * (1 - s)**(7 - k) for k in range(4 * part, 4 * part + 4))
             for s in shares], FLOAT, "VEC4")
    sample.node(mesh=sample.mesh(sample.primitive(**attributes)), skin=0)
    for k in range(8):
        sample.node(translation=[0, HEIGHT / 8 if k else 0, 0], children=[k + 2] if k < 7 else [])
    sample.skin(list(range(1, 9)), [translation(0, -HEIGHT / 8 * k, 0) for k in range(8)])
    sample.json["scenes"][0]["nodes"] = [0, 1]
    return sample.animate("curl", *((k, "rotation", "LINEAR", [0, 1], [about_z(0), about_z(15)])
                                    for k in range(2, 9)))


def quantized(component, normalized):
    """Positions as integers; the node brings them back to size."""
    sample = Sample()
    largest = {BYTE: 127, UNSIGNED_BYTE: 255, SHORT: 32767, UNSIGNED_SHORT: 65535}[component]
    low = 0 if component in (UNSIGNED_BYTE, UNSIGNED_SHORT) else -largest - 1  # below -1, which it means
    points = [tuple(round(low + (largest - low) * u) for u in (x / RADIUS / 2 + 0.5, y / HEIGHT, z / RADIUS / 2 + 0.5))
              for x, y, z in sample.points]
    position = sample.add(points, component, "VEC3", stride=4 if component in (BYTE, UNSIGNED_BYTE) else 8,
                          normalized=normalized)
    sample.json["extensionsUsed"] = sample.json["extensionsRequired"] = ["KHR_mesh_quantization"]
    size = 1 if normalized else 1 / largest
    sample.node(mesh=sample.mesh(sample.primitive(POSITION=position)), scale=[0.3 * size, 2 * size, 0.3 * size])
    return sample


def with_targets(sample, **mesh_properties):
    """The column as a mesh with two blend shapes: one dense, one sparse."""
    primitive = sample.primitive()
    wide = sample.add([(2 * x, 0, 2 * z) for x, _, z in sample.points], FLOAT, "VEC3")
    raised = sample.add_sparse(len(sample.points), [21, 22], [(0, 0.3, 0), (0, 0.4, 0)])
    primitive["targets"] = [{"POSITION": wide}, {"POSITION": raised, "NORMAL": wide}]
    return sample.mesh(primitive, **mesh_properties)


def shapes_of_mesh():
    sample = Sample()
    sample.node(mesh=with_targets(sample, weights=[0.5, -1.0]))
    return sample


def shapes_of_node():
    """The node's weights win, for one of two nodes of the mesh."""
    sample = Sample()
    mesh = with_targets(sample, weights=[1.0, 1.0])
    sample.node(mesh=mesh, weights=[0.0, 0.25], children=[1])
    sample.node(mesh=mesh, translation=[1, 0, 0])
    return sample


def shapes_move():
    """On one of two nodes; the other keeps its weights."""
    sample = shapes_of_node()
    sample.animate("linear", (0, "weights", "LINEAR", [0, 1], [0, 1, 1, 0]))
    sample.animate("step", (0, "weights", "STEP", [0.5, 1], [0, 1, 1, 0]))
    # Of every key: both in-tangents, both values, both out-tangents.
    return sample.animate("spline", (0, "weights", "CUBICSPLINE", [0, 2], [0, 0, 0, 1, 2, 3, -1, 0.5, 1, 0, 0, 0]))


def shapes_on_a_skin():
    sample = Sample().skinned_column()
    sample.json["meshes"][0] = sample.json["meshes"][with_targets(sample)]
    sample.json["meshes"].pop()
    sample.json["meshes"][0]["primitives"][0]["attributes"] |= sample.bend_weights()
    return sample.animate("both", BEND, (0, "weights", "LINEAR", [0.25, 1.5], [0, 1, 1, 0]))


def steps():
    return Sample().skinned_column().animate(
        "jump", (2, "rotation", "STEP", [0.2, 0.5, 1.5], [about_z(10), about_z(70), about_z(20)]),
        (1, "translation", "STEP", [0, 1], [(0, 0, 0), (0, 1, 0)]))


def splines():
    rotations = [(0, 0, 0, 0), about_z(10), (0, 0.5, 1, 0), (0.3, 0, 0, 0), about_z(80), (0, 0, 0, 0)]
    moves = [(0, 0, 0), (1, 0, 0), (0, 3, 0), (0, 0, -2), (0, 1, 0), (0, 0, 0)]
    scales = [(0, 0, 0), (1, 1, 1), (1, 0, 0), (0, 1, 0), (1.5, 0.5, 1), (0, 0, 0)]
    return Sample().skinned_column().animate(
        "swing", (2, "rotation", "CUBICSPLINE", [0.25, 1.5], rotations),
        (1, "translation", "CUBICSPLINE", [0, 2], moves), (2, "scale", "CUBICSPLINE", [0, 1], scales))


def short_way_round():
    """Keys of opposite sign name rotations near each other; their output is normalised shorts."""
    sample = Sample().skinned_column()
    keys = [about_z(10), tuple(-x for x in about_z(60)), about_z(200)]
    output = sample.add([tuple(round(32767 * x) for x in q) for q in keys], SHORT, "VEC4", normalized=True)
    return sample.animate("turn", (2, "rotation", "LINEAR", [0.5, 1, 2], output))


def mirrored_node():
    sample = Sample()
    sample.node(scale=[-1, 1, 1], children=[1])
    sample.node(mesh=sample.mesh(sample.primitive()), rotation=list(about_z(30)), translation=[1, 0, 0])
    return sample


def mirrored_joints():
    sample = Sample().skinned_column().animate("bend", BEND)
    sample.json["nodes"][1]["scale"] = [1, 1, -1]
    return sample


def two_skins():
    """Two skinned meshes of different joints and binding, and a mesh that follows a joint."""
    sample = Sample().skinned_column().animate("bend", BEND)
    sample.node(mesh=sample.mesh(sample.primitive(**sample.bend_weights((1, 0)))), skin=1)
    sample.skin([2, 1], [translation(0.5, -0.4, 0), translation(0.5, 0, 0)])
    sample.node(mesh=sample.mesh(sample.primitive()), scale=[0.5, 0.25, 0.5])
    sample.json["nodes"][2]["children"] = [4]
    sample.json["scenes"][0]["nodes"] = [0, 1, 3]
    return sample


def strips_and_fans():
    """Sides as strips with 8, 16 and 32 bit indices, floor as a fan, top as triangles without indices."""
    sample = Sample()
    position = sample.add(sample.points, FLOAT, "VEC3")
    primitives = []
    for i, component in enumerate((UNSIGNED_BYTE, UNSIGNED_SHORT, UNSIGNED_INT, UNSIGNED_BYTE)):
        strip = [4 * ring + k for ring in range(RINGS) for k in (i, (i + 1) % 4)]
        primitives.append({"mode": 5, "attributes": {"POSITION": position},
                           "indices": sample.add(strip, component, "SCALAR")})
    primitives.append({"mode": 6, "attributes": {"POSITION": position},
                       "indices": sample.add([0, 3, 2, 1], UNSIGNED_BYTE, "SCALAR")})
    top = sample.points[-4:]
    primitives.append({"attributes": {"POSITION": sample.add([top[k] for k in (0, 1, 2, 0, 2, 3)], FLOAT, "VEC3")}})
    primitives.append({"mode": 0, "attributes": {"POSITION": position}})
    primitives.append({"mode": 3, "attributes": {"POSITION": position}})
    sample.node(mesh=sample.mesh(*primitives))
    return sample


def interleaved():
    sample = plain()
    attributes = sample.json["meshes"][0]["primitives"][0]["attributes"]
    attributes["POSITION"] = sample.add(sample.points, FLOAT, "VEC3", stride=28)
    return sample


def sparse_positions():
    """A view of its own below the sparse elements."""
    sample = Sample()
    position = sample.add(sample.points, FLOAT, "VEC3")
    moved = sample.add_sparse(len(sample.points), [20, 23], [(-0.3, 1.5, -0.3), (0.3, 1.4, -0.3)])
    sample.json["accessors"][moved]["bufferView"] = sample.json["accessors"][position]["bufferView"]
    sample.node(mesh=sample.mesh(sample.primitive(POSITION=moved)))
    return sample


def matrices():
    """A node's matrix, in columns: a turn by 90 degrees about X with scales, in a chain of nodes."""
    sample = Sample()
    sample.node(matrix=[2, 0, 0, 0, 0, 0, 3, 0, 0, -0.5, 0, 0, 1, 2, 3, 1], children=[1])
    sample.node(mesh=sample.mesh(sample.primitive()), rotation=list(about_z(25)), translation=[0, 0.1, 0])
    return sample


def second_scene():
    """Nodes outside of the scene are not drawn; the joints of a skin may lie there."""
    sample = Sample().skinned_column().animate("bend", BEND)
    sample.node(mesh=0, translation=[4, 0, 0])
    sample.json["scenes"] = [{"nodes": [3]}, {"nodes": [0]}]
    sample.json["scene"] = 1
    return sample


def write_all(folder):
    """Writes every case and returns the paths."""
    cases = {case.__name__: case() for case in (
        plain, no_inverse_bind_matrices, skinned_node_moves, same_names, eight_influences, shapes_of_mesh,
        shapes_of_node, shapes_move, shapes_on_a_skin, steps, splines, short_way_round, mirrored_node,
        mirrored_joints, two_skins, strips_and_fans, interleaved, sparse_positions, matrices, second_scene)}
    cases["weights_8_bits"] = integer_weights(UNSIGNED_BYTE, 255)
    cases["weights_16_bits"] = integer_weights(UNSIGNED_SHORT, 65535)
    for component in (BYTE, UNSIGNED_BYTE, SHORT, UNSIGNED_SHORT):
        for normalized in (False, True):
            cases[f"quantized_{component}_{normalized}"] = quantized(component, normalized)
    paths = []
    for name, sample in cases.items():
        paths.append(folder / f"{name}.gltf")
        sample.write(paths[-1])
    paths.append(folder / "binary.glb")
    plain().write(paths[-1])

    # A buffer in a file whose name needs encoding, longer than it says.
    beside = plain()
    (folder / "ä b%.bin").write_bytes(bytes(beside.data) + b"more")
    beside.json["buffers"] = [{"byteLength": len(beside.data), "uri": "%C3%A4%20b%25.bin"}]
    paths.append(folder / "beside.gltf")
    beside.write(paths[-1])
    return [str(path) for path in paths]
