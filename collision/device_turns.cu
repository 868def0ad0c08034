#include "collision/device_turns.cuh"

namespace toile {

DeviceTurns::DeviceTurns(const CudaSpace& space, int vertex_count)
    : space_(space), flags_(space, "turns/flags"), places_(space, "turns/places"),
      count_(space, "turns/count", 1), rank_(space, "turns/rank"), total_(space, "turns/total", vertex_count),
      served_(space, "turns/served", vertex_count), next_(space, "turns/next", 1),
      start_(space, "turns/start", vertex_count), outcome_(space, "turns/outcome", 1),
      outcome_here_(space, "turns/outcome_here", 1), scratch_(space, "turns/scratch")
{
}

void DeviceTurns::list(const ContactTouches& touches, View<const int> vertices, View<Vec3> x, double margin)
{
    touches_ = touches;
    vertices_ = vertices;
    x_ = x;
    next_.fill_zero();
    outcome_.fill_zero();
    const TurnOrder order{touches.terms.size()};
    const View<unsigned char> flags = first_items(flags_, order.place_count());
    const View<int> places = first_items(places_, order.place_count());
    turns_ = {order,         places,
              count_.view(), first_items(rank_, Turns::kShares * touches.terms.size()),
              total_.view(), served_.view(),
              next_.view()};
    parallel_for(space_, "contact/flag_near", order.place_count(),
                 FlagNear{touches.terms, x, margin, order, flags});
    list_flagged(space_, "contact/list_near", flags, places, count_.view(), scratch_);
    parallel_for(space_, "contact/number_turns", vertices.size(),
                 NumberTurns{order, flags, vertices, touches.first, touches.entries, rank_.view(),
                             total_.view(), served_.view()});
    parallel_for(space_, "contact/keep_start", vertices.size(), CopySlots{vertices, x, start_.view()});
}

PushOutcome DeviceTurns::outcome()
{
    if (touches_.terms.empty())
        return {};
    outcome_.download(outcome_here_.view());
    space_.synchronise();
    if (outcome_here_[0].went_far != 0)
        parallel_for(space_, "contact/put_back", vertices_.size(), CopySlots{vertices_, start_.view(), x_});
    return outcome_here_[0];
}

} // namespace toile
