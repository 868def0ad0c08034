#pragma once

namespace toile {

/// Where a function is called: give it a last parameter `CallSite where = CallSite::here()`. As
/// std::source_location, which clang-tidy 14 does not know.
struct CallSite {
    const char* file = "";
    int line = 0;

    static constexpr CallSite here(const char* file = __builtin_FILE(), int line = __builtin_LINE())
    {
        return {file, line};
    }
};

} // namespace toile
