#include "core/pd/step/step_report.h"

#include <algorithm>

namespace toile {

void StepReport::Findings::merge(const Findings& other)
{
    if (other.count > count)
        *this = other;
}

void StepReport::merge(const StepReport& other)
{
    status = std::max(status, other.status);
    steps += other.steps;
    refused += other.refused;
    unfinished += other.unfinished;
    iterations += other.iterations;
    linear_iterations += other.linear_iterations;
    displacement = std::max(displacement, other.displacement);
    speed = std::max(speed, other.speed);
    step_error = std::max(step_error, other.step_error);
    gradient_norm = std::max(gradient_norm, other.gradient_norm);
    energy += other.energy;
    contacts += other.contacts;
    min_gap = std::min(min_gap, other.min_gap);
    max_strain = std::max(max_strain, other.max_strain);
    yielded.merge(other.yielded);
    pulled.merge(other.pulled);
    displaced.merge(other.displaced);
    pinched.merge(other.pinched);
    stuck.merge(other.stuck);
    if (message.empty())
        message = other.message;
}

} // namespace toile
