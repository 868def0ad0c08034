"""What Toile lets Pixar's library do with USD files. Needs the modules of usd-core (pip install usd-core).

    usd_commands.py version                   prints the version of USD
    usd_commands.py meshes FILE               prints the paths of the meshes, one a line
    usd_commands.py frames FILE PATH OUTPUT   writes a mesh and its frames into a file that the caller has open, and
                                              removes its name; usd_frames.h says how
    usd_commands.py usdc FILE OUTPUT          writes a .usda of Toile as one .usdc, without value clips

Exit codes: 3 without the modules; 4 for a file that is refused, and 5 for another failure, with the reason on the
standard output; 6 when all is done, which no program says that is not this one.
"""

import os
import struct
import sys

MISSING, REFUSED, BROKE_OFF, DONE = 3, 4, 5, 6

# Files are read, not mapped: memory is what the frames at hand take, and a file that shrinks is an error.
os.environ.setdefault("USDC_USE_PREAD", "1")
try:
    from pxr import Gf, Sdf, Tf, Usd, UsdGeom, UsdSkel, Vt
except ImportError:
    sys.exit(MISSING)

MAX_FRAMES = 10_000_000
MAX_SUBFRAMES = 64
NEAR = 1e-4  # frames; times that differ by less are the same
FRAMES_AT_ONCE = 50  # between two looks at how many layers are open
LAYERS_AT_ONCE = 4  # of value clips, which a stage keeps until it is closed
NAMED = 20  # most meshes that a message lists
FACE_VARYING, PER_POINT = 1, 2  # scopes of texture coordinates


def refuse(text):
    sys.stdout.buffer.write(text.encode("utf-8", "replace"))
    sys.stdout.flush()
    sys.exit(REFUSED)


def open_stage(file):
    try:
        return Usd.Stage.Open(file)
    except Tf.ErrorException:
        refuse("can't be opened as USD; it is empty, cut off or of another format, export it again")


def mesh_prims(stage):
    return [prim for prim in Usd.PrimRange.Stage(stage, Usd.TraverseInstanceProxies()) if prim.IsA(UsdGeom.Mesh)]


def find_mesh(stage, path):
    meshes = mesh_prims(stage)
    known = ", ".join([str(prim.GetPath()) for prim in meshes[:NAMED]] + ["..."] * (len(meshes) > NAMED))
    if not meshes:
        refuse("has no mesh")
    if not path and len(meshes) > 1:
        refuse("has several meshes; name one behind #: " + known)
    for prim in meshes:
        if not path or str(prim.GetPath()) == path:
            return prim
    refuse(f"has no mesh {path}; its meshes are {known}")


class Mesh:
    """A mesh of a stage, which is opened anew when many clips have been read: memory stays flat."""

    def __init__(self, file, path):
        self.file, self.path = file, path
        self.open()
        self.name = str(self.prim.GetPath())

    def open(self):
        self.stage = open_stage(self.file)
        self.prim = find_mesh(self.stage, self.path)
        self.layers = len(self.stage.GetUsedLayers())

    def release_clips(self):
        if len(self.stage.GetUsedLayers()) > self.layers + LAYERS_AT_ONCE:
            self.prim = self.stage = None
            self.open()

    def refuse(self, text):
        refuse(f"{self.name} {text}")

    def geometry(self):
        return UsdGeom.Mesh(self.prim)

    def points(self, time):
        points = self.geometry().GetPointsAttr().Get(time)
        if not isinstance(points, Vt.Vec3fArray):
            self.refuse("has no points" + at_time(time) + "; export it again")
        return points

    def faces(self, time):
        mesh = self.geometry()
        return mesh.GetFaceVertexCountsAttr().Get(time), mesh.GetFaceVertexIndicesAttr().Get(time)

    def faces_may_change(self):
        mesh = self.geometry()
        return any(attribute.ValueMightBeTimeVarying()
                   for attribute in (mesh.GetFaceVertexCountsAttr(), mesh.GetFaceVertexIndicesAttr()))

    def sample_times(self, first, last):
        """Time codes of all samples of points and transforms, of all meshes of the stage, which then have as many
        frames each; ascending."""
        if not any(has_clips(prim) for prim in mesh_prims(self.stage)):
            return sorted(set(self.samples_in(Gf.Interval.GetFullInterval())))
        times, begin = set(), first
        while begin <= last:
            times |= set(self.samples_in(Gf.Interval(begin, min(begin + FRAMES_AT_ONCE, last))))
            begin += FRAMES_AT_ONCE
            self.release_clips()
        return sorted(times)

    def transforms_move(self):
        return any(transform.TransformMightBeTimeVarying()
                   for prim in mesh_prims(self.stage) for transform in transforms_above(prim))

    def samples_in(self, interval):
        times = []
        for prim in mesh_prims(self.stage):
            times += UsdGeom.Mesh(prim).GetPointsAttr().GetTimeSamplesInInterval(interval)
            for transform in transforms_above(prim):
                times += transform.GetTimeSamplesInInterval(interval)
        return times


def at_time(time):
    return "" if time.IsDefault() else f" at time code {time.GetValue():g}"


def transforms_above(prim):
    """Of a prim and all above it that move it."""
    while prim and not prim.IsPseudoRoot():
        transform = UsdGeom.Xformable(prim)
        if transform:
            yield transform
            if transform.GetResetXformStack():
                return
        prim = prim.GetParent()


def has_clips(prim):
    while prim and not prim.IsPseudoRoot():
        if prim.HasAuthoredMetadata("clips"):
            return True
        prim = prim.GetParent()
    return False


class Sampling:
    """Times of the frames: regular, and such that every sample is one of them; where that is not possible, those of
    the samples."""

    def __init__(self, mesh):
        stage = mesh.stage
        layer = stage.GetRootLayer()
        codes_per_second = stage.GetTimeCodesPerSecond()
        self.fps = stage.GetFramesPerSecond() if layer.HasFramesPerSecond() else codes_per_second
        if not (0 < self.fps < 1e9 and 0 < codes_per_second < 1e9):
            refuse(f"has {self.fps:g} frames and {codes_per_second:g} time codes a second; they must be positive")
        self.codes_per_second = codes_per_second
        self.step = codes_per_second / self.fps  # time codes of a frame
        first, last = 0.0, 0.0
        if stage.HasAuthoredTimeCodeRange():
            first, last = stage.GetStartTimeCode(), stage.GetEndTimeCode()
        if not -1e9 < first <= last < 1e9:
            refuse(f"begins at time code {first:g} and ends at {last:g}")
        told = layer.customLayerData.get("toileSubframes")  # Toile's own samples are regular: no clip need be opened
        is_told = first < last and isinstance(told, int) and 0 < told <= 1000
        self.samples = [] if is_told else mesh.sample_times(first, last)
        if first == last and self.samples:
            first, last = self.samples[0], self.samples[-1]
        self.start = first / self.step
        within = [(time - first) / self.step for time in self.samples if first <= time <= last]
        self.subframes = told if is_told else self.subframes_of(within)
        self.is_regular = self.subframes is not None
        self.subframes = self.subframes or 1
        count = int((last - first) / self.step * self.subframes + NEAR) + 1
        if count > MAX_FRAMES:
            refuse(f"has {count} frames; {MAX_FRAMES} are the most that are read")
        self.times = [self.nearest(first + k * self.step / self.subframes) for k in range(count)]
        if not self.is_regular:
            self.times = self.irregular(mesh, first, last)

    def irregular(self, mesh, first, last):
        """Those of the samples, and the frames where transforms move: between samples USD turns their angles."""
        times = [first, last, *(time for time in self.samples if first < time < last)]
        if mesh.transforms_move():
            times += self.times
        times.sort()
        kept = times[:1]
        for time in times[1:]:
            if time - kept[-1] > NEAR * self.step:
                kept.append(time)
        return kept

    @staticmethod
    def subframes_of(times):
        for count in range(1, MAX_SUBFRAMES + 1):
            if all(abs(time * count - round(time * count)) < NEAR for time in times):
                return count
        return None

    def nearest(self, time):
        """The sample at a time, whose code may be rounded otherwise."""
        low, high = 0, len(self.samples)
        while low < high:
            middle = (low + high) // 2
            if self.samples[middle] < time - NEAR * self.step:
                low = middle + 1
            else:
                high = middle
        if low < len(self.samples) and abs(self.samples[low] - time) <= NEAR * self.step:
            return self.samples[low]
        return time


def texture(mesh, time):
    """Scope, coordinates and indices of the first set, "st" before others; scope 0 without any."""
    named = [primvar for primvar in UsdGeom.PrimvarsAPI(mesh.prim).FindPrimvarsWithInheritance()
             if primvar.GetTypeName().scalarType in (Sdf.ValueTypeNames.TexCoord2f, Sdf.ValueTypeNames.TexCoord2d,
                                                     Sdf.ValueTypeNames.TexCoord2h, Sdf.ValueTypeNames.Float2)]
    names = ["st", "UVMap", "uv"]
    named.sort(key=lambda primvar: (names.index(primvar.GetPrimvarName())
                                    if primvar.GetPrimvarName() in names else len(names)))
    scopes = {"faceVarying": FACE_VARYING, "vertex": PER_POINT, "varying": PER_POINT}
    for primvar in named:
        values, indices = primvar.Get(time), primvar.GetIndices(time)
        scope = scopes.get(primvar.GetInterpolation(), 0)
        if scope and values:
            values = values if isinstance(values, Vt.Vec2fArray) else Vt.Vec2fArray([Gf.Vec2f(v) for v in values])
            return scope, values, indices or Vt.IntArray(range(len(values)))
    return 0, Vt.Vec2fArray(), Vt.IntArray()


def groups(mesh, time):
    """Names and faces of the subsets."""
    for subset in UsdGeom.Subset.GetAllGeomSubsets(mesh.geometry()):
        if subset.GetElementTypeAttr().Get() == UsdGeom.Tokens.face:
            prim = subset.GetPrim()
            yield (prim.GetDisplayName() or prim.GetName()).encode("utf-8"), subset.GetIndicesAttr().Get(time)


def write_array(out, array):
    out.write(struct.pack("<I", len(array)))
    if len(array):
        out.write(memoryview(array))


def write_head(out, mesh, sampling, time):
    stage, geometry = mesh.stage, mesh.geometry()
    counts, indices = mesh.faces(time)
    if not counts or not indices:
        mesh.refuse("has no faces" + at_time(time))
    scope, values, at = texture(mesh, time)
    out.write(b"ToileUSD" + struct.pack(
        "<IIIdddIII", len(mesh.points(time)), len(sampling.times), sampling.subframes, sampling.fps, sampling.start,
        UsdGeom.GetStageMetersPerUnit(stage), UsdGeom.GetStageUpAxis(stage) == UsdGeom.Tokens.z,
        geometry.GetOrientationAttr().Get() == UsdGeom.Tokens.leftHanded, scope))
    times = [] if sampling.is_regular else [time / sampling.codes_per_second for time in sampling.times]
    out.write(struct.pack(f"<I{len(times)}d", len(times), *times))
    for array in (counts, indices, values, at):
        write_array(out, array)
    named = list(groups(mesh, time))
    out.write(struct.pack("<I", len(named)))
    for name, faces in named:
        out.write(struct.pack("<I", len(name)) + name)
        write_array(out, faces or Vt.IntArray())


def write_frames(file, path, output):
    mesh = Mesh(file, path)
    if UsdSkel.BindingAPI(mesh.prim).GetInheritedSkeleton():
        mesh.refuse("is moved by a skeleton; bake it into points and export it again")
    sampling = Sampling(mesh)
    first = Usd.TimeCode(sampling.times[0])
    faces, count = mesh.faces(first), len(mesh.points(first))
    with open(output, "r+b") as out:
        os.unlink(output)  # nothing is left of it if this process is killed
        write_head(out, mesh, sampling, first)
        for k, value in enumerate(sampling.times):
            if k % FRAMES_AT_ONCE == 0:
                mesh.release_clips()
                may_change = mesh.faces_may_change()
            time = Usd.TimeCode(value)
            points = mesh.points(time)
            if len(points) != count or (may_change and mesh.faces(time) != faces):
                mesh.refuse(f"changes its faces or points{at_time(time)}; a cache needs a mesh of constant topology")
            world = UsdGeom.XformCache(time).GetLocalToWorldTransform(mesh.prim)
            out.write(struct.pack("<16d", *(world[row][column] for row in range(4) for column in range(4))))
            out.write(memoryview(points))


def print_meshes(file):
    stage = open_stage(file)
    sys.stdout.buffer.write("".join(f"{prim.GetPath()}\n" for prim in mesh_prims(stage)).encode("utf-8"))


def write_usdc(file, output):
    """Copies the root layer, and the samples of its clips one frame after the other, saved from time to time."""
    stage = open_stage(file)
    root = stage.GetRootLayer()
    layer = Sdf.Layer.CreateNew(output)
    layer.TransferContent(root)
    top = layer.GetPrimAtPath("/" + layer.defaultPrim)
    if not top.HasInfo("clips"):
        layer.Save()
        return
    top.ClearInfo("clips")
    top.ClearInfo("clipSets")
    subframes = root.customLayerData["toileSubframes"]
    first = stage.GetStartTimeCode()
    count = round((stage.GetEndTimeCode() - first) * subframes) + 1
    paths = [attribute.GetPath() for prim in stage.Traverse() for attribute in prim.GetAttributes()
             if attribute.ValueMightBeTimeVarying()]
    for k in range(count):
        if k % FRAMES_AT_ONCE == 0:
            layer.Save()
            stage = root = None
            stage = open_stage(file)
        time = first + k / subframes
        for path in paths:
            layer.SetTimeSample(path, time, stage.GetAttributeAtPath(path).Get(time))
    layer.Save()


COMMANDS = {
    "version": lambda: print(*Usd.GetVersion(), sep="."),
    "meshes": print_meshes,
    "frames": write_frames,
    "usdc": write_usdc,
}

if __name__ == "__main__":
    try:
        COMMANDS[sys.argv[1]](*sys.argv[2:])
    except (Tf.ErrorException, OSError, MemoryError, ValueError, TypeError) as error:
        print(type(error).__name__, *str(error).strip().splitlines()[-1:], sep=": ")
        sys.exit(BROKE_OFF)
    sys.stdout.flush()
    sys.exit(DONE)
