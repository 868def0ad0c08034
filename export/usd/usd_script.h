#pragma once

#include <string_view>

namespace toile::exports {

/// Text of usd_commands.py, which the program carries with it.
std::string_view usd_script();

} // namespace toile::exports
