#pragma once

#include <cstddef>
#include <functional>

namespace toile {

/// Tells how far long work is, to who has called it on this thread. Loops that may take more than a second
/// call update() or iterate(); both end the work where its caller asks for that (Cancellation).
class LongWork {
public:
    struct Progress {
        double fraction; ///< finished [0, 1]
        int iteration;   ///< of work that ends when it has converged; 0: none
    };
    using Report = std::function<void(const Progress&)>;

    /// Receives the progress of this thread until its end.
    class Scope {
    public:
        explicit Scope(Report report);
        ~Scope();
        Scope(const Scope&) = delete;
        Scope& operator=(const Scope&) = delete;

    private:
        friend class LongWork;
        Report report_;
        double begin_ = 0.0, end_ = 1.0;
        Scope* previous_;
    };

    /// Until its end, fractions are of the part between two fractions of the work around it.
    class Part {
    public:
        Part(double begin, double end);
        ~Part();
        Part(const Part&) = delete;
        Part& operator=(const Part&) = delete;

    private:
        double begin_, end_; ///< of the work around it
    };

    /// Part of one of several items.
    static Part item(std::size_t number, std::size_t count)
    {
        return {double(number) / double(count), double(number + 1) / double(count)};
    }

    /// @param fraction  finished [0, 1]
    /// @throws Cancelled if the work shall end
    static void update(double fraction);

    /// @param iteration  from 1
    /// @throws Cancelled if the work shall end
    static void iterate(int iteration);
};

} // namespace toile
