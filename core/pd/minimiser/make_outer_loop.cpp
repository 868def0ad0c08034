#include "core/pd/minimiser/make_outer_loop.h"

#include "core/pd/minimiser/anderson.h"
#include "core/pd/minimiser/lbfgs.h"
#include "core/pd/minimiser/local_global.h"
#include "core/pd/minimiser/newton_pcg.h"

namespace toile {

std::unique_ptr<OuterLoop> make_outer_loop(OuterMethod method, int history)
{
    switch (method) {
    case OuterMethod::LocalGlobal:
        return std::make_unique<LocalGlobal>();
    case OuterMethod::Anderson:
        return std::make_unique<Anderson>(history);
    case OuterMethod::NewtonPcg:
        return std::make_unique<NewtonPcg>();
    case OuterMethod::Newton:
    case OuterMethod::Lbfgs:
        break;
    }
    return std::make_unique<Lbfgs>(history);
}

} // namespace toile
