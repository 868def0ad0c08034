#pragma once

#include <algorithm>
#include <vector>

#include "collision/self/pair_rules.h"
#include "core/compute/parallel.h"
#include "core/compute/types.h"

namespace toile::collision {

/// Collects the records of many tasks and sorts them by (first, second): the list does not depend on which
/// task found a record.
class OrderedRecords {
public:
    int size() const { return int(records_.size()); }
    const Record& operator[](int i) const { return records_[i]; }

    /// @param firsts      Record::first lies in [0, firsts)
    /// @param records_of  View<const Record> of one task
    template <typename Task, typename RecordsOf>
    void order(int firsts, View<const Task> tasks, const RecordsOf& records_of)
    {
        // Counting sort by the first: most have no record, few have many.
        begin_.assign(size_t(firsts) + 1, 0);
        for (const Task& task : tasks)
            for (const Record& record : records_of(task))
                ++begin_[record.first + 1];
        for (int i = 0; i < firsts; ++i)
            begin_[i + 1] += begin_[i];
        records_.resize(begin_.back());
        next_.assign(begin_.begin(), begin_.end() - 1);
        for (const Task& task : tasks)
            for (const Record& record : records_of(task))
                records_[next_[record.first]++] = record;

        parallel_for(kCpu, "collision/cloth_order", firsts, [this](int i) {
            std::sort(records_.begin() + begin_[i], records_.begin() + begin_[i + 1],
                      [](const Record& a, const Record& b) { return a.second < b.second; });
        });
    }

private:
    std::vector<Record> records_;
    std::vector<int> begin_; ///< [firsts + 1]
    std::vector<int> next_;  ///< [firsts]
};

} // namespace toile::collision
