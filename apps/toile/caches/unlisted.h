#pragma once

#include <string>

#include "scenes/format/scene.h"

// NOLINTNEXTLINE(readability-identifier-naming): the library's
namespace CLI {
class App;
} // namespace CLI

namespace toile::app {

/// Options for caches that the scene does not list, and that do not say what their numbers are.
class UnlistedOptions {
public:
    /// Adds --from-unit and --from-up.
    void add_to(CLI::App& command);

    /// Their keys, as if a scene listed them.
    scene::Export entry() const;

private:
    std::string unit_ = "m", up_ = "y";
};

} // namespace toile::app
