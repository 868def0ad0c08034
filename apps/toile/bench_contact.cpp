#include <algorithm>
#include <iostream>

#include "apps/toile/bench.h"
#include "apps/toile/bench_tables.h"
#include "apps/toile/command_line.h"
#include "apps/toile/interrupt.h"
#include "apps/toile/progress.h"
#include "benchmarks/contact/table.h"
#include "core/backend/error.h"
#include "scenes/format/read_scene.h"

namespace toile {

namespace {

/// A group that did not run leaves the table of an earlier run as it is.
const std::vector<std::string> kTables{"contact_stress.csv", "contact_scaling.csv", "contact_exponents.csv",
                                       "contact_dressed.csv", "contact_tables.md"};

/// Frames after the first of a dressed scene.
constexpr int kDressedFrames = 60, kQuickDressedFrames = 6;

/// What progress counts for a dressed scene, times its frames: about as long as that many vertices for a
/// step.
constexpr int kDressedWork = 100000;

/// Vertices and steps that progress counts as one.
constexpr double kWorkUnit = 1000.0;

/// What was asked for.
struct Plan {
    std::vector<contact::StressCase> stress;
    std::vector<contact::ScalingCase> scaling;
    std::vector<std::filesystem::path> dressed;
};

std::string name_of(const std::filesystem::path& scene) { return "dressed " + scene.stem().string(); }

Plan choose(const BenchOptions& options)
{
    const contact::Size size = options.quick ? contact::Size::Quick : contact::Size::Full;
    Plan plan{contact::stress_cases(size), contact::scaling_cases(size), contact::dressed_scenes()};
    if (options.quick)
        plan.dressed.resize(1);
    const auto is_other = [&](const std::string& name) {
        return name.find(options.only) == std::string::npos;
    };
    std::erase_if(plan.stress, [&](const contact::StressCase& trial) { return is_other(trial.name); });
    std::erase_if(plan.scaling, [&](const contact::ScalingCase& trial) { return is_other(trial.name); });
    std::erase_if(plan.dressed, [&](const std::filesystem::path& scene) { return is_other(name_of(scene)); });
    if (plan.stress.empty() && plan.scaling.empty() && plan.dressed.empty())
        throw InvalidInput("--only: no case of contact has \"" + options.only +
                           "\" in its name; names begin with stress, scaling or dressed, see "
                           "docs/benchmarks/contact.md");
    return plan;
}

/// The scenes of the plan that are here with all their files; the others are named on stderr.
std::vector<Scene> load(const std::vector<std::filesystem::path>& files, int frames)
{
    std::vector<Scene> scenes;
    for (const std::filesystem::path& file : files) {
        try {
            scenes.push_back(read_scene(file));
            scenes.back().frames = 1 + frames;
        } catch (const InvalidInput& error) {
            std::cerr << "SKIPPED: " << error.what() << std::endl;
        }
    }
    return scenes;
}

std::vector<TableFile> files(const contact::Results& results, const std::string& tables)
{
    std::vector<TableFile> files;
    if (!results.stress.empty())
        files.push_back({kTables[0], csv_of_stress(results.stress)});
    if (!results.scaling.empty()) {
        files.push_back({kTables[1], csv_of_scaling(results.scaling)});
        files.push_back({kTables[2], csv_of_exponents(results.scaling)});
    }
    if (!results.dressed.empty())
        files.push_back({kTables[3], csv_of_dressed(results.dressed)});
    files.push_back({kTables[4], tables});
    return files;
}

/// Runs a plan with one progress for all of it.
class Runner {
public:
    Runner(const Plan& plan, std::vector<Scene> scenes, const BenchOptions& options)
        : plan_(plan), scenes_(std::move(scenes)), options_(options),
          progress_("thousand vertex steps", int(total_work() / kWorkUnit), options.quiet)
    {
    }

    /// False when interrupted.
    bool run(contact::Results& results)
    {
        return run_stress(results.stress) && run_scaling(results.scaling) && run_dressed(results.dressed);
    }

private:
    double total_work() const
    {
        double total = 0.0;
        for (const contact::StressCase& trial : plan_.stress)
            total += double(trial.seeds) * trial.steps() * trial.vertices();
        for (const contact::ScalingCase& trial : plan_.scaling)
            total += double(trial.warm_up + trial.steps) * trial.vertices;
        for (const Scene& scene : scenes_)
            total += double(scene.frames - 1) * kDressedWork;
        return total;
    }

    /// Called after every step or frame. @return false to break off
    std::function<bool(int)> follow(double work_per_step, const std::string& name)
    {
        return [this, work_per_step, name, before = done_](int step) {
            done_ = before + step * work_per_step;
            progress_.update(int(done_ / kWorkUnit), name);
            return !interrupt_.requested();
        };
    }

    bool run_stress(std::vector<contact::StressResult>& results)
    {
        for (const contact::StressCase& trial : plan_.stress) {
            std::vector<contact::StressRun> runs;
            for (int seed = 1; seed <= trial.seeds; ++seed) {
                const Scene scene = contact::stress_scene(trial, unsigned(seed), options_.threads);
                runs.push_back(
                    contact::run(trial, unsigned(seed), scene, follow(trial.vertices(), trial.name)));
                if (interrupt_.requested())
                    return false;
            }
            results.push_back(contact::summarise(trial, std::move(runs)));
        }
        return true;
    }

    bool run_scaling(std::vector<contact::ScalingResult>& results)
    {
        for (const contact::ScalingCase& trial : plan_.scaling) {
            contact::ScalingResult result =
                contact::run(trial, options_.threads, follow(trial.vertices, trial.name));
            if (interrupt_.requested())
                return false;
            results.push_back(std::move(result));
        }
        return true;
    }

    bool run_dressed(std::vector<contact::DressedResult>& results)
    {
        for (const Scene& scene : scenes_) {
            contact::DressedResult result =
                contact::run(scene, options_.threads, follow(kDressedWork, scene.name));
            if (interrupt_.requested())
                return false;
            results.push_back(std::move(result));
        }
        return true;
    }

    const Plan& plan_;
    std::vector<Scene> scenes_;
    const BenchOptions& options_;
    Progress progress_;
    InterruptGuard interrupt_;
    double done_ = 0.0;
};

} // namespace

int bench_contact(const BenchOptions& options)
{
    if (!options.output.empty())
        require_place(options.output, kTables);
    const Plan plan = choose(options);
    contact::Results results;
    const bool is_complete =
        Runner(plan, load(plan.dressed, options.quick ? kQuickDressedFrames : kDressedFrames), options)
            .run(results);
    const std::string tables = markdown_tables(results);
    std::cout << tables;
    if (!is_complete) {
        std::cerr << "toile: error: interrupted; cases that were finished are printed, nothing was written"
                  << std::endl;
        return kExitFailure;
    }
    write_tables(options.output, files(results, tables));
    return std::all_of(results.stress.begin(), results.stress.end(),
                       [](const contact::StressResult& result) { return result.worst.holds; })
               ? kExitOk
               : kExitFailure;
}

} // namespace toile
