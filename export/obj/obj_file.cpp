#include "export/obj/obj_file.h"

#include "core/mesh/obj.h"

namespace toile::exports {

MeshFileWriter obj_file_writer(const CacheLayout& layout)
{
    return [mesh = layout.meshes.front().faces](const std::filesystem::path& file,
                                                const SampleView& sample) mutable {
        mesh.positions.assign(sample.positions.begin(), sample.positions.end());
        write_obj(file, mesh);
    };
}

} // namespace toile::exports
