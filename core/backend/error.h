#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace toile {

/// Wrong input from outside: a file, a setting, a mesh. The message is one line that names the place
/// (file, line, key or element), the value found and what would be right.
class InvalidInput : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// The machine refused: a write that failed half-way, a device call that returned an error.
class DeviceError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// Long work stopped because its listener asked for it. Nothing was changed.
class Cancelled : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// The candidate closest to `word` by edit distance, for "did you mean" in error messages; empty when
/// none is nearer than half of the word's length. The first of equally near candidates wins.
std::string nearest_word(const std::string& word, const std::vector<std::string>& candidates);

} // namespace toile
