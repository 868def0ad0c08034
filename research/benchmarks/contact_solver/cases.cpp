#include "research/benchmarks/contact_solver/cases.h"

#include <cmath>
#include <random>

#include "garment/energy/membrane.h"

namespace toile::research::contact_solver {

namespace {

constexpr double kThickness = 0.002; // [m] kept between cloths, and to the floor
constexpr double kFriction = 0.5;
constexpr double kArealDensity = 0.2; // [kg/m^2]
constexpr garment::Membrane::Settings kMembrane{1000.0, 1000.0, 400.0};

constexpr int kStacked = 5;
constexpr int kSpikeSpacing = 8;      // vertices between contact points
constexpr double kSpikeHeight = 0.02; // [m] so steep that only the tips touch

int sheets_of(Kind kind)
{
    switch (kind) {
    case Kind::Floor:
        return 1;
    case Kind::Disjoint:
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
    make_sheets(kind, vertices);
    make_system();
    press(kind, stiffness);
}

/// Makes irregular sheets above each other, and their pressed positions.
void Case::make_sheets(Kind kind, int vertices)
{
    const int count = sheets_of(kind);
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
                uv_.push_back(at + Vec2(2.0 * sheet, 0.0));
                x_.emplace_back(at.x() + shift.x(), height + kThickness, at.y() + shift.y());
                pressed_.emplace_back(x_.back().x(), pressed + kThickness, x_.back().z());
                sheet_of_.push_back(sheet);
            }
        for (int row = 0; row + 1 < side; ++row)
            for (int column = 0; column + 1 < side; ++column) {
                const int a = first + row * side + column, b = a + 1, c = a + side, d = c + 1;
                const bool is_rising = random() % 2 == 0;
                triangles_.emplace_back(a, b, is_rising ? d : c);
                triangles_.push_back(is_rising ? Triangle(a, d, c) : Triangle(b, d, c));
            }
    }
    fixed_.assign(x_.size(), 0);
}

void Case::make_system()
{
    const auto rest =
        std::make_shared<const garment::RestShape>(garment::rest_shape_of_pattern(uv_, triangles_, "sheets"));
    std::vector<double> masses = rest->vertex_areas();
    for (double& mass : masses)
        mass *= kArealDensity;
    std::vector<std::shared_ptr<Energy>> energies{
        std::make_shared<garment::Membrane>(rest, kMembrane, "sheets")};
    system_ = std::make_unique<System>(std::move(masses), std::move(energies));
    system_->prepare(kDt, fixed_);
}

/// Finds the contacts of the motion from x_ to pressed_ and freezes them at pressed_.
void Case::press(Kind kind, double stiffness)
{
    const int count = sheets_of(kind);
    const double friction = kind == Kind::Sticking ? kFriction : 0.0;
    collision::ContactCloth cloth;
    cloth.vertex_count = int(x_.size()) / count;
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
        triangles_, x_, std::vector<collision::ContactCloth>(count, cloth), std::move(colliders), settings);
    contact_->begin_step({x_, pressed_, system_->diagonal(), system_->fixed(), system_->masses(), kDt});

    // Friction is limited by the normal forces of the last query.
    std::vector<Vec3> positions = pressed_;
    if (friction > 0.0)
        contact_->revise(positions, MinimiserProgress::kConverged);
    contact_->activate(pressed_);
    std::vector<FrozenTerm> terms;
    contact_->append_terms(terms);
    term_count_ = int(terms.size());
    g_.assign(x_.size(), Vec3::Zero());
    contact_->add_gradient(pressed_, g_);
}

} // namespace toile::research::contact_solver
