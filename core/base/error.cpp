#include "core/base/error.h"

#include <algorithm>
#include <numeric>

namespace toile {

namespace {

/// Levenshtein distance by rows.
size_t edit_distance(const std::string& a, const std::string& b)
{
    std::vector<size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), size_t{0});
    for (size_t i = 0; i < a.size(); ++i) {
        size_t diagonal = row[0];
        row[0] = i + 1;
        for (size_t j = 0; j < b.size(); ++j) {
            const size_t substituted = diagonal + (a[i] == b[j] ? 0 : 1);
            diagonal = row[j + 1];
            row[j + 1] = std::min({substituted, row[j] + 1, row[j + 1] + 1});
        }
    }
    return row.back();
}

} // namespace

std::string nearest_word(const std::string& word, const std::vector<std::string>& candidates)
{
    std::string best;
    size_t best_distance = word.size() / 2 + 1;
    for (const std::string& candidate : candidates) {
        const size_t distance = candidate.starts_with(word) ? 1 : edit_distance(word, candidate);
        if (distance < best_distance) {
            best_distance = distance;
            best = candidate;
        }
    }
    return best;
}

} // namespace toile
