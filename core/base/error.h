#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace toile {

/// Wrong input from outside: a file, a setting, a mesh. The message is one line that names the location
/// (file, line, key or element), the value found and what would be right.
class InvalidInput : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// Failure of the machine: a write that broke off, a device call that returned an error.
class DeviceError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// Stop of long work at its listener's request. Nothing was changed.
class Cancelled : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// Use that the library does not allow: an index that does not exist, a wrong number of elements, calls in a
/// wrong order or at once. The object is as before.
class InvalidUse : public std::logic_error {
public:
    using std::logic_error::logic_error;
};

/// Candidate closest to `word` by edit distance, for "did you mean" in error messages; one that begins with
/// it is at distance 1. Empty if every distance exceeds half of the word's length. The first of equally near
/// candidates wins.
std::string nearest_word(const std::string& word, const std::vector<std::string>& candidates);

} // namespace toile
