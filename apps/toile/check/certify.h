#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "apps/toile/check/certificate.h"
#include "apps/toile/terminal/interrupt.h"
#include "apps/toile/terminal/run_log.h"
#include "export/point_cache.h"
#include "scenes/format/scene.h"
#include "scenes/surfaces/cloth_state.h"

namespace toile::app {

/// A cloth of a scene and the cache to be certified.
struct CachedCloth {
    const scenes::ClothState* cloth; ///< mesh, rest shape and fabric; its positions are ignored
    std::filesystem::path file;      ///< named by the certificate
    exports::PointCache cache;       ///< open_cloth()
};

/// Measures every frame that all caches have, cloths together, without any code of the solver.
/// @param cloths     of the scene, each once
/// @param log        receives the progress
/// @param interrupt  ends it
/// @return none if interrupted
/// @throws InvalidInput for unreadable caches, caches of another cloth, and unreadable avatars.
std::optional<Certificate> certify(const scenes::Scene& scene, const std::vector<CachedCloth>& cloths,
                                   const CertificateLimits& limits, const RunLog& log,
                                   const InterruptGuard& interrupt);

/// Writes the summary to stderr; a quiet log omits that of a certificate that holds.
/// @param file  where the certificate is
/// @return kExitOk or kExitFailure
int conclude(const Certificate& certificate, const std::filesystem::path& file, const RunLog& log);

/// File name of a certificate of several caches, in their folder.
inline constexpr const char* kCertificateName = "certificate.json";

/// Certificate of a single cache: skirt.certificate.json beside skirt.pc2.
std::filesystem::path certificate_beside(const std::filesystem::path& cache);

} // namespace toile::app
