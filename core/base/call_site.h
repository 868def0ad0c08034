#pragma once

namespace toile {

/// Source location of a call: give a function a last parameter `CallSite where = CallSite::here()`. Stands in
/// for std::source_location, which clang-tidy 14 lacks.
struct CallSite {
    const char* file = "";
    int line = 0;

    static constexpr CallSite here(const char* file = __builtin_FILE(), int line = __builtin_LINE())
    {
        return {file, line};
    }
};

} // namespace toile
