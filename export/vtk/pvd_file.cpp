#include "export/vtk/pvd_file.h"

#include "core/base/atomic_file.h"
#include "core/base/number.h"

namespace toile::exports {

namespace {

constexpr std::string_view kHead =
    "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n<Collection>\n";
constexpr std::string_view kEnd = "</Collection>\n</VTKFile>\n";

/// Text in an attribute of XML.
std::string escaped(const std::string& text)
{
    std::string escaped;
    for (const char c : text)
        escaped += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '"' ? "&quot;" : std::string(1, c);
    return escaped;
}

} // namespace

void PvdFile::add(double time, const std::string& name)
{
    const std::string entry =
        "<DataSet timestep=\"" + shortest_text(time) + "\" part=\"0\" file=\"" + escaped(name) + "\"/>\n";
    if (!file_) {
        write_atomically(path_, std::string(kHead) + entry + std::string(kEnd));
        file_.emplace(path_, BinaryFile::Mode::Continue);
        end_ = std::int64_t(kHead.size() + entry.size());
        return;
    }
    file_->require_in_place();
    file_->write_at(end_, entry + std::string(kEnd));
    end_ += std::int64_t(entry.size());
}

void PvdFile::complete()
{
    file_->sync();
    file_->require_in_place();
}

} // namespace toile::exports
