#include "core/backend/cuda/layout.h"

namespace toile {

template <>
void OurEigenLayout::agreed()
{
}

} // namespace toile
