#include "research/benchmarks/contact_solver/cases.h"

#include <cmath>
#include <random>

#include "garment/energy/membrane.h"
#include "research/benchmarks/bar.h"
#include "volume/energy/elastic_solid.h"

namespace toile::research::contact_solver {

namespace {

constexpr double kThickness = 0.002; // [m] kept between cloths, and to the floor
constexpr double kFriction = 0.5;
constexpr double kArealDensity = 0.2; // [kg/m^2]
constexpr garment::Membrane::Settings kMembrane{1000.0, 1000.0, 400.0};

constexpr int kStacked = 5;
constexpr int kSpikeSpacing = 8;      // vertices between contact points
constexpr double kSpikeHeight = 0.02; // [m] so steep that only the tips touch

const Vec3 kBar(0.3, 0.1, 0.1);     // [m]
constexpr double kDensity = 1000.0; // [kg/m^3]
constexpr volume::ElasticMaterial kRubber{1e6, 0.3};

int bodies_of(Kind kind)
{
    switch (kind) {
    case Kind::Floor:
        return 1;
    case Kind::Disjoint:
    case Kind::Bars:
        return 2;
    case Kind::Stack:
    case Kind::Sticking:
        break;
    }
    return kStacked;
}

} // namespace

Case::Case(Kind kind, int vertices, double stiffness)
    : floor_(collision::PlaneShape{}, Eigen::Isometry3d::Identity(), "floor")
{
    if (kind == Kind::Bars)
        make_bars(vertices);
    else
        make_sheets(kind, vertices);
    fixed_.assign(x_.size(), 0);
    make_system();
    press(kind, stiffness);
}

/// Makes irregular sheets above each other, and their pressed positions.
void Case::make_sheets(Kind kind, int vertices)
{
    const int count = bodies_of(kind);
    const int side = int(std::lround(std::sqrt(vertices / count)));
    const double cell = 1.0 / (side - 1);
    std::mt19937 random(7);
    std::uniform_real_distribution<double> shake(-0.25, 0.25), depth(0.0005, 0.0015);
    for (int sheet = 0; sheet < count; ++sheet) {
        const int first = int(x_.size());
        const Vec2 shift = Vec2(shake(random), shake(random)) * 2.0 * cell;
        for (int row = 0; row < side; ++row)
            for (int column = 0; column < side; ++column) {
                const Vec2 at = cell * (Vec2(column, row) + Vec2(shake(random), shake(random)));
                const bool spikes = kind == Kind::Disjoint && sheet == 1;
                const bool is_spike = column % kSpikeSpacing == 4 && row % kSpikeSpacing == 4;
                const double raised = spikes && !is_spike ? kSpikeHeight : 0.0;
                // Sheets are 1.5 thicknesses apart; the lowest rests on the floor or is fixed.
                const double height = 1.5 * kThickness * sheet + raised;
                const double pressed = kind == Kind::Floor ? -depth(random)
                                       : sheet == 0        ? 0.0
                                                    : height - 0.5 * kThickness * sheet - depth(random);
                rest_.emplace_back(at.x() + 2.0 * sheet, at.y(), 0.0);
                x_.emplace_back(at.x() + shift.x(), height + kThickness, at.y() + shift.y());
                pressed_.emplace_back(x_.back().x(), pressed + kThickness, x_.back().z());
            }
        for (int row = 0; row + 1 < side; ++row)
            for (int column = 0; column + 1 < side; ++column) {
                const int a = first + row * side + column, b = a + 1, c = a + side, d = c + 1;
                const bool is_rising = random() % 2 == 0;
                triangles_.emplace_back(a, b, is_rising ? d : c);
                triangles_.push_back(is_rising ? Triangle(a, d, c) : Triangle(b, d, c));
            }
    }
    surface_count_ = int(x_.size());
}

/// Makes two regular bars, the upper one shifted by parts of a cell, and its pressed position.
void Case::make_bars(int vertices)
{
    // 3c x c x c cells have about 3 (c + 1/2)^3 vertices.
    const int across = std::max(2, int(std::lround(std::cbrt(vertices / 6.0) - 0.5)));
    const volume::TetMesh bar = bar_of_tets(kBar, {3 * across, across, across});
    const std::vector<Triangle> surface = volume::boundary_triangles(bar.tets);
    std::vector<char> is_inside(bar.positions.size(), 1);
    for (const Triangle& t : surface)
        for (const int v : t)
            is_inside[v] = 0;

    // Number the surfaces of both bars, then what is inside.
    std::mt19937 random(7);
    std::uniform_real_distribution<double> depth(0.0005, 0.0015);
    const double cell = kBar.y() / across;
    std::array<std::vector<int>, 2> number{std::vector<int>(bar.positions.size()),
                                           std::vector<int>(bar.positions.size())};
    for (const char inside : {0, 1}) {
        for (int upper = 0; upper < 2; ++upper)
            for (int v = 0; v < bar.vertex_count(); ++v) {
                if (is_inside[v] != inside)
                    continue;
                const Vec3& p = bar.positions[v];
                number[upper][v] = int(x_.size());
                rest_.push_back(p + upper * Vec3(0.0, 2.0 * kBar.y(), 0.0));
                x_.push_back(p + upper * Vec3(0.3 * cell, kBar.y() + 1.5 * kThickness, 0.4 * cell));
                pressed_.push_back(x_.back() - upper * Vec3(0.0, 0.5 * kThickness + depth(random), 0.0));
            }
        if (!inside)
            surface_count_ = int(x_.size());
    }
    for (const std::vector<int>& of_bar : number) {
        for (const Triangle& t : surface)
            triangles_.emplace_back(of_bar[t[0]], of_bar[t[1]], of_bar[t[2]]);
        for (const volume::Tet& t : bar.tets)
            tets_.push_back({of_bar[t[0]], of_bar[t[1]], of_bar[t[2]], of_bar[t[3]]});
    }
}

/// @param masses  out [kg]
std::shared_ptr<Energy> Case::make_energy(std::vector<double>& masses) const
{
    if (!tets_.empty()) {
        const auto rest = std::make_shared<const volume::RestTets>(volume::rest_tets({rest_, tets_}, "bars"));
        masses = rest->vertex_volumes();
        for (double& mass : masses)
            mass *= kDensity;
        return std::make_shared<volume::ElasticSolid>(
            rest, std::vector<volume::Lame>(tets_.size(), kRubber.lame("bars")));
    }
    std::vector<Vec2> uv;
    for (const Vec3& p : rest_)
        uv.emplace_back(p.x(), p.y());
    const auto rest =
        std::make_shared<const garment::RestShape>(garment::rest_shape_of_pattern(uv, triangles_, "sheets"));
    masses = rest->vertex_areas();
    for (double& mass : masses)
        mass *= kArealDensity;
    return std::make_shared<garment::Membrane>(rest, kMembrane, "sheets");
}

void Case::make_system()
{
    std::vector<double> masses;
    std::vector<std::shared_ptr<Energy>> energies{make_energy(masses)};
    system_ = std::make_unique<System>(std::move(masses), std::move(energies));
    system_->prepare(kDt, fixed_);
}

/// Finds the contacts of the motion from x_ to pressed_ and freezes them at pressed_.
void Case::press(Kind kind, double stiffness)
{
    const int count = bodies_of(kind);
    const double friction = kind == Kind::Sticking ? kFriction : 0.0;
    collision::ContactCloth cloth;
    cloth.vertex_count = surface_count_ / count;
    cloth.gap = kThickness;
    cloth.thickness = kThickness;
    cloth.collider_friction = {0.0};
    cloth.cloth_friction.assign(count, friction);
    collision::Contact::Settings settings;
    settings.stiffness = stiffness;
    settings.cloth_with_cloth = kind != Kind::Floor;
    std::vector<collision::ContactCollider> colliders;
    if (kind == Kind::Floor)
        colliders.push_back({nullptr, &floor_});
    contact_ = std::make_unique<collision::Contact>(
        triangles_, View<const Vec3>(x_).subview(0, surface_count_),
        std::vector<collision::ContactCloth>(count, cloth), std::move(colliders), settings);
    surface_contact_ = std::make_unique<LeadingActiveSet>(*contact_, surface_count_, int(x_.size()));
    surface_contact_->begin_step(
        {x_, pressed_, system_->diagonal(), system_->fixed(), system_->masses(), kDt});

    // Friction is limited by the normal forces of the last query.
    std::vector<Vec3> positions = pressed_;
    if (friction > 0.0)
        surface_contact_->revise(positions, MinimiserProgress::kConverged);
    surface_contact_->activate(pressed_);
    std::vector<FrozenTerm> terms;
    surface_contact_->append_terms(terms);
    term_count_ = int(terms.size());
    g_.assign(x_.size(), Vec3::Zero());
    surface_contact_->add_gradient(pressed_, g_);
}

} // namespace toile::research::contact_solver
