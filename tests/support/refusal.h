#pragma once

#include <string>

#include "core/base/error.h"

namespace toile::test {

/// Message of the InvalidInput that `action` throws; empty if it throws none.
template <typename Action>
std::string refusal(const Action& action)
{
    try {
        action();
    } catch (const InvalidInput& error) {
        return error.what();
    }
    return {};
}

} // namespace toile::test
