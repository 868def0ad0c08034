"""Plays caches of every format in another program: in Blender (bpy), or those for ParaView in VTK.

A player has
    names            of its meshes
    positions(name, frame)   [points, 3] of scene frame `frame`, as the program has them, with Y up
    tolerance        [m] that the format itself states
    item(name)       Blender's object, for pictures; None in VTK
player_of(file) opens one by the file's extension; PLAYERS names them all.
"""

import pathlib
import re
import sys
import xml.etree.ElementTree

import numpy as np

ROUNDING = 1e-6  # [m] of single precision, a few metres from the origin


def numbered(file):
    """Files of a sequence by number: skirt_####.ply, or skirt.ply if only skirt_0000.ply and so on exist."""
    file = pathlib.Path(file)
    if file.exists():
        return None
    pattern = re.escape(file.name)
    if "#" in file.name:
        pattern = re.sub(r"(\\#)+", lambda run: rf"(\d{{{len(run[0]) // 2},}})", pattern)
    else:
        pattern = re.escape(file.stem) + r"_(\d{4,})" + re.escape(file.suffix)
    found = {}
    for other in file.parent.iterdir():
        match = re.fullmatch(pattern, other.name)
        if match:
            found[int(match[1])] = other
    if not found:
        sys.exit(f"{file}: can't be found, nor a sequence of this name")
    return found


class BlenderPlayer:
    """Meshes of Blender's scene, in metres with Y up, where Blender has Z up."""

    tolerance = ROUNDING

    def __init__(self, file, options):
        import bpy

        self.bpy = bpy
        self.file = str(pathlib.Path(file).resolve())
        self.options = options
        bpy.ops.wm.read_factory_settings(use_empty=True)
        bpy.context.scene.render.fps = round(options.fps)
        bpy.context.scene.render.fps_base = round(options.fps) / options.fps
        self.open()

    def items(self):
        return [item for item in self.bpy.context.scene.objects if item.type == "MESH"]

    @property
    def names(self):
        return [item.name for item in self.items()]

    def item(self, name):
        """The mesh of this name, of one that begins with it (skirtShape), or the only one."""
        items = self.items()
        for item in items:
            parent = item.parent.name if item.parent else ""
            if name in (item.name, parent) or item.name == name + "Shape":
                return item
        if len(items) == 1:
            return items[0]
        sys.exit(f"{self.file}: has no mesh {name}; its meshes are {', '.join(self.names)}")

    def positions(self, name, frame):
        self.bpy.context.scene.frame_set(frame)
        evaluated = self.item(name).evaluated_get(self.bpy.context.evaluated_depsgraph_get())
        mesh = evaluated.to_mesh()
        flat = np.empty(3 * len(mesh.vertices), np.float32)
        mesh.vertices.foreach_get("co", flat)
        matrix = np.array(evaluated.matrix_world)
        world = flat.reshape(-1, 3).astype(float) @ matrix[:3, :3].T + matrix[:3, 3]
        evaluated.to_mesh_clear()
        return np.stack([world[:, 0], world[:, 2], -world[:, 1]], axis=1)


class Alembic(BlenderPlayer):
    def open(self):
        self.bpy.ops.wm.alembic_import(filepath=self.file, set_frame_range=False)


class Usd(BlenderPlayer):
    """Without the unit: the numbers are compared as they are stored. Blender turns the objects, which rounds."""

    def open(self):
        self.bpy.ops.wm.usd_import(filepath=self.file, set_frame_range=False, apply_unit_conversion_scale=False)

    def positions(self, name, frame):
        x = super().positions(name, frame)
        return x if self.options.up == "y" else np.stack([x[:, 0], -x[:, 2], x[:, 1]], axis=1)


class Gltf(BlenderPlayer):
    """glTF begins at 0 s and splits vertices; pygltflib reads which vertex of the cache each is."""

    def open(self):
        import pygltflib

        self.bpy.ops.import_scene.gltf(filepath=self.file, merge_vertices=False)
        gltf = pygltflib.GLTF2().load(self.file)
        self.tolerance = gltf.asset.extras["max_error_m"] + ROUNDING
        self.vertices = {}
        blob = gltf.binary_blob()
        for node in gltf.nodes:
            accessor = gltf.accessors[getattr(gltf.meshes[node.mesh].primitives[0].attributes, "_VERTEX")]
            view = gltf.bufferViews[accessor.bufferView]
            self.vertices[node.name] = np.frombuffer(blob, "<f4", accessor.count, view.byteOffset).astype(int)

    def positions(self, name, frame):
        # Blender puts 0 s of a glTF file at its frame 0.
        split = super().positions(name, frame - self.options.first)
        vertices = self.vertices[self.item(name).name]
        if len(split) != len(vertices):
            sys.exit(f"{self.file}: Blender has {len(split)} vertices and the file {len(vertices)}")
        x = np.full((vertices.max() + 1, 3), np.nan)
        x[vertices] = split
        if not np.array_equal(x[vertices], split):
            sys.exit(f"{self.file}: vertices at a seam of the texture come apart at frame {frame}")
        return x


class MeshCache(BlenderPlayer):
    """A PC2 or MDD as modifier of the mesh beside it, or of --mesh."""

    def open(self):
        mesh = self.options.mesh or pathlib.Path(self.file).with_suffix(".obj")
        self.bpy.ops.wm.obj_import(filepath=str(pathlib.Path(mesh).resolve()), forward_axis="NEGATIVE_Z", up_axis="Y")
        modifier = self.items()[0].modifiers.new("cache", "MESH_CACHE")
        modifier.cache_format = pathlib.Path(self.file).suffix[1:].upper()
        modifier.filepath = self.file
        modifier.time_mode, modifier.play_mode = "FRAME", "SCENE"
        modifier.frame_start = self.options.first


class Sequence(BlenderPlayer):
    """A file for each frame, imported one by one."""

    def open(self):
        self.files = numbered(self.file)

    def positions(self, name, frame):
        for item in list(self.bpy.data.objects):
            self.bpy.data.objects.remove(item)
        file = self.file if self.files is None else self.files.get(frame)
        if file is None:
            sys.exit(f"{self.file}: has no frame {frame}")
        if pathlib.Path(self.file).suffix == ".ply":
            self.bpy.ops.wm.ply_import(filepath=str(file), forward_axis="NEGATIVE_Z", up_axis="Y")
        else:
            self.bpy.ops.wm.obj_import(filepath=str(file), forward_axis="NEGATIVE_Z", up_axis="Y")
        return super().positions(name, frame)


class Vtk:
    """A list of .vtu files; the times in it are compared with the frames."""

    tolerance = ROUNDING

    def __init__(self, file, options):
        self.file, self.options = pathlib.Path(file), options
        self.entries = [(float(entry.get("timestep")), self.file.parent / entry.get("file"))
                        for entry in xml.etree.ElementTree.parse(file).iter("DataSet")]
        self.names = [self.file.stem]

    def item(self, name):
        return None

    def grid(self, frame):
        from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

        time, file = self.entries[frame - self.options.first]
        if abs(time - frame / self.options.fps) > 1e-9 * max(1.0, abs(time)):
            sys.exit(f"{self.file}: {file.name} has the time {time} s, and frame {frame} is at {frame / self.options.fps}")
        reader = vtkXMLUnstructuredGridReader()
        reader.SetFileName(str(file))
        reader.Update()
        return reader.GetOutput()

    def positions(self, name, frame):
        from vtkmodules.util.numpy_support import vtk_to_numpy

        return vtk_to_numpy(self.grid(frame).GetPoints().GetData()).astype(float)

    def velocities(self, frame):
        """[points, 3] per second, or None."""
        from vtkmodules.util.numpy_support import vtk_to_numpy

        array = self.grid(frame).GetPointData().GetArray("velocity")
        return None if array is None else vtk_to_numpy(array).astype(float)


PLAYERS = {".abc": Alembic, ".usda": Usd, ".usdc": Usd, ".usd": Usd, ".glb": Gltf, ".pc2": MeshCache, ".mdd": MeshCache,
           ".obj": Sequence, ".ply": Sequence, ".pvd": Vtk}


def player_of(file, options):
    """@param options  fps, first (scene frame of the first sample) and mesh (or None)"""
    suffix = pathlib.Path(file).suffix.lower()
    if suffix not in PLAYERS:
        sys.exit(f"{file}: no program is known that plays {suffix}; known are {', '.join(PLAYERS)}")
    return PLAYERS[suffix](file, options)
