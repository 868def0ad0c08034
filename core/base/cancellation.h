#pragma once

#include <functional>

namespace toile {

/// Ends long work at the request of who has called it. Loops that may take more than a second call check().
class Cancellation {
public:
    /// Until its end, check() on this thread asks `goes_on`.
    class Scope {
    public:
        /// @param goes_on  false: the work shall end; borrowed, may be empty
        explicit Scope(const std::function<bool()>& goes_on);
        ~Scope();
        Scope(const Scope&) = delete;
        Scope& operator=(const Scope&) = delete;

    private:
        const std::function<bool()>* previous_;
    };

    /// @throws Cancelled if the work shall end
    static void check();
};

} // namespace toile
