#include "core/compute/hash.h"

#include <cstdio>
#include <new>

#include <xxhash.h>

namespace toile {

struct Hasher::State {
    XXH3_state_t* state = XXH3_createState();
};

Hasher::Hasher() : state_(std::make_unique<State>())
{
    if (state_->state == nullptr)
        throw std::bad_alloc();
    XXH3_128bits_reset(state_->state);
}

Hasher::~Hasher() { XXH3_freeState(state_->state); }

void Hasher::add_bytes(const void* data, size_t size)
{
    if (size > 0)
        XXH3_128bits_update(state_->state, data, size);
}

Hash128 Hasher::result() const
{
    const XXH128_hash_t hash = XXH3_128bits_digest(state_->state);
    return {hash.high64, hash.low64};
}

std::string to_hex(const Hash128& hash)
{
    char text[33];
    std::snprintf(text, sizeof text, "%016llx%016llx", static_cast<unsigned long long>(hash.high),
                  static_cast<unsigned long long>(hash.low));
    return text;
}

} // namespace toile
