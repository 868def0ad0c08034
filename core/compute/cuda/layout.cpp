#include "core/compute/cuda/layout.h"

namespace toile {

template <>
void OurEigenLayout::agreed()
{
}

} // namespace toile
