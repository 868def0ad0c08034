#include "apps/toile/simulate/run_report.h"

#include <nlohmann/json.hpp>

#include "apps/toile/simulate/start_text.h"
#include "core/base/process_usage.h"
#include "core/compute/cuda/runtime/runtime.h"
#include "scenes/format/field.h"
#include "scenes/method/solver_choice.h"

namespace toile::app {

namespace {

using Json = nlohmann::ordered_json;

Json settings_of(const scenes::Scene& scene)
{
    const scene::Solver& solver = scene.solver;
    const scenes::StepMethod method = scenes::step_method_of(scene);
    return {{"frames", scene.frames},
            {"fps", scene.fps},
            {"settle_s", scene.settle},
            {"substeps", method.substeps > 0 ? Json(method.substeps) : Json("by_motion")},
            {"step_error_m", method.substeps > 0 ? Json() : Json(method.step_error)},
            {"integrator", scene_format::word_of(method.integrator)},
            {"velocity_tolerance_m_s", method.velocity_tolerance},
            {"stop", scene_format::word_of(solver.stop)},
            {"max_iterations", method.max_iterations},
            {"method", scene_format::word_of(solver.method)},
            {"outer", scene_format::word_of(method.outer)},
            {"contact_preconditioner", scene_format::word_of(solver.contact_preconditioner)},
            {"sleep", solver.sleep.enabled},
            {"threads", solver.threads},
            {"contact_gap_m", scene.contact.gap},
            {"repair_start", scene.contact.repair_start}};
}

Json json_of(int frame, const StepReport& report, double seconds)
{
    Json json = {{"frame", frame},
                 {"status", to_word(report.status)},
                 {"seconds", seconds},
                 {"steps", report.steps},
                 {"refused", report.refused},
                 {"iterations", report.iterations},
                 {"linear_iterations", report.linear_iterations},
                 {"displacement_m", report.displacement},
                 {"newton_speed_m_s", report.speed},
                 {"step_error_m", report.step_error},
                 {"gradient_norm_n", report.gradient_norm},
                 {"energy_j", report.energy},
                 {"contacts", report.contacts},
                 {"min_gap_m", report.min_gap},
                 {"max_strain", report.max_strain}};
    const auto add = [&](const char* name, const StepReport::Findings& findings) {
        if (findings.count > 0)
            json[name] = {{"count", findings.count}, {"place", findings.place}};
    };
    add("yielded", report.yielded);
    add("pulled", report.pulled);
    add("displaced", report.displaced);
    add("pinched", report.pinched);
    add("stuck", report.stuck);
    if (!report.message.empty())
        json["message"] = report.message;
    return json;
}

} // namespace

const char* to_word(StepReport::Status status)
{
    switch (status) {
    case StepReport::Status::IterationLimit:
        return "iteration_limit";
    case StepReport::Status::Yielded:
        return "yielded";
    case StepReport::Status::Pinched:
        return "pinched";
    case StepReport::Status::Stuck:
        return "stuck";
    case StepReport::Status::NonFinite:
        return "non_finite";
    case StepReport::Status::Converged:
        break;
    }
    return "converged";
}

RunReport::RunReport(const scenes::Scene& scene, int vertex_count, collision::StartReport start,
                     const CudaDevice* device)
    : scene_(scene), vertex_count_(vertex_count), start_(std::move(start)),
      backend_(device != nullptr ? "cuda: " + device->name : "cpu"),
      device_(device != nullptr ? std::optional(device->index) : std::nullopt)
{
}

std::string RunReport::to_json(const std::string& outcome, const Stages& stages) const
{
    Json json = {{"scene", scene_.source.string()},
                 {"name", scene_.name},
                 {"outcome", outcome},
                 {"vertices", vertex_count_},
                 {"backend", backend_}};
    if (device_)
        json["device"] = *device_;
    json["settings"] = settings_of(scene_);
    json["start"] = start_json(start_, scene_);
    json["peak_memory_bytes"] = peak_memory();
    double seconds = 0.0;
    Json& frames = json["frames"] = Json::array();
    for (const Frame& frame : frames_) {
        frames.push_back(json_of(frame.index, frame.report, frame.seconds));
        seconds += frame.seconds;
    }
    json["seconds"] = seconds;
    Json& stage_table = json["stages"] = Json::object();
    for (const auto& [name, entry] : stages.entries())
        stage_table[name] = {
            {"calls", entry.calls}, {"seconds", entry.seconds}, {"own_seconds", entry.self_seconds}};
    // Names of files may have bytes that are not UTF-8.
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

} // namespace toile::app
