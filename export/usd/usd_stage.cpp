#include "export/usd/usd_stage.h"

#include <algorithm>

#include "core/base/number.h"
#include "export/archive/names.h"

namespace toile::exports {

namespace {

std::string pair_text(double a, double b)
{
    std::string text = "(";
    text += shortest_text(a) + ", " + shortest_text(b) + ")";
    return text;
}

} // namespace

UsdStage::UsdStage(const std::string& name, const CacheLayout& layout)
    : layout_(layout), top_(tree_of(name, layout))
{
    for (CacheMesh& mesh : layout_.meshes) {
        meshes_.emplace_back(mesh, UsdMesh::Options{layout.velocities, layout.normals});
        mesh.faces = {};
    }
}

UsdStage::Group UsdStage::tree_of(const std::string& name, const CacheLayout& layout)
{
    Group all{name, {}};
    for (size_t m = 0; m < layout.meshes.size(); ++m) {
        const CacheMesh& mesh = layout.meshes[m];
        std::vector<Group>* siblings = &all.groups;
        if (!mesh.parent.empty()) {
            auto parent = std::find_if(siblings->begin(), siblings->end(), [&](const Group& group) {
                return group.mesh < 0 && group.name == mesh.parent;
            });
            if (parent == siblings->end())
                parent = siblings->insert(parent, {mesh.parent, {}});
            siblings = &parent->groups;
        }
        siblings->push_back({mesh.name, {}, int(m)});
    }
    return all;
}

void UsdStage::add_sample(const MovingSample& sample)
{
    const std::vector<MovingSample> samples = by_mesh(sample, layout_.meshes);
    for (size_t m = 0; m < meshes_.size(); ++m)
        meshes_[m].add_sample(samples[m]);
    times_.push_back(layout_.frame_of(next_sample_++));
}

void UsdStage::drop_all_but_last()
{
    for (UsdMesh& mesh : meshes_)
        mesh.drop_all_but_last();
    times_.erase(times_.begin(), times_.end() - 1);
}

void UsdStage::write_header(UsdFile& file, double first_time, double last_time) const
{
    file << "#usda 1.0\n(\n";
    file << "    customLayerData = {\n        string creator = \"toile\"\n";
    file << "        int toileSubframes = " << std::to_string(layout_.subframes) << "\n    }\n";
    file << "    defaultPrim = \"" << clean_name(top_.name) << "\"\n";
    file << "    endTimeCode = " << shortest_text(last_time) << "\n";
    file << "    framesPerSecond = " << shortest_text(layout_.fps) << "\n";
    file << "    metersPerUnit = " << shortest_text(layout_.axes.metres_per_unit()) << "\n";
    file << "    startTimeCode = " << shortest_text(first_time) << "\n";
    file << "    timeCodesPerSecond = " << shortest_text(layout_.fps) << "\n";
    file << "    upAxis = \"" << (layout_.axes.has_z_up() ? "Z" : "Y") << "\"\n)\n\n";
}

void UsdStage::write_group(UsdFile& file, UsdLayer layer, const Group& group, const std::string& parent,
                           const std::string& metadata) const
{
    const bool defines = layer == UsdLayer::Whole || layer == UsdLayer::Root;
    const std::string name = clean_name(group.name), path = parent + "/" + name;
    const auto depth = size_t(std::count(parent.begin(), parent.end(), '/'));
    const std::string indent(4 * depth, ' ');
    std::string all = metadata;
    if (defines && group.name != name)
        all += indent + "    displayName = " + usd_quoted(group.name) + "\n";
    file << indent << (defines ? "def Xform \"" : "over \"") << name << "\"";
    if (!all.empty())
        file << " (\n" << all << indent << ")";
    file << "\n" << indent << "{\n";
    for (const Group& child : group.groups)
        write_group(file, layer, child, path, "");
    if (group.mesh >= 0)
        meshes_[size_t(group.mesh)].write(file, layer, path, indent + "    ", times_);
    file << indent << "}\n";
}

void UsdStage::write_whole(const std::filesystem::path& path) const
{
    UsdFile file(path);
    write_header(file, times_.front(), times_.back());
    write_group(file, UsdLayer::Whole, top_, "", "");
    file.commit();
}

void UsdStage::write_clip(const std::filesystem::path& path) const
{
    UsdFile file(path);
    write_header(file, times_.front(), times_.back());
    write_group(file, UsdLayer::Clip, top_, "", "");
    file.commit();
}

void UsdStage::write_manifest(const std::filesystem::path& path) const
{
    UsdFile file(path);
    file << "#usda 1.0\n(\n    defaultPrim = \"" << clean_name(top_.name) << "\"\n)\n\n";
    write_group(file, UsdLayer::Manifest, top_, "", "");
    file.commit();
}

void UsdStage::write_root(const std::filesystem::path& path, const std::vector<Clip>& clips,
                          const std::string& manifest, int sample_count) const
{
    const double first = layout_.frame_of(0), last = layout_.frame_of(sample_count - 1);
    std::string active, assets;
    for (size_t k = 0; k < clips.size(); ++k) {
        active += (k == 0 ? "" : ", ") + pair_text(layout_.frame_of(clips[k].first_sample), double(k));
        assets += (k == 0 ? "@" : ", @") + clips[k].asset + "@";
    }
    const std::string metadata =
        "    clips = {\n        dictionary default = {\n            double2[] active = [" + active +
        "]\n            asset[] assetPaths = [" + assets + "]\n            asset manifestAssetPath = @" +
        manifest + "@\n            string primPath = \"/" + clean_name(top_.name) +
        "\"\n            double2[] times = [" + pair_text(first, first) +
        (sample_count > 1 ? ", " + pair_text(last, last) : "") +
        "]\n        }\n    }\n    clipSets = [\"default\"]\n";
    UsdFile file(path);
    write_header(file, first, last);
    write_group(file, UsdLayer::Root, top_, "", metadata);
    file.commit();
}

} // namespace toile::exports
