#include "tests/garment/sheets.h"

#include <random>

#include "core/linear/field.h"

namespace toile::test {

using namespace garment;

std::shared_ptr<const RestShape> Sheet::rest() const
{
    return std::make_shared<const RestShape>(rest_shape_of_pattern(uv, triangles, "sheet"));
}

std::vector<Vec3> Sheet::flat() const
{
    std::vector<Vec3> positions;
    for (const Vec2& p : uv)
        positions.emplace_back(p.x(), 0.0, p.y());
    return positions;
}

Sheet make_sheet(const Vec2& size, int columns, int rows, Pattern pattern)
{
    std::mt19937 random(7);
    std::uniform_real_distribution<double> jitter(-0.3, 0.3);
    Sheet sheet;
    sheet.columns = columns;
    sheet.rows = rows;
    const Vec2 cell(size.x() / columns, size.y() / rows);
    for (int r = 0; r <= rows; ++r)
        for (int c = 0; c <= columns; ++c) {
            Vec2 node(c, r);
            if (pattern == Pattern::Irregular) {
                // The first two columns stay, so that a clamp is the same straight line in every pattern.
                if (c > 1 && c < columns)
                    node.x() += jitter(random);
                if (r > 0 && r < rows)
                    node.y() += jitter(random);
            }
            sheet.uv.push_back(node.cwiseProduct(cell));
        }
    for (int r = 0; r < rows; ++r)
        for (int c = 0; c < columns; ++c) {
            const int a = sheet.at(c, r), b = sheet.at(c + 1, r), d = sheet.at(c, r + 1),
                      e = sheet.at(c + 1, r + 1);
            const bool flipped =
                pattern == Pattern::FlippedDiagonal || (pattern == Pattern::Irregular && random() % 2 == 0);
            if (flipped)
                sheet.triangles.insert(sheet.triangles.end(), {Triangle(a, b, d), Triangle(b, e, d)});
            else
                sheet.triangles.insert(sheet.triangles.end(), {Triangle(a, b, e), Triangle(a, e, d)});
        }
    return sheet;
}

std::vector<double> masses_of(const RestShape& rest, double areal_density)
{
    std::vector<double> masses = rest.vertex_areas();
    for (double& mass : masses)
        mass *= areal_density;
    return masses;
}

bool run_to_rest(Body& body, double dt, const std::vector<unsigned char>& fixed, double speed, int max_steps)
{
    const std::vector<Vec3> gravity(body.positions().size(), Vec3(0.0, -9.81, 0.0));
    for (int step = 0; step < max_steps; ++step) {
        const std::vector<Vec3> targets(body.positions().begin(), body.positions().end());
        if (body.step(dt, gravity, fixed, targets, nullptr, nullptr).status == StepReport::Status::NonFinite)
            return false;
        if (max_norm(body.velocities()) < speed)
            return true;
    }
    return false;
}

} // namespace toile::test
