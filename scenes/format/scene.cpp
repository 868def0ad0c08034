#include "scenes/format/scene.h"

namespace toile::scene {

double metres_per(LengthUnit unit)
{
    switch (unit) {
    case LengthUnit::Centimetre:
        return 0.01;
    case LengthUnit::Millimetre:
        return 0.001;
    case LengthUnit::Inch:
        return 0.0254;
    case LengthUnit::Metre:
        break;
    }
    return 1.0;
}

} // namespace toile::scene
