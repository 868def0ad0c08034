#include "scenes/surfaces/paint.h"

#include "core/base/error.h"
#include "core/base/number.h"
#include "scenes/format/field.h"

namespace toile::scenes {

namespace {

void require_colours(const ClothState& state, const std::string& source)
{
    const ObjMesh& mesh = state.rest;
    if (!mesh.colours.empty())
        return;
    const std::string remedy = "; write each vertex as v x y z r g b";
    if (mesh.first_plain_vertex_line > 0)
        throw InvalidInput(source + ":" + std::to_string(mesh.first_plain_vertex_line) +
                           ": the vertex has no colour, but others have one" + remedy);
    throw InvalidInput(source + ": has no vertex colours, by which cloth \"" + state.name + "\" is painted" +
                       remedy);
}

/// [vertices] values between `from` and `to`, by a channel from 0 to 1.
std::vector<double> painted_values(const scene::PaintedValue& painted, const ClothState& state,
                                   const std::string& source)
{
    std::vector<double> values;
    for (size_t v = 0; v < state.rest.colours.size(); ++v) {
        const double colour = state.rest.colours[v][int(painted.channel)];
        if (!(colour >= 0.0 && colour <= 1.0))
            throw InvalidInput(source + ": vertex " + std::to_string(state.file_vertex(int(v))) + " has " +
                               scene_format::word_of(painted.channel) + " " + short_text(colour) +
                               "; colours go from 0 to 1");
        values.push_back(painted.from + colour * (painted.to - painted.from));
    }
    return values;
}

} // namespace

void take_paint(const scene::Painted& painted, const std::string& source, ClothState& state)
{
    require_colours(state, source);
    if (painted.stiffness) {
        const std::vector<double> of_vertex = painted_values(*painted.stiffness, state, source);
        for (const Triangle& t : state.triangles)
            state.stiffness.push_back((of_vertex[t[0]] + of_vertex[t[1]] + of_vertex[t[2]]) / 3.0);
    }
    if (painted.thickness)
        state.vertex_thickness = painted_values(*painted.thickness, state, source);
}

} // namespace toile::scenes
