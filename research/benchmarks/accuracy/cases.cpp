#include "research/benchmarks/accuracy/cases.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include "core/mesh/obj.h"
#include "research/benchmarks/accuracy/exact.h"
#include "research/benchmarks/accuracy/scene_text.h"
#include "research/benchmarks/accuracy/statistics.h"
#include "research/benchmarks/accuracy/support_mesh.h"

namespace toile::research::accuracy {

namespace {

// --- bending and hanging ------------------------------------------------------------------------------

/// A strip whose first two columns of vertices are fixed. The clamp line runs through the middle of the first
/// cell: the angle is zero there to second order.
Case elastica(double load)
{
    const double free_length = 0.09, density = 0.1, cell = free_length / 39.5, length = 40.0 * cell;
    const double rigidity = density * kGravity * free_length * free_length * free_length / load;
    Case result;
    result.name = "heavy elastica, G = " + number(load);
    result.quantity = "drop over reach [-]";
    result.scene =
        scene_of(result.name,
                 R"("frames": 91, "air": {"density": 0}, "contact": {"self": false},
        "cloths": [{"name": "strip", "rectangle": {"size": [)" +
                     number(length) + R"(, 0.009], "resolution": )" + number(cell) + R"(}, "fabric": "f",
            "translate": [)" +
                     number(0.5 * length) + R"(, 0, 0]}],
        "attachments": [{"cloth": "strip", "select": {"box": {"lower": [-1, -1, -1], "upper": [)" +
                     number(1.5 * cell) + ", 1, 1]}}}], " + lossless_fabric(density, 2000.0, rigidity, 6.0));
    result.measure = [=](const Trajectory& run, const Trajectory*) {
        Vec3 tip = Vec3::Zero();
        int count = 0;
        for (size_t i = 0; i < run.last().size(); ++i)
            if (run.positions.front()[i].x() > length - 0.5 * cell) {
                tip += run.last()[i];
                ++count;
            }
        tip /= count;
        return -tip.y() / (tip.x() - 0.5 * cell);
    };
    result.right = heavy_elastica(load);
    result.is_relative = true;
    result.aim = 0.02;
    return result;
}

Case catenary()
{
    Case result;
    result.name = "catenary, d/L = 0.9";
    result.quantity = "sag over length [-]";
    result.scene = scene_of(result.name, R"("frames": 241, "contact": {"self": false},
        "cloths": [{"name": "sheet", "rectangle": {"size": [1, 0.2], "resolution": 0.02}, "fabric": "f"}],
        "fabrics": {"f": {"areal_density": 0.2, "stretch": {"warp": 5000, "weft": 5000}, "shear": 1000,
            "bend": {"warp": 1e-8, "weft": 1e-8}, "strain_limit": 9, "damping": 3}},
        "attachments": [
            {"cloth": "sheet", "select": {"box": {"lower": [-0.501, -1, -1], "upper": [-0.499, 1, 1]}},
             "keyframes": [{"time": 0}, {"time": 1, "translate": [0.05, 0, 0]}]},
            {"cloth": "sheet", "select": {"box": {"lower": [0.499, -1, -1], "upper": [0.501, 1, 1]}},
             "keyframes": [{"time": 0}, {"time": 1, "translate": [-0.05, 0, 0]}]}])");
    result.measure = [](const Trajectory& run, const Trajectory*) {
        double lowest = 0.0;
        for (const Vec3& p : run.last())
            lowest = std::min(lowest, p.y());
        return -lowest;
    };
    result.right = catenary_sag(0.9);
    result.is_relative = true;
    result.aim = 0.005;
    return result;
}

/// A strip of four cells across that is clamped like the elastica's, edge-on in gravity that is tilted a
/// little out of its plane: near the load that buckles it sideways, the tilt is amplified by what bends and
/// twists it.
Case lateral_buckling(double load)
{
    const double free_length = 0.3, width = 0.015, density = 0.1, tilt = 0.02;
    const double cell = width / 4.0, length = free_length + 0.5 * cell;
    // Per width, a strip has the lateral stiffness D and the torsional one 2 D.
    const double rigidity =
        density * kGravity * free_length * free_length * free_length / (std::sqrt(2.0) * load);
    Case result;
    result.name = "strip clamped edge-on, g = " + number(load);
    result.quantity = "twist of the tip over the tilt of gravity [-]";
    result.scene =
        scene_of(result.name,
                 R"("frames": 241, "gravity": [0, )" + number(-tilt * kGravity) + ", " + number(-kGravity) +
                     R"(], "air": {"density": 0}, "contact": {"self": false},
        "cloths": [{"name": "strip", "rectangle": {"size": [)" +
                     number(length) + ", " + number(width) + R"(], "resolution": )" + number(cell) +
                     R"(}, "fabric": "f", "translate": [)" + number(0.5 * length) + R"(, 0, 0]}],
        "attachments": [{"cloth": "strip", "select": {"box": {"lower": [-1, -1, -1], "upper": [)" +
                     number(1.5 * cell) + ", 1, 1]}}}], " + lossless_fabric(density, 1e5, rigidity, 5.0));
    result.measure = [=](const Trajectory& run, const Trajectory*) {
        Vec3 upper = Vec3::Zero(), lower = Vec3::Zero();
        for (size_t i = 0; i < run.last().size(); ++i) {
            const Vec3& start = run.positions.front()[i];
            if (start.x() > length - 0.5 * cell && std::abs(start.z()) > 0.49 * width)
                (start.z() > 0.0 ? upper : lower) = run.last()[i];
        }
        return (upper - lower).y() / width / tilt;
    };
    result.right = lateral_twist(load, width / free_length);
    result.is_relative = true;
    result.aim = 0.05;
    return result;
}

/// A strip of four cells across that is clamped like the elastica's. Soft springs pull the other end towards
/// a twisted line.
Case torsion()
{
    const double width = 0.04, cell = width / 4.0, free_length = 0.4, length = free_length + 0.5 * cell;
    const double rigidity = 1e-4, twist = 0.1, spring = 0.01; // [N m], [-] of the targets, [N/m] of a vertex
    std::string springs;
    double stiffness = 0.0; // of the springs [N m]
    for (int k = -2; k <= 2; ++k) {
        const double z = k * cell;
        stiffness += spring * z * z;
        springs += R"(, {"cloth": "strip", "select": {"nearest": [)" +
                   ("[" + number(length) + ", 0, " + number(z)) + R"(]]}, "stiffness": )" + number(spring) +
                   R"(, "keyframes": [{"time": 0}, {"time": 0.5, "translate": [0, )" + number(twist * z) +
                   ", 0]}]}";
    }
    Case result;
    result.name = "torsion of a strip";
    result.quantity = "torsional stiffness over the exact one [-]";
    result.scene = scene_of(result.name, R"("frames": 241, "gravity": [0, 0, 0], "air": {"density": 0},
        "contact": {"self": false}, "cloths": [{"name": "strip", "rectangle": {"size": [)" +
                                             number(length) + ", " + number(width) + R"(], "resolution": )" +
                                             number(cell) + R"(}, "fabric": "f", "translate": [)" +
                                             number(0.5 * length) + R"(, 0, 0]}],
        "attachments": [{"cloth": "strip", "select": {"box": {"lower": [-1, -1, -1], "upper": [)" +
                                             number(1.5 * cell) + ", 1, 1]}}}" + springs + "], " +
                                             lossless_fabric(0.1, 1000.0, rigidity, 5.0));
    result.measure = [=](const Trajectory& run, const Trajectory*) {
        double tip = 0.0, squares = 0.0;
        for (size_t i = 0; i < run.last().size(); ++i)
            if (const Vec3& start = run.positions.front()[i]; start.x() > length - 0.5 * cell) {
                tip += start.z() * run.last()[i].y();
                squares += start.z() * start.z();
            }
        tip /= squares;
        // The clamp keeps the strip from warping near it, over width / sqrt(24).
        const double exact = 2.0 * rigidity * width / (free_length - width / std::sqrt(24.0));
        return stiffness * (twist - tip) / tip / exact;
    };
    result.right = 1.0;
    result.is_relative = true;
    result.aim = 0.03;
    return result;
}

/// Drape of a disc of 15 cm on a support of 9 cm: the share of the overhanging ring that its shadow covers.
Case drape(double resolution, const std::filesystem::path& support)
{
    Case result;
    result.name = "drape, cotton, " + number(1e3 * resolution) + " mm";
    result.quantity = "drape coefficient [-]";
    result.scene = scene_of(result.name, R"("frames": 121,
        "avatars": [{"name": "support", "file": ")" +
                                             support.string() + R"(", "friction": 0.5}],
        "cloths": [{"name": "disc", "disc": {"radius": 0.15, "resolution": )" +
                                             number(resolution) + R"(}, "translate": [0, 0.002, 0]}])");
    result.reference = converged(result.scene, 2);
    result.measure = [](const Trajectory& run, const Trajectory*) {
        // The shadow is bounded by the disc's border.
        const std::vector<Vec3>& start = run.positions.front();
        std::vector<std::pair<double, int>> border;
        for (int i = 0; i < int(start.size()); ++i)
            if (std::hypot(start[i].x(), start[i].z()) > 0.15 - 1e-6)
                border.emplace_back(std::atan2(start[i].z(), start[i].x()), i);
        std::sort(border.begin(), border.end());
        double twice_area = 0.0;
        for (size_t k = 0; k < border.size(); ++k) {
            const Vec3 &p = run.last()[border[k].second],
                       &q = run.last()[border[(k + 1) % border.size()].second];
            twice_area += p.x() * q.z() - q.x() * p.z();
        }
        const double support = std::numbers::pi * 0.09 * 0.09, disc = std::numbers::pi * 0.15 * 0.15;
        return (0.5 * twice_area - support) / (disc - support);
    };
    result.is_measured = true;
    result.aim = 0.03;
    return result;
}

// --- friction -------------------------------------------------------------------------------------------

/// A sheet on a plane in tilted gravity, with the tangent of the tilt over the coefficient of friction.
Case incline(double slope)
{
    const double friction = 0.3, tilt = std::atan(slope * friction);
    Case result;
    result.name = "incline, tan a = " + number(slope) + " mu";
    result.scene = scene_of(
        result.name, R"("frames": 46, "air": {"density": 0}, "gravity": [)" +
                         number(kGravity * std::sin(tilt)) + ", " + number(-kGravity * std::cos(tilt)) +
                         R"(, 0], "avatars": [{"name": "floor", "plane": {}, "friction": 0.3}],
        "cloths": [{"name": "sheet", "rectangle": {"size": [0.3, 0.3], "resolution": 0.02},
            "translate": [0, 0.0012, 0]}])");
    if (slope < 1.0) {
        result.quantity = "slip within 1.5 s [mm]";
        result.measure = [](const Trajectory& run, const Trajectory*) {
            return 1e3 * (mean(run.last()) - mean(run.positions.front())).x();
        };
        result.aim = 1.0;
        return result;
    }
    result.quantity = "acceleration [m/s^2]";
    result.measure = [](const Trajectory& run, const Trajectory*) {
        const int from = 15, to = int(run.positions.size()) - 1;
        return (mean(run.velocities(to)) - mean(run.velocities(from))).x() /
               ((to - from) * run.frame_duration);
    };
    result.right = kGravity * (std::sin(tilt) - friction * std::cos(tilt));
    result.is_relative = true;
    result.aim = 0.03;
    return result;
}

/// A strip over a horizontal cylinder with unequal ends, held by friction below the capstan's threshold.
Case capstan()
{
    const double radius = 0.03, gap = 0.00115, friction = 0.3, light = 0.08;
    const double arc = std::numbers::pi * (radius + gap);
    const double heavy = light * 0.85 * std::exp(friction * std::numbers::pi);
    const double length = light + arc + heavy;
    Case result;
    result.name = "capstan, half a turn at 0.85 of the threshold";
    result.quantity = "slip within 2 s [mm]";
    result.scene =
        scene_of(result.name,
                 R"("frames": 61, "air": {"density": 0},
        "avatars": [{"name": "post", "capsule": {"radius": 0.03, "length": 0.4}, "rotate_deg": [90, 0, 0],
            "friction": 0.3}],
        "cloths": [{"name": "strip", "rectangle": {"size": [)" +
                     number(length) +
                     R"(, 0.03], "resolution": 0.005}, "translate": [0, 0.2, 0], "fabric": "silk"}])");
    result.place = [=](View<const Vec3> flat) {
        std::vector<Vec3> x;
        double first = flat[0].x();
        for (const Vec3& p : flat)
            first = std::min(first, p.x());
        const double r = radius + gap;
        for (const Vec3& p : flat) {
            const double s = p.x() - first - light, angle = s / r;
            if (s < 0.0)
                x.emplace_back(-r, s, p.z());
            else if (s > arc)
                x.emplace_back(r, arc - s, p.z());
            else
                x.emplace_back(-r * std::cos(angle), r * std::sin(angle), p.z());
        }
        return x;
    };
    result.measure = [](const Trajectory& run, const Trajectory*) {
        // The light end rises as the heavy one falls.
        const std::vector<Vec3>&start = run.positions.front(), &end = run.last();
        double before = 0.0, after = 0.0;
        for (size_t i = 0; i < start.size(); ++i)
            if (start[i].x() < 0.0) {
                before = std::min(before, start[i].y());
                after = std::min(after, end[i].x() < 0.0 ? end[i].y() : 0.0);
            }
        return 1e3 * (after - before);
    };
    result.aim = 2.0;
    return result;
}

// --- motion -----------------------------------------------------------------------------------------------

Case fall(double time, double aim)
{
    Case result;
    result.name = "sheet held at one edge, " + number(time) + " s";
    result.quantity = "RMS distance to the converged fall [mm]";
    result.scene = scene_of(result.name, R"("frames": )" + std::to_string(1 + int(std::lround(30.0 * time))) +
                                             R"(, "air": {"density": 0}, "contact": {"self": false},
        "cloths": [{"name": "sheet", "rectangle": {"size": [0.4, 0.2], "resolution": 0.01},
            "translate": [0.2, 0, 0], "fabric": "f"}],
        "attachments": [{"cloth": "sheet", "select": {"box": {"lower": [-0.001, -1, -1],
            "upper": [0.001, 1, 1]}}}], )" + lossless_fabric(0.2, 1000.0, 5e-6));
    result.reference = converged(result.scene, 16);
    result.measure = [](const Trajectory& run, const Trajectory* reference) {
        return 1e3 * rms(run.last(), reference->last());
    };
    result.aim = aim;
    return result;
}

/// A stiff strip that swings from horizontal. Its energy is that of the highest swing back.
Case swing()
{
    Case result;
    result.name = "lossless strip that swings for 5 s";
    result.quantity = "energy left [%]";
    result.scene = scene_of(result.name, R"("fps": 60, "frames": 301, "solver": {"substeps": 2},
        "air": {"density": 0}, "contact": {"self": false},
        "cloths": [{"name": "strip", "rectangle": {"size": [0.4, 0.2], "resolution": 0.04},
            "translate": [0.2, 0, 0], "fabric": "f"}],
        "attachments": [{"cloth": "strip", "select": {"box": {"lower": [-0.001, -1, -1],
            "upper": [0.001, 1, 1]}}}], )" + lossless_fabric(0.2, 1000.0, 0.02));
    result.measure = [](const Trajectory& run, const Trajectory*) {
        double lowest = 0.0, highest = -1.0;
        for (size_t frame = 0; frame < run.positions.size(); ++frame) {
            const double height = mean(run.positions[frame]).y();
            lowest = std::min(lowest, height);
            if (double(frame) * run.frame_duration > 4.0)
                highest = std::max(highest, height);
        }
        return 100.0 * (highest - lowest) / -lowest;
    };
    result.right = 100.0;
    result.aim = 10.0;
    return result;
}

Case spin()
{
    Case result;
    result.name = "free sheet that spins for 1.9 s";
    result.quantity = "angular momentum left [%]";
    result.scene = scene_of(result.name, R"("frames": 76, "gravity": [0, 0, 0], "air": {"density": 0},
        "contact": {"self": false},
        "cloths": [{"name": "sheet", "rectangle": {"size": [0.4, 0.4], "resolution": 0.02}, "fabric": "f"}],
        "attachments": [{"cloth": "sheet", "select": {"box": {"lower": [-1, -1, -1], "upper": [1, 1, 1]}},
            "release": 0.5, "keyframes": [{"time": 0}, {"time": 1, "rotate_deg": [0, 360, 0]}]}], )" +
                                             lossless_fabric(0.15, 1000.0, 1e-5));
    result.measure = [](const Trajectory& run, const Trajectory*) {
        const auto momentum = [&](int frame) {
            const std::vector<Vec3>& x = run.positions[frame];
            const std::vector<Vec3> v = run.velocities(frame);
            const Vec3 centre = mean(x);
            Vec3 sum = Vec3::Zero();
            for (size_t i = 0; i < x.size(); ++i)
                sum += (x[i] - centre).cross(v[i]);
            return sum.norm();
        };
        return 100.0 * momentum(int(run.positions.size()) - 1) / momentum(18);
    };
    result.right = 100.0;
    result.aim = 1.0;
    return result;
}

Case rest(const std::string& name, const std::string& body)
{
    Case result;
    result.name = "cotton square dropped on a " + name;
    result.quantity = "RMS speed 2 s after landing [mm/s]";
    result.scene = scene_of(result.name, R"("frames": 70, "avatars": [{"name": "body", )" + body +
                                             R"(, "translate": [0, -0.1, 0]}, {"name": "floor", "plane": {},
            "translate": [0, -0.4, 0]}],
        "cloths": [{"name": "square", "rectangle": {"size": [0.5, 0.5], "resolution": 0.02},
            "translate": [0, 0.06, 0]}])");
    result.measure = [](const Trajectory& run, const Trajectory*) {
        return 1e3 * rms(run.velocities(int(run.positions.size()) - 1));
    };
    result.aim = 5.0;
    return result;
}

// --- garments --------------------------------------------------------------------------------------------

/// Quantile of strain over all triangles and frames but the first [%].
double strain_percent(const Trajectory& run, double share)
{
    std::vector<double> strain;
    for (size_t frame = 1; frame < run.strain.size(); ++frame)
        strain.insert(strain.end(), run.strain[frame].begin(), run.strain[frame].end());
    return 100.0 * quantile(std::move(strain), share);
}

/// Strain of a denim skirt on the built-in figure as it walks.
Case walk()
{
    Case result;
    result.name = "skirt on a walking figure";
    result.quantity = "median strain of its triangles [%]";
    result.scene = scene_of(result.name, R"("frames": 31, "settle": 0.5,
        "avatars": [{"name": "mannequin", "mannequin": {}, "clip": "walk",
            "preroll": {"ease": 0.5, "from_bind": true}}, {"name": "floor", "plane": {}}],
        "cloths": [{"name": "skirt", "skirt": {"waist_radius": 0.135, "hem_radius": 0.3, "length": 0.55,
            "resolution": 0.02}, "translate": [0, 1.08, 0], "fabric": "denim"}],
        "attachments": [{"cloth": "skirt", "to": "mannequin",
            "select": {"box": {"lower": [-0.5, 1.07, -0.5], "upper": [0.5, 1.1, 0.5]}}}])");
    result.reference = converged(result.scene, 2, 1e-3);
    result.measure = [](const Trajectory& run, const Trajectory*) { return strain_percent(run, 0.5); };
    result.is_measured = result.is_relative = true;
    result.aim = 0.1;
    return result;
}

} // namespace

// Late is the largest difference of the mean height to the converged run.
Case pile()
{
    Case result;
    result.name = "five cloths that fall on a ball";
    result.quantity = "lateness within 0.5 s [mm]";
    std::string cloths;
    for (int i = 0; i < 5; ++i)
        cloths += std::string(i > 0 ? "," : "") + R"({"name": "cloth)" + std::to_string(i) +
                  R"(", "rectangle": {"size": [0.35, 0.35], "resolution": 0.014}, "fabric": "stiff",
            "translate": [)" +
                  number(0.005 * (i % 3)) + ", " + number(0.02 * (i + 1)) + ", " + number(0.01 * (i % 2)) +
                  "]}";
    result.scene = scene_of(result.name, R"("fps": 60, "frames": 31,
        "avatars": [{"name": "ball", "sphere": {"radius": 0.1}, "translate": [0, -0.1, 0], "friction": 0.3}],
        "fabrics": {"stiff": {"base": "cotton", "stretch": {"warp": 10000, "weft": 10000}}},
        "cloths": [)" + cloths + "]");
    result.reference = converged(result.scene, 2, 1e-3);
    result.measure = [](const Trajectory& run, const Trajectory* reference) {
        double worst = 0.0;
        for (size_t frame = 0; frame < run.positions.size(); ++frame)
            worst = std::max(
                worst, std::abs(mean(run.positions[frame]).y() - mean(reference->positions[frame]).y()));
        return 1e3 * worst;
    };
    result.aim = 5.0;
    return result;
}

Case hanging_skirt(const std::string& word, double share)
{
    Case result;
    result.name = "skirt held at its waist, " + word + " of strain";
    result.quantity = "strain of its triangles [%]";
    result.scene = scene_of(result.name, R"("frames": 46,
        "cloths": [{"name": "skirt", "skirt": {"waist_radius": 0.12, "hem_radius": 0.35, "length": 0.5,
            "resolution": 0.02}, "translate": [0, 1, 0]}],
        "attachments": [{"cloth": "skirt", "select": {"box": {"lower": [-1, 0.999, -1], "upper": [1, 2, 1]}}}])");
    result.reference = converged(result.scene, 2);
    result.measure = [share](const Trajectory& run, const Trajectory*) { return strain_percent(run, share); };
    result.is_measured = result.is_relative = true;
    result.aim = 0.1;
    return result;
}

std::vector<Vec3> Trajectory::velocities(int frame) const
{
    std::vector<Vec3> v;
    for (size_t i = 0; i < positions[frame].size(); ++i)
        v.push_back((positions[frame][i] - positions[frame - 1][i]) / frame_duration);
    return v;
}

std::vector<Case> make_cases(const std::filesystem::path& folder, bool quick)
{
    std::vector<Case> cases{elastica(10.0),
                            elastica(50.0),
                            catenary(),
                            torsion(),
                            lateral_buckling(10.0),
                            incline(0.95),
                            incline(1.3),
                            capstan(),
                            fall(0.2, 2.0),
                            fall(0.3, 8.0),
                            swing(),
                            spin(),
                            rest("box", R"("box": {"size": [0.2, 0.2, 0.2]})"),
                            rest("ball", R"("sphere": {"radius": 0.1})")};
    if (quick)
        return cases;
    const std::filesystem::path support = folder / "support.obj";
    write_obj(support, support_mesh());
    for (const double resolution : {0.006, 0.01, 0.015})
        cases.push_back(drape(resolution, support));
    cases.push_back(hanging_skirt("median", 0.5));
    cases.push_back(hanging_skirt("99th percentile", 0.99));
    cases.push_back(walk());
    cases.push_back(pile());
    return cases;
}

} // namespace toile::research::accuracy
