#include <algorithm>
#include <iostream>

#include "apps/toile/terminal/command_line.h"
#include "apps/toile/terminal/interrupt.h"
#include "apps/toile/terminal/progress.h"
#include "core/base/error.h"
#include "research/bench/benchmark.h"
#include "research/bench/tables.h"
#include "research/benchmarks/contact/table.h"
#include "scenes/format/read_scene.h"

namespace toile::research {

namespace {

/// Names of the tables. A group that did not run leaves the table of an earlier run unchanged.
const std::vector<std::string> kTables{"contact_stress.csv", "contact_scaling.csv", "contact_exponents.csv",
                                       "contact_dressed.csv", "contact_tables.md"};

/// Frames after the first of a dressed scene.
constexpr int kDressedFrames = 60, kQuickDressedFrames = 6;

/// Progress units per frame of a dressed scene: a frame takes about as long as a step of this many vertices.
constexpr int kDressedWork = 100000;

/// Vertex steps per displayed unit of progress.
constexpr double kWorkUnit = 1000.0;

/// Cases selected by the options.
struct Plan {
    std::vector<contact_stress::StressCase> stress;
    std::vector<contact_stress::ScalingCase> scaling;
    std::vector<std::filesystem::path> dressed;
};

std::string name_of(const std::filesystem::path& scene) { return "dressed " + scene.stem().string(); }

Plan choose(const BenchOptions& options)
{
    const contact_stress::Size size =
        options.quick ? contact_stress::Size::Quick : contact_stress::Size::Full;
    Plan plan{contact_stress::stress_cases(size), contact_stress::scaling_cases(size),
              contact_stress::dressed_scenes()};
    if (options.quick)
        plan.dressed.resize(1);
    const auto is_other = [&](const std::string& name) {
        return name.find(options.only) == std::string::npos;
    };
    std::erase_if(plan.stress, [&](const contact_stress::StressCase& trial) { return is_other(trial.name); });
    std::erase_if(plan.scaling,
                  [&](const contact_stress::ScalingCase& trial) { return is_other(trial.name); });
    std::erase_if(plan.dressed, [&](const std::filesystem::path& scene) { return is_other(name_of(scene)); });
    if (plan.stress.empty() && plan.scaling.empty() && plan.dressed.empty())
        throw InvalidInput("--only: no case of contact has \"" + options.only +
                           "\" in its name; names begin with stress, scaling or dressed, see "
                           "docs/journal/contact_stress.md");
    return plan;
}

/// Scenes of the plan whose files exist; the others are named on stderr.
std::vector<scenes::Scene> load(const std::vector<std::filesystem::path>& files, int frames)
{
    std::vector<scenes::Scene> scenes;
    for (const std::filesystem::path& file : files) {
        try {
            scenes.push_back(scenes::read_scene(file));
            scenes.back().frames = 1 + frames;
        } catch (const InvalidInput& error) {
            std::cerr << "SKIPPED: " << error.what() << std::endl;
        }
    }
    return scenes;
}

std::vector<TableFile> files(const contact_stress::Results& results, const std::string& tables)
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

/// Runs a plan with a single progress display.
class Runner {
public:
    Runner(const Plan& plan, std::vector<scenes::Scene> scenes, const BenchOptions& options)
        : plan_(plan), scenes_(std::move(scenes)), options_(options),
          progress_("thousand vertex steps", int(total_work() / kWorkUnit), options.quiet)
    {
    }

    /// Runs all cases. False if interrupted.
    bool run(contact_stress::Results& results)
    {
        return run_stress(results.stress) && run_scaling(results.scaling) && run_dressed(results.dressed);
    }

private:
    double total_work() const
    {
        double total = 0.0;
        for (const contact_stress::StressCase& trial : plan_.stress)
            total += double(trial.seeds) * trial.steps() * trial.vertices();
        for (const contact_stress::ScalingCase& trial : plan_.scaling)
            total += double(trial.warm_up + trial.steps) * trial.vertices;
        for (const scenes::Scene& scene : scenes_)
            total += double(scene.frames - 1) * kDressedWork;
        return total;
    }

    /// Callback for every step or frame. @return false to stop
    std::function<bool(int)> follow(double work_per_step, const std::string& name)
    {
        return [this, work_per_step, name, before = done_](int step) {
            done_ = before + step * work_per_step;
            progress_.update(int(done_ / kWorkUnit), name);
            return !interrupt_.requested();
        };
    }

    bool run_stress(std::vector<contact_stress::StressResult>& results)
    {
        for (const contact_stress::StressCase& trial : plan_.stress) {
            std::vector<contact_stress::StressRun> runs;
            for (int seed = 1; seed <= trial.seeds; ++seed) {
                const scenes::Scene scene =
                    contact_stress::stress_scene(trial, unsigned(seed), options_.threads);
                runs.push_back(
                    contact_stress::run(trial, unsigned(seed), scene, follow(trial.vertices(), trial.name)));
                if (interrupt_.requested())
                    return false;
            }
            results.push_back(contact_stress::summarise(trial, std::move(runs)));
        }
        return true;
    }

    bool run_scaling(std::vector<contact_stress::ScalingResult>& results)
    {
        for (const contact_stress::ScalingCase& trial : plan_.scaling) {
            contact_stress::ScalingResult result =
                contact_stress::run(trial, options_.threads, follow(trial.vertices, trial.name));
            if (interrupt_.requested())
                return false;
            results.push_back(std::move(result));
        }
        return true;
    }

    bool run_dressed(std::vector<contact_stress::DressedResult>& results)
    {
        for (const scenes::Scene& scene : scenes_) {
            contact_stress::DressedResult result =
                contact_stress::run(scene, options_.threads, follow(kDressedWork, scene.name));
            if (interrupt_.requested())
                return false;
            results.push_back(std::move(result));
        }
        return true;
    }

    const Plan& plan_;
    std::vector<scenes::Scene> scenes_;
    const BenchOptions& options_;
    app::Progress progress_;
    app::InterruptGuard interrupt_;
    double done_ = 0.0;
};

} // namespace

int bench_contact(const BenchOptions& options)
{
    if (!options.output.empty())
        require_writable(options.output, kTables);
    const Plan plan = choose(options);
    contact_stress::Results results;
    const bool is_complete =
        Runner(plan, load(plan.dressed, options.quick ? kQuickDressedFrames : kDressedFrames), options)
            .run(results);
    const std::string tables = markdown_tables(results);
    std::cout << tables;
    if (!is_complete) {
        std::cerr << "toile: error: interrupted; cases that were finished are printed, nothing was written"
                  << std::endl;
        return app::kExitFailure;
    }
    write_tables(options.output, files(results, tables));
    return std::all_of(results.stress.begin(), results.stress.end(),
                       [](const contact_stress::StressResult& result) { return result.worst.holds; })
               ? app::kExitOk
               : app::kExitFailure;
}

} // namespace toile::research
