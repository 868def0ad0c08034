#include "apps/toile/render/body_paint.h"

#include "apps/toile/render/print.h"
#include "avatars/appearance/load_appearance.h"
#include "core/base/error.h"
#include "scenes/format/cache_files.h"

namespace toile::app {

std::shared_ptr<const preview::Paint> paint_of(const scenes::SceneBody& body,
                                               const std::function<void(const std::string&)>& warn)
{
    const scene::Avatar& settings = body.settings();
    const auto* file = std::get_if<std::filesystem::path>(&settings.shape);
    if (file == nullptr || scene_format::is_cache(*file))
        return nullptr;
    const std::string name = "avatar \"" + settings.name + "\"";
    try {
        avatars::Appearance appearance = avatars::load_appearance(*file, body.surface().triangles);
        if (appearance.is_empty() && appearance.left_out.empty())
            return nullptr;
        auto paint = std::make_shared<preview::Paint>(std::move(appearance), linear_color(settings.color));
        const std::string consequence = "; " + name + " is drawn without it";
        for (const std::string& fact : paint->appearance().left_out)
            warn(fact + consequence);
        return paint;
    } catch (const InvalidInput& error) {
        warn(error.what() + ("; " + name + " is drawn in its color"));
        return nullptr;
    }
}

} // namespace toile::app
