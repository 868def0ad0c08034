#include "volume/mesh/msh.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <optional>
#include <string_view>
#include <unordered_map>

#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "core/base/number.h"

namespace toile::volume {

namespace {

/// Types of Gmsh's elements.
constexpr std::int64_t kTetrahedron = 4;

/// Corners of elements without a volume, which Gmsh writes beside it; 0 for others.
int corners_of_flat(std::int64_t type)
{
    switch (type) {
    case 15: // point
        return 1;
    case 1:
        return 2;
    case 2:
        return 3;
    case 3:
        return 4;
    default:
        return 0;
    }
}

class MshReader {
public:
    explicit MshReader(const std::filesystem::path& path) : source_(path.string())
    {
        std::ifstream stream(path, std::ios::binary);
        if (!stream)
            throw InvalidInput(source_ + ": can't be opened; check the path and its permissions");
        text_.assign(std::istreambuf_iterator<char>(stream), {});
    }

    TetMesh read()
    {
        if (line() != "$MeshFormat")
            refuse("not a Gmsh file; its first line is $MeshFormat");
        read_format();
        while (at_ < text_.size()) {
            const std::string_view section = line();
            if (section == "$Nodes")
                is_version_4_ ? read_node_blocks() : read_nodes();
            else if (section == "$Elements")
                is_version_4_ ? read_element_blocks() : read_elements();
            else if (section.starts_with("$"))
                skip(section.substr(1));
            else if (!section.empty())
                refuse(in_quotes(section) + " where a section should begin, such as $Nodes");
        }
        if (mesh_.tets.empty())
            throw InvalidInput(source_ +
                               ": has no linear tetrahedra (elements of type 4); mesh the volume, and save "
                               "all elements");
        orient(
            mesh_, [this](int t) { return "element " + std::to_string(element_of_tet_[t]); }, source_);
        remove_unused_vertices(mesh_);
        return std::move(mesh_);
    }

private:
    void read_format()
    {
        const std::string_view version = word();
        is_version_4_ = version == "4.1";
        if (!is_version_4_ && version != "2" && !version.starts_with("2."))
            refuse("version " + in_quotes(version) +
                   "; versions 2.2 and 4.1 are read, choose one of them in Gmsh");
        const std::string_view coding = word();
        if (coding != "0" && coding != "1")
            refuse(in_quotes(coding) + " where 0 (ASCII) or 1 (binary) should stand");
        if (const std::string_view size = word(); size != "8")
            refuse("numbers of " + in_quotes(size) + " bytes; 8 are read");
        line();
        is_binary_ = coding == "1";
        if (is_binary_ && whole(4) != 1)
            refuse("binary numbers in another byte order; save the file in ASCII");
        end_section("MeshFormat");
    }

    // Version 2.

    void read_nodes()
    {
        const std::int64_t nodes = count_in_line(kLeastNode);
        for (std::int64_t i = 0; i < nodes; ++i) {
            const std::int64_t tag = whole(4);
            add_node(tag, point());
        }
        end_section("Nodes");
    }

    void read_elements()
    {
        std::int64_t left = count_in_line(kLeastElement);
        while (left > 0) {
            std::int64_t tag = 0, type = 0, same = 1, tags = 0;
            if (is_binary_) { // elements of one type, with one header
                type = whole(4);
                same = whole(4);
                tags = whole(4);
                if (same < 1 || same > left)
                    refuse(std::to_string(same) + " elements of a type, where " + std::to_string(left) +
                           " are left");
            } else {
                tag = whole(4);
                type = whole(4);
                tags = whole(4);
            }
            for (std::int64_t i = 0; i < same; ++i) {
                if (is_binary_)
                    tag = whole(4);
                for (std::int64_t k = 0; k < tags; ++k)
                    whole(4);
                read_corners(tag, type, 4);
            }
            left -= same;
        }
        end_section("Elements");
    }

    // Version 4.1.

    void read_node_blocks()
    {
        const std::int64_t blocks = whole(8), nodes = whole(8);
        skip_whole(2, 8); // smallest and largest tag
        for (std::int64_t b = 0; b < blocks; ++b) {
            const std::int64_t dimension = whole(4);
            whole(4); // tag of the entity
            const bool is_parametric = whole(4) != 0;
            const std::int64_t size = count(8, kLeastNode);
            std::vector<std::int64_t> tags;
            for (std::int64_t i = 0; i < size; ++i)
                tags.push_back(whole(8));
            for (const std::int64_t tag : tags) {
                add_node(tag, point());
                for (std::int64_t k = 0; is_parametric && k < std::min<std::int64_t>(dimension, 3); ++k)
                    real();
            }
        }
        if (std::int64_t(mesh_.positions.size()) != nodes)
            refuse(std::to_string(nodes) + " nodes are announced, the blocks have " +
                   std::to_string(mesh_.positions.size()));
        end_section("Nodes");
    }

    void read_element_blocks()
    {
        const std::int64_t blocks = whole(8);
        skip_whole(3, 8); // number of elements, smallest and largest tag
        for (std::int64_t b = 0; b < blocks; ++b) {
            skip_whole(2, 4); // dimension and tag of the entity
            const std::int64_t type = whole(4), size = count(8, kLeastElement);
            for (std::int64_t i = 0; i < size; ++i) {
                const std::int64_t tag = whole(8);
                read_corners(tag, type, 8);
            }
        }
        end_section("Elements");
    }

    // Both.

    void add_node(std::int64_t tag, const Vec3& x)
    {
        if (!node_of_tag_.try_emplace(tag, int(mesh_.positions.size())).second)
            refuse("node " + std::to_string(tag) + " exists twice");
        mesh_.positions.push_back(x);
    }

    void read_corners(std::int64_t element, std::int64_t type, int bytes)
    {
        if (const int corners = corners_of_flat(type); corners > 0) {
            skip_whole(corners, bytes);
            return;
        }
        if (type != kTetrahedron)
            refuse("element " + std::to_string(element) + " is of type " + std::to_string(type) +
                   "; only linear tetrahedra (4) are read, set the element order to 1 in Gmsh");
        Tet tet{};
        for (int& corner : tet) {
            const std::int64_t tag = whole(bytes);
            const auto node = node_of_tag_.find(tag);
            if (node == node_of_tag_.end())
                refuse("element " + std::to_string(element) + " uses node " + std::to_string(tag) +
                       ", which does not exist");
            corner = node->second;
        }
        mesh_.tets.push_back(tet);
        element_of_tet_.push_back(element);
    }

    // Text and numbers.

    static constexpr std::int64_t kLeastNode = 7, kLeastElement = 8; // bytes of the shortest

    std::string_view line()
    {
        const size_t end = std::min(text_.find('\n', at_), text_.size());
        std::string_view found = std::string_view(text_).substr(at_, end - at_);
        at_ = std::min(end + 1, text_.size());
        while (!found.empty() && (found.back() == '\r' || found.back() == ' '))
            found.remove_suffix(1);
        return found;
    }

    std::string_view word()
    {
        constexpr const char* kBlank = " \t\r\n";
        at_ = std::min(text_.find_first_not_of(kBlank, at_), text_.size());
        const size_t begin = at_;
        at_ = std::min(text_.find_first_of(kBlank, begin), text_.size());
        return std::string_view(text_).substr(begin, at_ - begin);
    }

    template <typename Stored>
    Stored binary()
    {
        if (text_.size() - at_ < sizeof(Stored))
            refuse("the file ends within a number");
        Stored value;
        std::memcpy(&value, text_.data() + at_, sizeof(Stored));
        at_ += sizeof(Stored);
        return value;
    }

    /// @param bytes  of a binary number
    std::int64_t whole(int bytes)
    {
        if (is_binary_)
            return bytes == 4 ? binary<std::int32_t>() : binary<std::int64_t>();
        const std::string_view found = word();
        const std::optional<std::int64_t> value = whole_number_in(found);
        if (!value)
            refuse(in_quotes(found) + " is not a whole number");
        return *value;
    }
    void skip_whole(std::int64_t count, int bytes)
    {
        for (std::int64_t i = 0; i < count; ++i)
            whole(bytes);
    }

    double real()
    {
        std::string_view found;
        std::optional<double> value;
        if (is_binary_)
            value = binary<double>();
        else
            value = number_in(found = word());
        if (!value || !std::isfinite(*value))
            refuse((is_binary_ ? "a number" : in_quotes(found)) + " is not finite");
        return *value;
    }

    Vec3 point()
    {
        const double x = real(), y = real(), z = real();
        return Vec3(x, y, z);
    }

    /// Number of things of at least `least` bytes each.
    std::int64_t count(int bytes, std::int64_t least) { return require_possible(whole(bytes), least); }
    std::int64_t require_possible(std::int64_t number, std::int64_t least) const
    {
        if (number < 0 || number > std::int64_t(text_.size()) / least + 1)
            refuse(std::to_string(number) + " where a number should stand that the file has room for");
        return number;
    }
    /// The same as text on a line, which binary files of version 2 have too.
    std::int64_t count_in_line(std::int64_t least)
    {
        const std::string_view found = line();
        const std::optional<std::int64_t> value = whole_number_in(found);
        if (!value)
            refuse(in_quotes(found) + " where a number of items should stand");
        return require_possible(*value, least);
    }

    void end_section(std::string_view name)
    {
        if (const std::string_view found = word(); found != "$End" + std::string(name))
            refuse(in_quotes(found) + " where $End" + std::string(name) + " should stand");
        line();
    }
    void skip(std::string_view name)
    {
        const size_t end = text_.find("$End" + std::string(name), at_);
        if (end == std::string::npos)
            refuse("section $" + std::string(name) + " does not end");
        at_ = end;
        line();
    }

    static std::string in_quotes(std::string_view word)
    {
        constexpr size_t kLongest = 40;
        return word.empty() ? "the end of the file" : "'" + std::string(word.substr(0, kLongest)) + "'";
    }

    [[noreturn]] void refuse(const std::string& why) const
    {
        const auto number = 1 + std::count(text_.begin(), text_.begin() + std::ptrdiff_t(at_), '\n');
        throw InvalidInput(source_ +
                           (is_binary_ ? ": byte " + std::to_string(at_) : ":" + std::to_string(number)) +
                           ": " + why);
    }

    std::string source_;
    std::string text_;
    size_t at_ = 0;
    bool is_version_4_ = false, is_binary_ = false;
    TetMesh mesh_;
    std::unordered_map<std::int64_t, int> node_of_tag_;
    std::vector<std::int64_t> element_of_tet_;
};

} // namespace

TetMesh read_msh_tets(const std::filesystem::path& file) { return MshReader(file).read(); }

void write_msh(const std::filesystem::path& file, const TetMesh& mesh)
{
    const std::string nodes = std::to_string(mesh.vertex_count()), tets = std::to_string(mesh.tet_count());
    std::string text = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n";
    text += "$Nodes\n1 " + nodes + " 1 " + nodes + "\n3 1 0 " + nodes + "\n";
    for (int v = 1; v <= mesh.vertex_count(); ++v)
        text += std::to_string(v) + "\n";
    for (const Vec3& x : mesh.positions)
        text += shortest_text(x.x()) + " " + shortest_text(x.y()) + " " + shortest_text(x.z()) + "\n";
    text += "$EndNodes\n$Elements\n1 " + tets + " 1 " + tets + "\n3 1 4 " + tets + "\n";
    for (int t = 0; t < mesh.tet_count(); ++t) {
        text += std::to_string(t + 1);
        for (const int v : mesh.tets[t])
            text += " " + std::to_string(v + 1);
        text += "\n";
    }
    write_atomically(file, text + "$EndElements\n");
}

} // namespace toile::volume
