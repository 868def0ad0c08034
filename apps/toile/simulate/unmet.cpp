#include "apps/toile/simulate/unmet.h"

namespace toile::app {

namespace {

const char* const kYielded = "cloth is stretched beyond its limit";
const char* const kPulled = "attachments stretch the cloth between them beyond its limit";
const char* const kDisplaced = "contact keeps exactly held vertices off their targets";
const char* const kPinched =
    "body parts leave no room for what is between them, or are too fast for it, and pass through";
const char* const kStuck = "cloth crosses a body";
const char* const kUnfinished = "steps ended unfinished";
const char* const kInverted = "tetrahedra are inside out: their body is crushed";

std::string at(const StepReport::Findings& findings)
{
    return findings.place.empty() ? "" : ", " + findings.place;
}

} // namespace

void Unmet::add(Kind& kind, int frame, bool is_unmet, const StepReport::Findings& findings,
                const std::string& text)
{
    if (!is_unmet)
        return;
    if (kind.frames++ == 0) {
        kind.first = frame;
        log_.note("frame " + std::to_string(frame) + ": " + text + at(findings));
    }
    if (findings.count > kind.worst.count) {
        kind.worst = findings;
        kind.worst_frame = frame;
    }
}

void Unmet::add(int frame, const StepReport& report)
{
    add(stuck_, frame, report.stuck.count > 0, report.stuck, kStuck);
    add(pinched_, frame, report.pinched.count > 0, report.pinched, kPinched);
    add(yielded_, frame, report.yielded.count > 0, report.yielded, kYielded);
    add(displaced_, frame, report.displaced.count > 0, report.displaced, kDisplaced);
    add(pulled_, frame, report.pulled.count > 0, report.pulled, kPulled);
    add(unfinished_, frame, report.unfinished > 0, {}, kUnfinished);
}

void Unmet::add_inverted(int frame, const std::vector<scene::SoftBody>& bodies,
                         const std::vector<int>& counts)
{
    StepReport::Findings worst;
    for (size_t i = 0; i < counts.size(); ++i)
        worst.merge({counts[i], "\"" + bodies[i].name + "\""});
    add(inverted_, frame, worst.count > 0, worst, kInverted);
}

void Unmet::sum_up(int frames) const
{
    const auto say = [&](const Kind& kind, const std::string& text, const std::string& things) {
        if (kind.frames == 0)
            return;
        std::string line = std::to_string(kind.frames) + " of " + std::to_string(frames) +
                           " frames: " + text + "; first at frame " + std::to_string(kind.first);
        if (kind.worst.count > 0)
            line += ", worst at frame " + std::to_string(kind.worst_frame) + " with " +
                    std::to_string(kind.worst.count) + " " + things + at(kind.worst);
        log_.note(line);
    };
    say(stuck_, kStuck, "triangles");
    say(pinched_, kPinched, "vertices");
    say(yielded_, kYielded, "triangles");
    say(displaced_, kDisplaced, "vertices");
    say(pulled_, kPulled, "triangles");
    say(unfinished_, kUnfinished, "");
    say(inverted_, kInverted, "tetrahedra");
}

} // namespace toile::app
