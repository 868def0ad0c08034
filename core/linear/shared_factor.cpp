#include "core/linear/shared_factor.h"

#include "core/compute/shared_by_key.h"

namespace toile {

std::shared_ptr<const SupernodalFactor>
shared_factor(const SparseMatrix& H, const std::function<std::shared_ptr<const SupernodalFactor>()>& make)
{
    static SharedByKey<SupernodalFactor> factors;
    return factors.get(hash_of(H), make, [] {});
}

} // namespace toile
