#include "collision/device_near_terms.h"

#include <algorithm>

#include "core/backend/cuda/parallel.cuh"
#include "core/backend/cuda/roomy.h"

namespace toile {

namespace {

/// Near terms more than last time that are copied at once.
constexpr int kFewTerms = 64;

} // namespace

DeviceNearTerms::DeviceNearTerms(const CudaSpace& space, int vertex_count)
    : space_(space), near_(space, "near_terms/near"), or_beside_(space, "near_terms/or_beside"),
      has_all_(space, "near_terms/has_all"), list_(space, "near_terms/list"), count_(space),
      scratch_(space, "near_terms/scratch"), terms_(space, "near_terms/terms"),
      terms_here_(space, "near_terms/terms_here"), x_there_(space, "near_terms/x"),
      v_there_(space, "near_terms/v"), x_start_(space, "near_terms/x_start"),
      v_start_(space, "near_terms/v_start"), x_here_(vertex_count), v_here_(vertex_count),
      placed_(space, "near_terms/placed"), placed_here_(space, "near_terms/placed_here")
{
}

NearTerms DeviceNearTerms::find(const ContactTouches& touches, int list_count, double margin,
                                bool with_beside, StepField x, StepField v)
{
    x_ = x;
    v_ = v;
    int count = 0;
    if (!touches.terms.empty()) {
        list(touches, list_count, margin, with_beside);
        copy(touches.terms, expected_);
        count = count_.value[0];
        if (count > expected_)
            copy(touches.terms, count);
        expected_ = std::max(count + count / 4 + kFewTerms, expected_ - expected_ / 8);
    }
    const View<const ContactTerm> terms = View<const ContactTerm>(terms_here_.view()).subview(0, count);
    spread(terms);
    NearTerms near{terms, margin, View<const NearVertices>(x_start_.view()).subview(0, count), x_here_};
    if (v.size() > 0)
        near.v = v_here_;
    return near;
}

void DeviceNearTerms::list(const ContactTouches& touches, int list_count, double margin, bool with_beside)
{
    const int count = touches.terms.size();
    const View<unsigned char> near = first_items(near_, count), or_beside = first_items(or_beside_, count),
                              has_all = first_items(has_all_, 4 * count);
    parallel_for(space_, "contact/flag_near", count,
                 FlagNear{touches.terms, x_.there(), margin, near, or_beside, has_all});
    parallel_for(space_, "contact/flag_beside", with_beside ? list_count : 0,
                 FlagBeside{touches, near, or_beside, has_all});
    list_flagged(space_, "contact/list_near", or_beside, first_items(list_, count), count_.total.view(),
                 scratch_);
}

/// Copies what is listed, at most so many, and how many they are. Waits.
void DeviceNearTerms::copy(View<const ContactTerm> terms, int most)
{
    const bool with_velocities = v_.size() > 0;
    const int room = std::min(most, terms.size());
    const View<ContactTerm> copies = first_items(terms_, room);
    const View<NearVertices> x = first_items(x_there_, room);
    const View<Vec3> v = first_items(v_there_, 4 * room);
    parallel_for(space_, "contact/copy_near", room,
                 CopyNear{terms, has_all_.view(), list_.view(), count_.total.view(), x_.there(),
                          with_velocities ? v_.there() : View<const Vec3>(), copies, x, v});
    count_.total.download(count_.value.view());
    terms_.download_first(first_items(terms_here_, room));
    x_there_.download_first(first_items(x_start_, room));
    if (with_velocities)
        v_there_.download_first(first_items(v_start_, 4 * room));
    space_.synchronise();
}

/// Puts what has come to where vertices have it.
void DeviceNearTerms::spread(View<const ContactTerm> terms)
{
    const bool with_velocities = v_.size() > 0;
    for (int i = 0; i < terms.size(); ++i) {
        const ContactPair& pair = terms[i].pair;
        for (int k = 0; k < pair.count(); ++k) {
            x_here_[pair.vertex[k]] = x_start_[i].x[k];
            if (with_velocities)
                v_here_[pair.vertex[k]] = v_start_[4 * i + k];
        }
    }
}

void DeviceNearTerms::take(const NearTerms& near, View<const int> changed)
{
    if (changed.empty())
        return;
    const View<PlacedVertex> placed = first_items(placed_here_, 4 * changed.size());
    int count = 0;
    for (const int i : changed) {
        const ContactPair& pair = near.terms[i].pair;
        for (int k = 0; k < pair.count(); ++k) {
            const int v = pair.vertex[k];
            placed[count++] = {v, near.x[v], near.v.empty() ? Vec3(0.0, 0.0, 0.0) : near.v[v]};
        }
    }
    placed_.upload(placed.subview(0, count));
    parallel_for(
        space_, "contact/place_near", count,
        PlaceVertex{placed_.view(), x_.change_there(), near.v.empty() ? View<Vec3>() : v_.change_there()});
}

} // namespace toile
