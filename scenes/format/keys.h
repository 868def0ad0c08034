#pragma once

#include <string>
#include <vector>

#include "scenes/format/describe.h"

namespace toile::scene_format {

/// Visitor that lists the keys an object may have.
class KeyCollector {
public:
    template <typename T, typename... Rest>
    void field(const char* key, T&, const Rest&...)
    {
        keys_.emplace_back(key);
    }
    template <typename T, typename... Rest>
    void required(const char* key, T&, const Rest&...)
    {
        keys_.emplace_back(key);
    }
    template <typename T>
    void number_or_off(const char* key, T&, const Range&, const char*)
    {
        keys_.emplace_back(key);
    }
    template <typename T>
    void number_or_object(const char* key, std::optional<T>&, double T::*, const Range&, const char*)
    {
        keys_.emplace_back(key);
    }
    void number_or_quotient(const char* key, double&, const Range&, const char*) { keys_.emplace_back(key); }
    void names(const char* key, std::vector<std::string>&, const char*) { keys_.emplace_back(key); }
    void pair(const char* key, WarpWeft&, const Range&, const char*) { keys_.emplace_back(key); }
    void version(const char* key, int, const char*) { keys_.emplace_back(key); }
    template <typename Variant, typename... A>
    void one_of(Variant&, const A&... alternatives)
    {
        (keys_.emplace_back(alternatives.key), ...);
    }

    const std::vector<std::string>& keys() const { return keys_; }

private:
    std::vector<std::string> keys_;
};

/// Keys that objects of type T may have, in the order of the documentation.
template <typename T>
std::vector<std::string> keys_of()
{
    KeyCollector collector;
    T object;
    describe(collector, object);
    return collector.keys();
}

} // namespace toile::scene_format
