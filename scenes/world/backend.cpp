#include "scenes/world/backend.h"

#include "core/base/error.h"
#include "core/compute/cuda/runtime/device.h"
#include "scenes/format/field.h"
#include "scenes/format/solver_methods.h"
#include "scenes/method/solver_choice.h"
#include "scenes/world/scene_costs.h"

namespace toile::scenes {

namespace {

std::string only_on_cpu(const std::string& key, std::string_view word)
{
    return key + " \"" + std::string(word) + "\" runs on the CPU only";
}

std::shared_ptr<const CudaSpace> take_cpu(const std::string& why,
                                          const std::function<void(const std::string&)>& warn)
{
    if (warn)
        warn("the backend is cpu: " + why);
    return nullptr;
}

} // namespace

std::string why_not_on_gpu(const Scene& scene)
{
    const scene::Solver& solver = scene.solver;
    if (!runs_on_gpu(solver.method))
        return only_on_cpu("solver.method", scene_format::word_of(solver.method));
    if (const OuterMethod outer = step_method_of(scene).outer;
        outer != OuterMethod::Newton && outer != OuterMethod::Lbfgs)
        return only_on_cpu("solver.outer", scene_format::word_of(outer));
    if (solver.contact_preconditioner != ContactPreconditioner::Block)
        return only_on_cpu("solver.contact_preconditioner",
                           scene_format::word_of(solver.contact_preconditioner));
    if (!scene.solids.empty())
        return "solids run on the CPU only";
    for (const scene::Cloth& cloth : scene.cloths) {
        if (!cloth.groups.empty())
            return "cloth of several fabrics runs on the CPU only";
        if (cloth.sewing)
            return "threads that sew run on the CPU only";
        if (!cloth.elastics.empty())
            return "elastics run on the CPU only";
        if (!cloth.folds.empty())
            return "folds of cloth run on the CPU only";
        if (!cloth.tacks.empty())
            return "tacks run on the CPU only";
        if (cloth.painted)
            return "painted cloth runs on the CPU only";
        if (cloth.pressure)
            return "pressure on cloth runs on the CPU only";
    }
    return {};
}

void require_runs_on_gpu(const Scene& scene)
{
    if (const std::string needs_cpu = why_not_on_gpu(scene); !needs_cpu.empty())
        throw InvalidInput(scene.source.string() + ": " + needs_cpu +
                           "; choose the backend cpu or auto, or change the scene");
}

std::shared_ptr<const CudaSpace> open_backend(Backend backend, int device, const Scene& scene,
                                              const std::function<void(const std::string&)>& warn)
{
    if (backend == Backend::Cpu)
        return nullptr;
    if (backend == Backend::Cuda) {
        require_runs_on_gpu(scene);
        return std::make_shared<CudaSpace>(device);
    }
    const std::string needs_cpu = why_not_on_gpu(scene);
    std::string why_cpu = needs_cpu.empty() ? why_no_cuda_device() : needs_cpu;
    if (why_cpu.empty())
        try {
            return std::make_shared<CudaSpace>(device);
        } catch (const DeviceError& error) { // other processes may use all of its memory
            why_cpu = error.what();
        }
    return take_cpu(why_cpu, warn);
}

std::shared_ptr<const CudaSpace> space_with_capacity(std::shared_ptr<const CudaSpace> space, Backend backend,
                                                     const SceneCosts& costs,
                                                     const std::function<void(const std::string&)>& warn)
{
    if (!space)
        return nullptr;
    const FreeMemory free{space->described(), space->free_memory()};
    if (backend != Backend::Auto) {
        require_capacity(costs, free);
        return space;
    }
    const std::string why_cpu = why_too_large(costs, free);
    return why_cpu.empty() ? space : take_cpu(why_cpu, warn);
}

} // namespace toile::scenes
