#pragma once

#include <algorithm>

namespace toile {

/// Decides when the coarse part of a preconditioner is made anew: at the start of a minimisation, and when
/// the iterations that its age has cost reach what making it costs. Contact that has come and gone since
/// makes it old.
class CoarseAge {
public:
    /// @param price  of making the coarse part [iterations]
    explicit CoarseAge(int price) : price_(price) {}

    /// To be called once for each direction. @return true if the coarse part is to be made
    bool is_over(bool is_first_of_minimisation)
    {
        const bool over = is_first_of_minimisation || excess_ >= price_;
        if (over) {
            excess_ = 0;
            has_young_ = false;
        }
        return over;
    }

    /// Takes the iterations of a solve.
    void take(int iterations)
    {
        if (!has_young_)
            young_ = iterations;
        has_young_ = true;
        excess_ += std::max(0, iterations - young_);
    }

private:
    int price_;
    int young_ = 0; ///< iterations of the first solve with the present coarse part
    bool has_young_ = false;
    int excess_ = 0; ///< of the solves since over young_
};

} // namespace toile
