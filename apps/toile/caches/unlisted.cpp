#include "apps/toile/caches/unlisted.h"

#include <CLI/CLI.hpp>

#include "scenes/format/field.h"

namespace toile::app {

void UnlistedOptions::add_to(CLI::App& command)
{
    command.add_option("--from-unit", unit_, "Unit of caches that the scene does not list [m]")
        ->check(CLI::IsMember(scene_format::words_of<scene::ExportUnit>()));
    command.add_option("--from-up", up_, "Upward axis of caches that the scene does not list [y]")
        ->check(CLI::IsMember(scene_format::words_of<scene::UpAxis>()));
}

scene::Export UnlistedOptions::entry() const
{
    scene::Export entry;
    entry.unit = scene_format::value_of<scene::ExportUnit>(unit_);
    entry.up = scene_format::value_of<scene::UpAxis>(up_);
    return entry;
}

} // namespace toile::app
