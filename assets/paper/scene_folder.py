"""The folder of a scene: surfaces, tetrahedra filled by `toile mesh`, and the scene file that uses them."""

import json
import subprocess
from pathlib import Path

import numpy as np

from solids import contour


def read_tetrahedra(path):
    """Points [n, 3] and cells [m, 4] of a file that `toile mesh` wrote: one block of each."""
    words = Path(path).read_text().split()
    nodes, elements = words.index("$Nodes"), words.index("$Elements")
    count = int(words[nodes + 2])
    points = np.array(words[nodes + 9 + count : nodes + 9 + 4 * count], float).reshape(-1, 3)
    cells = np.array(words[elements + 9 : words.index("$EndElements")], int).reshape(-1, 5)[:, 1:] - 1
    return points, cells


class SceneFolder:
    def __init__(self, path, cell, toile):
        """`cell` [m] is the edge of tetrahedra; `toile` the program that fills surfaces with them."""
        self.path, self.cell, self.toile = Path(path), cell, toile
        self.vertices = {}  # of each file of tetrahedra
        self.path.mkdir(parents=True, exist_ok=True)

    def surface(self, name, vertices, faces):
        """Writes an OBJ; faces are lists of vertices, from 0."""
        lines = ["v %.6g %.6g %.6g" % tuple(v) for v in vertices]
        lines += ["f " + " ".join(str(i + 1) for i in face) for face in faces]
        (self.path / f"{name}.obj").write_text("\n".join(lines) + "\n")
        return f"{name}.obj"

    def body(self, name, solid):
        """Writes the tetrahedra that fill a solid, once for all bodies of this name."""
        file = f"{name}.msh"
        if file not in self.vertices:
            surface = self.path / self.surface(name, *contour(solid, min(0.7 * self.cell, solid.detail)))
            command = [self.toile, "mesh", surface, "--cell", str(self.cell), "-o", self.path / file, "--json"]
            answer = subprocess.run(command, check=True, stdout=subprocess.PIPE).stdout
            self.vertices[file] = json.loads(answer)["vertices"]
            surface.unlink()
        return file

    def tetrahedra(self, name, points, cells):
        """Writes tetrahedra; cells are four vertices each, from 0."""
        lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$Nodes", str(len(points))]
        lines += ["%d %.9g %.9g %.9g" % (i + 1, *p) for i, p in enumerate(points)]
        lines += ["$EndNodes", "$Elements", str(len(cells))]
        lines += ["%d 4 0 %d %d %d %d" % (i + 1, *(k + 1 for k in cell)) for i, cell in enumerate(cells)]
        (self.path / f"{name}.msh").write_text("\n".join(lines + ["$EndElements"]) + "\n")
        self.vertices[f"{name}.msh"] = len(points)
        return f"{name}.msh"

    def write(self, name, scene):
        bodies = scene["soft_bodies"]
        path = self.path / f"{name}.json"
        path.write_text(json.dumps({"toile": 1, **scene}, indent=1) + "\n")
        vertices = sum(self.vertices[body["file"]] for body in bodies)
        print(f"{path}: {len(bodies)} bodies, {vertices} vertices, {3 * vertices} degrees of freedom")
