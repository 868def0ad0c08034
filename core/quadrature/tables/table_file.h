#pragma once

#include <filesystem>
#include <string>

#include "core/compute/hash.h"
#include "core/quadrature/tables/quadrature_tables.h"

namespace toile {

// Layout, numbers in the machine's byte order (`order` marks little-endian):
// clang-format off
//
//      8  magic "toiletab"          4  version      4  order
//     16  key                      16  shape: hash of tree and basis
//      8  rank    8  leaves         8  near entries 8  far entries
//     16  checksum of all other bytes (XXH3, 128 bits)
//      4 (leaves + 1)  near_first   4 near  near_leaf      4 (leaves + 1)  far_first   4 far  far_cluster
//      4 near 64  near_weights      4 far rank 8  far_weights
//
// clang-format on
// The tree and the basis are not stored: they are computed from the points in a fraction of the time.

/// Writes the kernel of `tables` as one file, atomically.
/// @throws InvalidInput, DeviceError as write_atomically()
void write_table_file(const std::filesystem::path& file, const Hash128& key, const QuadratureTables& tables);

/// Outcome of read_table_file().
struct TableFileOutcome {
    enum class Status { Read, Absent, OtherVersion, Corrupt };
    Status status = Status::Absent;
    std::string reason; ///< fault of a corrupt file
};

/// Reads the kernel of `tables`, which has its tree and basis. Checks every size before allocating and every
/// index before returning. `tables` is unchanged unless the status is Read.
TableFileOutcome read_table_file(const std::filesystem::path& file, const Hash128& key,
                                 QuadratureTables& tables);

} // namespace toile
