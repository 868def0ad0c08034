#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <vector>

#include "apps/toile/certificate.h"
#include "apps/toile/run_log.h"
#include "export/point_cache.h"
#include "scenes/world.h"

namespace toile {

/// A cloth of a scene and the cache of it that is to be certified.
struct CachedCloth {
    const ClothState* cloth; ///< mesh, rest shape and fabric; its positions are not looked at
    std::filesystem::path file;
};

/// Measures every frame that all of the caches have, cloths together, with none of the solver's code.
/// @param cloths   of the scene, each once
/// @param goes_on  told the number of finished frames and of all; false stops
/// @return nothing when stopped
/// @throws InvalidInput for caches that can't be read or are of another cloth, and for avatars that can't.
std::optional<Certificate> certify(const Scene& scene, const std::vector<CachedCloth>& cloths,
                                   const CertificateLimits& limits,
                                   const std::function<bool(int done, int all)>& goes_on);

/// Writes the certificate and says on stderr in one line whether it holds: when it does, only unless the log
/// is quiet.
/// @return kExitOk or kExitFailure
/// @throws InvalidInput or DeviceError as write_atomically().
int conclude(const Certificate& certificate, const std::filesystem::path& file, const RunLog& log);

/// The name of the certificate of several caches, in their folder.
inline constexpr const char* kCertificateName = "certificate.json";

} // namespace toile
