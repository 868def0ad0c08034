#include "export/alembic/abc_cache.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/time/sample_times.h"
#include "export/alembic/abc_reader.h"
#include "export/alembic/abc_transform.h"
#include "export/archive/polygons.h"
#include "export/byte_order.h"
#include "export/cache_path.h"
#include "export/times/frame_times.h"

namespace toile::exports {

namespace {

/// Times that differ by less are one [s].
constexpr double kSameTime = 1e-6;

bool is_mesh(const AbcReadObject& object) { return object.is("PolyMesh") || object.is("SubD"); }

std::vector<int> meshes_of(const AbcReader& reader)
{
    std::vector<int> meshes;
    for (size_t k = 0; k < reader.objects().size(); ++k)
        if (is_mesh(reader.objects()[k]))
            meshes.push_back(int(k));
    return meshes;
}

/// Index of the mesh with this path; of the only one if the path is empty.
int mesh_in(const AbcReader& reader, const std::string& path)
{
    const std::vector<int> meshes = meshes_of(reader);
    std::string known;
    for (const int mesh : meshes) {
        if (reader.path_of(mesh) == path || (path.empty() && meshes.size() == 1))
            return mesh;
        known += (known.empty() ? "" : ", ") + reader.path_of(mesh);
    }
    const std::string why = meshes.empty() ? "has no mesh"
                            : path.empty() ? "has several meshes; name one behind #: " + known
                                           : "has no mesh " + path + "; its meshes are " + known;
    throw InvalidInput(reader.path().string() + ": " + why);
}

class AbcSource final : public PointCache::Source {
public:
    AbcSource(const std::filesystem::path& file, const std::string& mesh_path)
        : reader_(file), object_(mesh_in(reader_, mesh_path)), transform_(reader_, object_)
    {
        positions_ = required("P", AbcType::Float32, 3);
        point_times_ = reader_.times_of(positions_, object_);
        times_ = all_times();
        frame_count = int(times_.size());
        vertex_count = int(reader_.sample(positions_, 0).size() / kPoint);
        read_times();
        read_axes();
        read_faces();
        read_texture();
        read_groups();
    }

    std::vector<Vec3> frame(int index) const override
    {
        const double t = times_[size_t(index)];
        const SamplePlace place = place_in(point_times_, t);
        std::vector<Vec3> x = points(place.sample);
        if (place.part > 0.0) {
            const std::vector<Vec3> next = points(place.sample + 1);
            for (size_t v = 0; v < x.size(); ++v)
                x[v] += place.part * (next[v] - x[v]);
        }
        transform_.apply(t, x);
        return x;
    }

private:
    static constexpr size_t kPoint = 3 * sizeof(float);

    const AbcReadObject& object() const { return reader_.objects()[size_t(object_)]; }
    [[noreturn]] void refuse(const std::string& why) const { reader_.refuse(object_, why); }

    AbcReadProperty required(const std::string& name, AbcType type, int extent) const
    {
        const auto property = reader_.find(object().properties, {".geom", name});
        if (!property || property->type != int(type) || property->extent != extent || property->samples < 1)
            refuse("has no \"" + name + "\" of the type that the format prescribes; export it again");
        return *property;
    }

    std::vector<Vec3> points(int sample) const
    {
        const std::vector<float> values = values_of<float>(reader_.sample(positions_, sample));
        if (values.size() != 3 * size_t(vertex_count))
            refuse("has " + std::to_string(values.size() / 3) + " points in sample " +
                   std::to_string(sample) + " and " + std::to_string(vertex_count) +
                   " in the first; a cache can't change its points");
        std::vector<Vec3> x;
        x.reserve(size_t(vertex_count));
        for (size_t k = 0; k < values.size(); k += 3)
            x.push_back(Vec3(values[k], values[k + 1], values[k + 2]));
        return x;
    }

    /// Times of the samples of points and of transforms, each once.
    std::vector<double> all_times() const
    {
        std::vector<double> all = transform_.times();
        if (positions_.samples > 1 || all.empty())
            all.insert(all.end(), point_times_.begin(), point_times_.end());
        std::sort(all.begin(), all.end());
        const auto is_same = [](double a, double b) { return b - a < kSameTime; };
        all.erase(std::unique(all.begin(), all.end(), is_same), all.end());
        return all;
    }

    /// Samples at regular times have a rate. Programs that write several per frame leave that of frames in
    /// the archive.
    void read_times()
    {
        if (frame_count < 2)
            return;
        if (const auto found = frame_times(times_, 0.0, reader_.frames_per_second())) {
            fps = found->fps;
            subframes = found->subframes;
            start_frame = found->start_frame;
        } else {
            times = times_;
        }
    }

    /// Archives of Toile say unit and axis; those of others do not.
    void read_axes()
    {
        const Axes said{reader_.value_of("toile_unit"), reader_.value_of("toile_up")};
        if ((said.unit == "m" || said.unit == "cm") && (said.up == "y" || said.up == "z"))
            axes = said;
    }

    std::vector<std::int32_t> constant_integers(const std::string& name) const
    {
        const AbcReadProperty property = required(name, AbcType::Int32, 1);
        if (property.last_changed > 0)
            refuse("changes its faces; a cache needs a mesh of constant topology");
        return values_of<std::int32_t>(reader_.sample(property, 0));
    }

    /// Turns the faces, which are clockwise.
    void read_faces()
    {
        mesh.polygons = polygons_of(constant_integers(".faceCounts"), constant_integers(".faceIndices"),
                                    vertex_count, [this](const std::string& why) { refuse(why); });
        for (std::vector<int>& polygon : mesh.polygons)
            std::reverse(polygon.begin(), polygon.end());
        mesh.positions = frame(0);
    }

    /// Texture coordinates per corner or per point, with indices or without.
    void read_texture()
    {
        const auto texture = reader_.find(object().properties, {".geom", "uv"});
        if (!texture)
            return;
        const auto values =
            texture->is_compound ? reader_.find(object().properties, {".geom", "uv", ".vals"}) : texture;
        if (!values || values->samples < 1 || values->type != int(AbcType::Float32) || values->extent != 2)
            return;
        const std::vector<float> numbers = values_of<float>(reader_.sample(*values, 0));
        std::vector<std::uint32_t> at(numbers.size() / 2);
        std::iota(at.begin(), at.end(), 0u);
        const auto indices = reader_.find(object().properties, {".geom", "uv", ".indices"});
        if (indices && indices->samples > 0 && indices->type == int(AbcType::Uint32))
            at = values_of<std::uint32_t>(reader_.sample(*indices, 0));
        const bool is_per_point = texture->metadata.find("geoScope=vtx") != std::string::npos ||
                                  texture->metadata.find("geoScope=var") != std::string::npos;
        size_t corners = 0;
        for (const std::vector<int>& polygon : mesh.polygons)
            corners += polygon.size();
        const auto is_beyond = [&](std::uint32_t k) { return k >= numbers.size() / 2; };
        if (at.size() != (is_per_point ? size_t(vertex_count) : corners) ||
            std::any_of(at.begin(), at.end(), is_beyond) ||
            !std::all_of(numbers.begin(), numbers.end(), [](float x) { return std::isfinite(x); }))
            return; // of another kind, or nonsense: the mesh goes without
        for (size_t k = 0; k + 1 < numbers.size(); k += 2)
            mesh.texture_coordinates.push_back(Vec2(numbers[k], numbers[k + 1]));
        size_t first = 0;
        for (const std::vector<int>& polygon : mesh.polygons) {
            std::vector<int>& uvs = mesh.polygon_uvs.emplace_back();
            for (size_t k = 0; k < polygon.size(); ++k)
                uvs.push_back(
                    int(is_per_point ? at[size_t(polygon[k])] : at[first + polygon.size() - 1 - k]));
            first += polygon.size();
        }
    }

    /// Face sets as groups.
    void read_groups()
    {
        constexpr size_t kSetsOfPolygon = 100; // most, in the mean
        std::vector<std::string> set_of(mesh.polygons.size());
        size_t members = 0;
        for (const AbcReadObject& set : reader_.objects()) {
            if (set.parent != object_ || !set.is("FaceSet"))
                continue;
            const auto faces = reader_.find(set.properties, {".faceset", ".faces"});
            if (!faces || faces->samples < 1 || faces->type != int(AbcType::Int32))
                continue;
            const std::vector<std::int32_t> polygons = values_of<std::int32_t>(reader_.sample(*faces, 0));
            members += polygons.size();
            if (members > kSetsOfPolygon * set_of.size())
                refuse("has face sets of " + std::to_string(members) + " faces together");
            for (const std::int32_t polygon : polygons)
                if (polygon >= 0 && size_t(polygon) < set_of.size())
                    set_of[size_t(polygon)] = set.name;
        }
        for (size_t k = 0; k < set_of.size(); ++k)
            if (set_of[k] != (k == 0 ? std::string() : set_of[k - 1]))
                begin_group(mesh, set_of[k], int(k));
    }

    AbcReader reader_;
    int object_;
    AbcTransform transform_;
    AbcReadProperty positions_;
    std::vector<double> point_times_; ///< [samples of the points] [s]
    std::vector<double> times_;       ///< [frames] [s]
};

} // namespace

std::vector<std::string> abc_mesh_paths(const std::filesystem::path& archive)
{
    const AbcReader reader(archive);
    std::vector<std::string> paths;
    for (const int mesh : meshes_of(reader))
        paths.push_back(reader.path_of(mesh));
    return paths;
}

std::unique_ptr<const PointCache::Source> open_abc(const std::filesystem::path& file)
{
    return std::make_unique<AbcSource>(archive_of(file), mesh_path_of(file));
}

} // namespace toile::exports
