#include "export/obj/coloured_obj.h"

#include <array>
#include <charconv>
#include <string>

#include "core/base/atomic_file.h"

namespace toile::exports {

namespace {

/// Whatever the locale.
void append(std::string& text, double number, std::chars_format format, int digits)
{
    std::array<char, 32> buffer;
    const auto [end, error] =
        std::to_chars(buffer.data(), buffer.data() + buffer.size(), number, format, digits);
    (text += ' ').append(buffer.data(), end);
}

} // namespace

void write_coloured_obj(const std::filesystem::path& file, const TriangleMesh& mesh, View<const Vec3> colours)
{
    std::string text;
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        text += 'v';
        for (const double x : mesh.positions[size_t(v)])
            append(text, x, std::chars_format::general, 9);
        for (const double channel : colours[v])
            append(text, channel, std::chars_format::fixed, 4);
        text += '\n';
    }
    for (const Triangle& t : mesh.triangles) {
        text += 'f';
        for (const int v : t)
            text += ' ' + std::to_string(v + 1);
        text += '\n';
    }
    write_atomically(file, text);
}

} // namespace toile::exports
