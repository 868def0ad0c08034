#include "apps/toile/fit/fit_files.h"

#include <utility>

#include "apps/toile/fit/fit_pictures.h"
#include "core/base/atomic_file.h"
#include "export/obj/coloured_obj.h"

namespace toile::app {

FitFiles::FitFiles(std::filesystem::path folder, std::vector<std::string> names)
    : folder_(std::move(folder)), names_(std::move(names))
{
}

std::vector<std::filesystem::path> FitFiles::all() const
{
    std::vector<std::filesystem::path> files{report()};
    for (const std::string& name : names_) {
        files.push_back(table(name));
        for (const char* of : {"tension", "strain", "gap"})
            for (const char* extension : {".obj", ".png"})
                files.push_back(map(name, of, extension));
    }
    return files;
}

void FitFiles::write(const std::vector<GarmentFit>& fits, const TriangleMesh& body, const RunLog& log) const
{
    for (const GarmentFit& fit : fits) {
        const std::string& name = fit.garment.name;
        write_atomically(table(name), to_csv(fit));
        log.file(table(name));
        const std::vector<preview::Image> pictures = fit_pictures(fit.garment, fit.maps, body, fit.front);
        for (size_t m = 0; m < fit.maps.size(); ++m) {
            const VertexMap& of = fit.maps[m];
            exports::write_coloured_obj(map(name, of.name, ".obj"), fit.garment.mesh, colours_of(of));
            log.file(map(name, of.name, ".obj"));
            preview::write_png(map(name, of.name, ".png"), pictures[m]);
            log.file(map(name, of.name, ".png"));
        }
    }
    write_atomically(report(), to_json(fits));
    log.file(report());
}

} // namespace toile::app
